//! Cores: a partition of the graph into connected cells of like size.
//!
//! # Algorithm
//! 1. Bisection: the landmarks are ordered from one end of the graph to the other, by how much nearer they
//!    are to the one than to the other along links, and cut in two where the links that are cut weigh least, not
//!    too far from the middle. Both parts are cut again until they are small enough. A cut falls on a door
//!    or a narrow place where there is one.
//! 2. Cells that came out small are merged into the neighbour that they have most links with.
//!
//! Merging lets cells grow beyond the size asked for, but not beyond half of the members that a
//! region may have: around the hub of a star, or where all distances are alike, small cells stay as they
//! are.
//!
//! # Complexity
//! `O(m log n log (n / c))` for `m` links and cells of size `c`, the two parts of a cut in parallel.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use crate::{LinkGraph, RegionParams};

const UNCLAIMED: u32 = u32::MAX;
/// Share of the landmarks that either side of a cut has at least.
const LEAST_SHARE: f64 = 0.35;

/// The cell of each landmark of a connected graph, cells numbered by their first landmark.
pub(super) fn cut(graph: &LinkGraph, sizes: RegionParams) -> Vec<u32> {
    let most = sizes.members / 2;
    let n = graph.landmarks();
    let cells = bisected(graph, (0..n as u32).collect(), (2 * sizes.core - 2).min(most));
    let mut cell_of = vec![UNCLAIMED; n];
    for (cell, members) in (0..).zip(cells) {
        members.into_iter().for_each(|landmark| cell_of[landmark as usize] = cell);
    }
    merge_small(graph, &mut cell_of, sizes.core, most);
    number_by_first(&mut cell_of);
    cell_of
}

/// Connected cells of at most `largest` landmarks; `names` tells what the landmarks of the graph are called.
fn bisected(graph: &LinkGraph, names: Vec<u32>, largest: usize) -> Vec<Vec<u32>> {
    if names.len() <= largest {
        return vec![names];
    }
    let order = from_end_to_end(graph);
    let (first, second) = order.split_at(lightest_cut(graph, &order));
    let side = |half: &[u32]| {
        let mut members = half.to_vec();
        members.sort_unstable();
        let part = graph.restricted_to(&members);
        let connected = part.components().into_iter().flat_map(|piece| {
            let names = piece.iter().map(|&place| names[members[place as usize] as usize]).collect();
            bisected(&part.restricted_to(&piece), names, largest)
        });
        connected.collect::<Vec<_>>()
    };
    let (mut cells, more) = rayon::join(|| side(first), || side(second));
    cells.extend(more);
    cells
}

/// The landmarks by the difference of their path lengths from the two ends of the graph.
fn from_end_to_end(graph: &LinkGraph) -> Vec<u32> {
    let farthest = |lengths: &[f64]| {
        let later = |a: &u32, b: &u32| lengths[*a as usize].total_cmp(&lengths[*b as usize]).then(b.cmp(a));
        (0..graph.landmarks() as u32).max_by(later).unwrap_or(0)
    };
    let from_one = path_lengths(graph, farthest(&path_lengths(graph, 0)));
    let from_other = path_lengths(graph, farthest(&from_one));
    let mut order: Vec<u32> = (0..graph.landmarks() as u32).collect();
    let along = |landmark: u32| from_one[landmark as usize] - from_other[landmark as usize];
    order.sort_by(|&a, &b| along(a).total_cmp(&along(b)).then(a.cmp(&b)));
    order
}

/// How many landmarks of an order, neither few nor most, to cut off so that the links cut weigh least.
fn lightest_cut(graph: &LinkGraph, order: &[u32]) -> usize {
    let mut place = vec![0; order.len()];
    for (at, &landmark) in order.iter().enumerate() {
        place[landmark as usize] = at;
    }
    let least = ((LEAST_SHARE * order.len() as f64) as usize).max(1);
    let (mut weight, mut best) = (0.0, (f64::INFINITY, order.len() / 2));
    for (at, &landmark) in order.iter().enumerate() {
        for link in graph.of(landmark) {
            weight += if place[link.to as usize] > at { link.weight } else { -link.weight };
        }
        let before = at + 1;
        if (least..=order.len() - least).contains(&before) && weight < best.0 {
            best = (weight, before);
        }
    }
    best.1
}

/// Lengths of the shortest paths from a landmark (Dijkstra's algorithm).
fn path_lengths(graph: &LinkGraph, from: u32) -> Vec<f64> {
    let mut lengths = vec![f64::INFINITY; graph.landmarks()];
    lengths[from as usize] = 0.0;
    // For floats that are not negative the order of the bits is that of the values.
    let mut heap = BinaryHeap::from([Reverse((0.0_f64.to_bits(), from))]);
    while let Some(Reverse((bits, landmark))) = heap.pop() {
        let here = f64::from_bits(bits);
        if here > lengths[landmark as usize] {
            continue;
        }
        for link in graph.of(landmark) {
            let there = here + link.distance;
            if there < lengths[link.to as usize] {
                lengths[link.to as usize] = there;
                heap.push(Reverse((there.to_bits(), link.to)));
            }
        }
    }
    lengths
}

/// Gives cells of less than half the size to the neighbour with the most links that has room for
/// them, smallest first.
fn merge_small(graph: &LinkGraph, cell_of: &mut [u32], size: usize, most: usize) {
    let mut members = members_of(cell_of);
    let mut small: Vec<u32> =
        (0..members.len() as u32).filter(|&c| members[c as usize].len() < size / 2).collect();
    small.sort_by_key(|&cell| (members[cell as usize].len(), cell));
    for cell in small {
        if members[cell as usize].len() >= size / 2 {
            continue;
        }
        let mut neighbours: Vec<u32> = members[cell as usize]
            .iter()
            .flat_map(|&landmark| graph.of(landmark).iter().map(|link| cell_of[link.to as usize]))
            .filter(|&other| other != cell)
            .filter(|&other| members[other as usize].len() + members[cell as usize].len() <= most)
            .collect();
        neighbours.sort_unstable();
        let best = neighbours.chunk_by(|a, b| a == b).max_by_key(|links| (links.len(), Reverse(links[0])));
        let Some(into) = best.map(|links| links[0]) else { continue };
        let moved = std::mem::take(&mut members[cell as usize]);
        for &landmark in &moved {
            cell_of[landmark as usize] = into;
        }
        members[into as usize].extend(moved);
    }
}

fn members_of(cell_of: &[u32]) -> Vec<Vec<u32>> {
    let mut members = vec![Vec::new(); cell_of.iter().max().map_or(0, |&last| last as usize + 1)];
    for (landmark, &cell) in cell_of.iter().enumerate() {
        members[cell as usize].push(landmark as u32);
    }
    members
}

fn number_by_first(cell_of: &mut [u32]) {
    let mut number = vec![UNCLAIMED; cell_of.len()];
    let mut next = 0;
    for cell in cell_of {
        let entry = &mut number[*cell as usize];
        if *entry == UNCLAIMED {
            *entry = next;
            next += 1;
        }
        *cell = *entry;
    }
}
