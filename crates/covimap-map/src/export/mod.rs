//! Maps for other programs, and to look at.
//!
//! | function | for | holds |
//! |---|---|---|
//! | [`csv()`] | tables, scripts | landmarks |
//! | [`geojson()`] | GIS programs, web maps | landmarks, Delaunay edges |
//! | [`nav2_route()`] | the route server of Nav2 | landmarks and lines of sight of one component |
//! | [`graphml()`] | graph programs | landmarks, Delaunay edges with their lengths |
//! | [`ply()`] | point cloud viewers | landmarks coloured by region, Delaunay edges |
//! | [`svg()`] | people | a picture |
//!
//! Coordinates are in map units, in the frame of the landmark's component. Components have
//! nothing to do with each other's frames: every format but the picture gives the component of
//! each landmark and leaves it to the reader to keep them apart; the picture draws them side by
//! side. Delaunay edges join landmarks of one component.
//!
//! All output depends on the map alone, byte by byte.

mod component_graph;
mod geojson;
mod graphml;
mod nav2_route;
mod palette;
mod ply;
mod svg;
mod table;

pub use self::svg::{SvgParams, svg};
pub use geojson::geojson;
pub use graphml::graphml;
pub use nav2_route::nav2_route;
pub use ply::ply;
pub use table::csv;

use component_graph::ComponentGraph;
use serde_json::{Value, json};

/// Text that XML can hold: characters that it forbids even when escaped are replaced.
fn xml_text(text: &str) -> String {
    let allowed = |c: char| matches!(c, '\t' | '\n' | '\r' | ' '..='\u{d7ff}' | '\u{e000}'..='\u{fffd}' | '\u{10000}'..);
    text.chars().map(|c| if allowed(c) { c } else { char::REPLACEMENT_CHARACTER }).collect()
}

/// A GeoJSON feature.
fn feature(kind: &str, coordinates: Value, properties: Value) -> Value {
    json!({
        "type": "Feature",
        "geometry": { "type": kind, "coordinates": coordinates },
        "properties": properties,
    })
}

#[cfg(test)]
mod tests;
