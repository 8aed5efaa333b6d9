//! GeoJSON: points and lines with properties.

use std::io::{self, Write};

use serde_json::{Value, json};

use super::{ComponentGraph, feature};
use crate::{GlobalMap, LandmarkId};

/// Writes a `FeatureCollection`, a feature a line: first every landmark as a `Point` with `id`,
/// `component`, `region`, `sightings` and `partners`, then every Delaunay edge as a `LineString`
/// with the IDs `from` and `to` and the `component`.
///
/// RFC 7946 means degrees of longitude and latitude; these are map units, so a reader has to be
/// told that the frame is a local one.
///
/// # Errors
/// Those of `out`.
pub fn geojson(map: &GlobalMap, out: &mut dyn Write) -> io::Result<()> {
    let numbers = (0..).map(LandmarkId).take(map.len());
    let landmarks = numbers.map(|number| landmark(map, number));
    let graphs = ComponentGraph::all(map);
    let edges = graphs
        .iter()
        .flat_map(|graph| graph.landmark_edges().map(|(from, to)| edge(map, graph.component, from, to)));
    write!(out, "{{\"type\":\"FeatureCollection\",\"features\":[")?;
    for (index, feature) in landmarks.chain(edges).enumerate() {
        write!(out, "{}\n{feature}", if index == 0 { "" } else { "," })?;
    }
    writeln!(out, "\n]}}")
}

fn landmark(map: &GlobalMap, number: LandmarkId) -> Value {
    let placed = &map.landmarks()[number.index()];
    let properties = json!({
        "id": map.names().name(number),
        "component": placed.component,
        "region": placed.region,
        "sightings": placed.sightings,
        "partners": placed.partners,
    });
    feature("Point", json!(placed.position), properties)
}

fn edge(map: &GlobalMap, component: u32, from: LandmarkId, to: LandmarkId) -> Value {
    let at = |number: LandmarkId| map.landmarks()[number.index()].position;
    let properties =
        json!({ "from": map.names().name(from), "to": map.names().name(to), "component": component });
    feature("LineString", json!([at(from), at(to)]), properties)
}
