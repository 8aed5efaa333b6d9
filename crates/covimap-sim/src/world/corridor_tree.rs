//! A tree of corridors: no loop anywhere, many dead ends.

use std::collections::HashSet;

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use crate::floor_plan::FloorPlan;
use crate::geometry::Rect;

/// A place of the lattice where corridors meet or end.
type Node = [i32; 2];

/// Corridors of width `w` on a square lattice of pitch `p`, grown at random from one node.
///
/// A tree of `m` nodes has the area `m w^2 + (m - 1) w (p - w)`; `m` is rounded and both lengths are then
/// scaled by one factor to meet the wanted area.
pub(super) fn plan(area: f64, width: f64, pitch: f64, rng: &mut ChaCha8Rng) -> FloorPlan {
    let nodes = (1.0 + (area - width * width) / (width * pitch)).round().max(1.0);
    let scale = (area / (width * width + (nodes - 1.0) * width * pitch)).sqrt();
    let (width, pitch) = (scale * width, scale * pitch);
    let low = |index: i32| f64::from(index) * pitch;
    let high = |index: i32| low(index) + width;
    let square = |node: Node| Rect { min: node.map(low), max: node.map(high) };
    let mut tiles = vec![square([0, 0])];
    for [from, to] in grow(nodes as usize, rng) {
        let (first, second) = (from.min(to), from.max(to));
        let mut corridor = square(first);
        let axis = usize::from(first[0] == second[0]);
        corridor.min[axis] = high(first[axis]);
        corridor.max[axis] = low(second[axis]);
        tiles.push(corridor);
        tiles.push(square(to));
    }
    FloorPlan::new(tiles, Vec::new())
}

/// Adds nodes one by one at the end of a random branch; returns the edges, parent first.
fn grow(nodes: usize, rng: &mut ChaCha8Rng) -> Vec<[Node; 2]> {
    let mut taken = HashSet::from([[0, 0]]);
    let mut open: Vec<[Node; 2]> = Vec::new();
    let mut edges = Vec::new();
    let mut newest = [0, 0];
    while edges.len() + 1 < nodes {
        open.extend(
            [[1, 0], [0, 1], [-1, 0], [0, -1]].map(|[x, y]| [newest, [newest[0] + x, newest[1] + y]]),
        );
        let edge = loop {
            // A growing lattice set always has free neighbours, so `open` never runs dry.
            let pick = rng.random_range(0..open.len());
            let edge = open.swap_remove(pick);
            if taken.insert(edge[1]) {
                break edge;
            }
        };
        newest = edge[1];
        edges.push(edge);
    }
    edges
}
