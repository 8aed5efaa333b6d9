//! Cores: a partition of the graph into connected cells of like size.
//!
//! # Algorithm
//! 1. Grow cells one by one. A cell starts at the unclaimed landmark that borders the claimed ones
//!    longest, and takes unclaimed landmarks in the order of their path distance until it is full.
//! 2. Cells that found no room are merged into the neighbour that they have most links with.
//! 3. Rounding: every cell's most central landmark becomes a seed, and every landmark goes to the
//!    seed that is nearest by path; this straightens the ragged rims that growing leaves.
//!
//! Merging and rounding let cells grow beyond the size asked for, to twice that as a rule, but not
//! beyond half of the members that a region may have: around the hub of a star, or where all
//! distances are alike, small or ragged cells stay as they are.
//!
//! # Complexity
//! `O(m log n)` for `m` links.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use crate::{LinkGraph, Observer, RegionParams};

const UNCLAIMED: u32 = u32::MAX;
/// Rounds of rounding; further ones change little.
const ROUNDINGS: usize = 2;

/// Path distances as heap keys: for non-negative floats the order of the bits is that of the values.
type Key = (Reverse<u64>, Reverse<u32>);

fn key(distance: f64, landmark: u32) -> Key {
    (Reverse(distance.to_bits()), Reverse(landmark))
}

/// The cell of each landmark of a connected graph, cells numbered by their first landmark.
pub(super) fn grow(graph: &LinkGraph, sizes: RegionParams, observer: &dyn Observer) -> Vec<u32> {
    let most = sizes.members / 2;
    let mut cell_of = grow_cells(graph, sizes.core, observer);
    merge_small(graph, &mut cell_of, sizes.core, most);
    for _ in 0..ROUNDINGS {
        let rounded = nearest_seed(graph, &central_landmarks(graph, &cell_of));
        if members_of(&rounded).iter().any(|members| members.len() > most) {
            break;
        }
        cell_of = rounded;
    }
    number_by_first(&mut cell_of);
    observer.advanced(cell_of.len() as u64);
    cell_of
}

fn grow_cells(graph: &LinkGraph, size: usize, observer: &dyn Observer) -> Vec<u32> {
    let n = graph.landmarks();
    let mut cell_of = vec![UNCLAIMED; n];
    let mut distance = vec![f64::INFINITY; n];
    let mut waiting = std::collections::VecDeque::from([0]);
    let mut cells = 0;
    while let Some(seed) = waiting.pop_front() {
        if cell_of[seed as usize] != UNCLAIMED {
            continue;
        }
        let mut heap = BinaryHeap::from([key(0.0, seed)]);
        let mut reached = vec![seed];
        distance[seed as usize] = 0.0;
        let mut claimed = 0;
        while let Some((Reverse(bits), Reverse(landmark))) = heap.pop() {
            let here = f64::from_bits(bits);
            if here > distance[landmark as usize] {
                continue;
            }
            if claimed == size {
                waiting.push_back(landmark);
                continue;
            }
            cell_of[landmark as usize] = cells;
            claimed += 1;
            for link in graph.of(landmark).iter().filter(|link| cell_of[link.to as usize] == UNCLAIMED) {
                let there = here + link.distance;
                if there < distance[link.to as usize] {
                    distance[link.to as usize] = there;
                    reached.push(link.to);
                    heap.push(key(there, link.to));
                }
            }
        }
        for landmark in reached {
            distance[landmark as usize] = f64::INFINITY;
        }
        cells += 1;
        observer.advanced(claimed as u64);
    }
    cell_of
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

/// The landmark of each cell that is best linked inside it.
fn central_landmarks(graph: &LinkGraph, cell_of: &[u32]) -> Vec<u32> {
    let inside = |landmark: u32| -> f64 {
        let own = cell_of[landmark as usize];
        graph
            .of(landmark)
            .iter()
            .filter(|link| cell_of[link.to as usize] == own)
            .map(|link| link.weight)
            .sum()
    };
    members_of(cell_of)
        .iter()
        .filter_map(|members| {
            members.iter().copied().max_by(|&a, &b| inside(a).total_cmp(&inside(b)).then(b.cmp(&a)))
        })
        .collect()
}

fn nearest_seed(graph: &LinkGraph, seeds: &[u32]) -> Vec<u32> {
    let n = graph.landmarks();
    let mut cell_of = vec![UNCLAIMED; n];
    let mut distance = vec![f64::INFINITY; n];
    let mut heap = BinaryHeap::with_capacity(n);
    for (cell, &seed) in seeds.iter().enumerate() {
        distance[seed as usize] = 0.0;
        cell_of[seed as usize] = cell as u32;
        heap.push(key(0.0, seed));
    }
    while let Some((Reverse(bits), Reverse(landmark))) = heap.pop() {
        let here = f64::from_bits(bits);
        if here > distance[landmark as usize] {
            continue;
        }
        for link in graph.of(landmark) {
            let there = here + link.distance;
            if there < distance[link.to as usize] {
                distance[link.to as usize] = there;
                cell_of[link.to as usize] = cell_of[landmark as usize];
                heap.push(key(there, link.to));
            }
        }
    }
    cell_of
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
