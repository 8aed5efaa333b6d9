//! GraphML: nodes with positions, edges with lengths.

use std::io::{self, Write};

use super::{ComponentGraph, xml_text};
use crate::{GlobalMap, LandmarkId};

/// Node attributes and their types.
const NODE_KEYS: [(&str, &str); 7] = [
    ("label", "string"),
    ("x", "double"),
    ("y", "double"),
    ("component", "int"),
    ("region", "int"),
    ("sightings", "long"),
    ("partners", "long"),
];

/// Writes an undirected graph: a node `n0, n1, ...` for every landmark, with its ID as `label`,
/// and an edge for every Delaunay edge, with its `length`.
///
/// # Errors
/// Those of `out`.
pub fn graphml(map: &GlobalMap, out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, r#"<?xml version="1.0" encoding="UTF-8"?>"#)?;
    writeln!(out, r#"<graphml xmlns="http://graphml.graphdrawing.org/xmlns">"#)?;
    for (name, kind) in NODE_KEYS {
        writeln!(out, r#"<key id="{name}" for="node" attr.name="{name}" attr.type="{kind}"/>"#)?;
    }
    writeln!(out, r#"<key id="length" for="edge" attr.name="length" attr.type="double"/>"#)?;
    writeln!(out, r#"<graph edgedefault="undirected">"#)?;
    for (index, (id, placed)) in map.names().iter().zip(map.landmarks()).enumerate() {
        let [x, y] = placed.position;
        let values = [
            escaped(id),
            format!("{x:?}"),
            format!("{y:?}"),
            placed.component.to_string(),
            placed.region.to_string(),
            placed.sightings.to_string(),
            placed.partners.to_string(),
        ];
        write!(out, r#"<node id="n{index}">"#)?;
        for ((name, _), value) in NODE_KEYS.iter().zip(values) {
            write!(out, r#"<data key="{name}">{value}</data>"#)?;
        }
        writeln!(out, "</node>")?;
    }
    for (from, to) in ComponentGraph::all(map).iter().flat_map(ComponentGraph::landmark_edges) {
        let length = length(map, from, to);
        write!(out, r#"<edge source="n{}" target="n{}">"#, from.0, to.0)?;
        writeln!(out, r#"<data key="length">{length:?}</data></edge>"#)?;
    }
    writeln!(out, "</graph>\n</graphml>")
}

fn length(map: &GlobalMap, from: LandmarkId, to: LandmarkId) -> f64 {
    let [a, b] = [from, to].map(|number| map.landmarks()[number.index()].position);
    (a[0] - b[0]).hypot(a[1] - b[1])
}

fn escaped(text: &str) -> String {
    xml_text(text).replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
