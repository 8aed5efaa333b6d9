//! Route graphs for the route server of Nav2.
//!
//! The format is the one that `nav2_route`'s `GeoJsonGraphFileLoader` reads: a `FeatureCollection` of
//! `Point` features (nodes) and `MultiLineString` features (directed edges). What the loader takes from
//! `properties`:
//!
//! | of | key | here |
//! |---|---|---|
//! | node | `id` | number of the landmark in the map |
//! | node | `frame` | `map` |
//! | node | `metadata` | ID, region and sightings of the landmark |
//! | edge | `id` | counted on from the number of landmarks: unique over nodes and edges |
//! | edge | `startid`, `endid` | the nodes at its ends |
//! | edge | `cost` | its length |
//! | edge | `overridable` | `true`: scorers of the server may set another cost |
//! | edge | `metadata` | `steps` that show both ends |
//!
//! Source: navigation2, `nav2_route`, `geojson_graph_file_loader.cpp` and `graphs/sample_graph.geojson`.

use std::io::{self, Write};

use serde_json::{Value, json};

use super::feature;
use crate::{GlobalMap, LandmarkId, MapError};

/// Checks that a component makes a route graph, and gives what writes it: a feature a line, first the
/// landmarks of the component, then every line of sight in both directions.
///
/// A graph has one frame, so that it holds one component. The server means metres: align the map first.
///
/// # Errors
/// [`MapError::NoRouteGraph`] when the component has no line of sight. The writer fails only if its output does.
pub fn nav2_route(
    map: &GlobalMap,
    component: u32,
) -> Result<impl FnOnce(&mut dyn Write) -> io::Result<()> + '_, MapError> {
    let is_of = move |id: LandmarkId| map.landmarks()[id.index()].component == component;
    if !map.sight_lines().pairs().any(|(a, ..)| is_of(a)) {
        return Err(MapError::NoRouteGraph { component });
    }
    Ok(move |out: &mut dyn Write| {
        let nodes = (0..map.len() as u32).map(LandmarkId).filter(|&id| is_of(id)).map(|id| node(map, id));
        let lines = map.sight_lines().pairs().filter(|&(a, ..)| is_of(a));
        let directed = lines.flat_map(|(a, b, steps)| [(a, b, steps), (b, a, steps)]);
        let edges = (map.len() as u64..).zip(directed).map(|(id, (a, b, steps))| edge(map, id, a, b, steps));
        write!(out, "{{\"type\":\"FeatureCollection\",\"name\":\"covimap\",\"features\":[")?;
        for (index, feature) in nodes.chain(edges).enumerate() {
            write!(out, "{}\n{feature}", if index == 0 { "" } else { "," })?;
        }
        writeln!(out, "\n]}}")
    })
}

fn node(map: &GlobalMap, id: LandmarkId) -> Value {
    let placed = &map.landmarks()[id.index()];
    let metadata = json!({
        "landmark": map.names().name(id),
        "region": placed.region,
        "sightings": placed.sightings,
    });
    let properties = json!({ "id": id.0, "frame": "map", "metadata": metadata });
    feature("Point", json!(placed.position), properties)
}

fn edge(map: &GlobalMap, id: u64, from: LandmarkId, to: LandmarkId, steps: u32) -> Value {
    let ends = [from, to].map(|id| map.landmarks()[id.index()].position);
    let cost = (ends[0][0] - ends[1][0]).hypot(ends[0][1] - ends[1][1]);
    let properties = json!({
        "id": id,
        "startid": from.0,
        "endid": to.0,
        "cost": cost,
        "overridable": true,
        "metadata": { "steps": steps },
    });
    feature("MultiLineString", json!([ends]), properties)
}
