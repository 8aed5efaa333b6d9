//! PLY: coloured points and edges.

use std::io::{self, Write};

use super::{ComponentGraph, palette};
use crate::GlobalMap;

/// Writes ASCII PLY: a vertex for every landmark, in the map's order, at height 0 and coloured by
/// region, and an edge for every Delaunay edge.
///
/// PLY has no strings: a landmark's ID is found by its place in the order, as in the map file.
///
/// # Errors
/// Those of `out`.
pub fn ply(map: &GlobalMap, out: &mut dyn Write) -> io::Result<()> {
    let graphs = ComponentGraph::all(map);
    let colours = palette::by_region(map, &graphs);
    let edges: usize = graphs.iter().map(|graph| graph.edges.len()).sum();
    writeln!(out, "ply\nformat ascii 1.0\ncomment landmarks and Delaunay edges of a covimap map")?;
    writeln!(out, "element vertex {}", map.len())?;
    for coordinate in ["x", "y", "z"] {
        writeln!(out, "property double {coordinate}")?;
    }
    for channel in ["red", "green", "blue"] {
        writeln!(out, "property uchar {channel}")?;
    }
    writeln!(out, "property uint component\nproperty uint region")?;
    writeln!(out, "element edge {edges}\nproperty int vertex1\nproperty int vertex2\nend_header")?;
    for (placed, &colour) in map.landmarks().iter().zip(&colours) {
        let ([x, y], [red, green, blue]) = (placed.position, palette::COLOURS[colour]);
        writeln!(out, "{x:?} {y:?} 0 {red} {green} {blue} {} {}", placed.component, placed.region)?;
    }
    for (from, to) in graphs.iter().flat_map(ComponentGraph::landmark_edges) {
        writeln!(out, "{} {}", from.0, to.0)?;
    }
    Ok(())
}
