//! Colours of regions: neighbours differ, and all colours are used about equally.

use std::collections::{BTreeMap, BTreeSet};

use super::ComponentGraph;
use crate::{GlobalMap, LandmarkId};

/// Red, green, blue; told apart on white, on screen and in print.
pub(super) const COLOURS: [[u8; 3]; 9] = [
    [0x2f, 0x6d, 0xb5],
    [0xe0, 0x7b, 0x1f],
    [0x3a, 0x96, 0x5a],
    [0xc8, 0x43, 0x4b],
    [0x7a, 0x5f, 0xb0],
    [0x1f, 0x97, 0xa3],
    [0xb0, 0x86, 0x0b],
    [0xc6, 0x5c, 0x9a],
    [0x7a, 0x5c, 0x47],
];

/// A region of a component.
type Region = (u32, u32);

/// Index into [`COLOURS`] for every landmark.
pub(super) fn by_region(map: &GlobalMap, graphs: &[ComponentGraph]) -> Vec<usize> {
    let region_of = |id: LandmarkId| -> Region {
        let placed = &map.landmarks()[id.index()];
        (placed.component, placed.region)
    };
    let mut neighbours = BTreeMap::<Region, BTreeSet<Region>>::new();
    for id in (0..).map(LandmarkId).take(map.len()) {
        neighbours.entry(region_of(id)).or_default();
    }
    for (from, to) in graphs.iter().flat_map(ComponentGraph::landmark_edges) {
        let (from, to) = (region_of(from), region_of(to));
        if from != to {
            neighbours.entry(from).or_default().insert(to);
            neighbours.entry(to).or_default().insert(from);
        }
    }
    let colours = coloured(&neighbours);
    (0..).map(LandmarkId).take(map.len()).map(|id| colours[&region_of(id)]).collect()
}

/// Greedy colouring: the colour least used so far that no neighbour has.
fn coloured(neighbours: &BTreeMap<Region, BTreeSet<Region>>) -> BTreeMap<Region, usize> {
    let mut colours = BTreeMap::new();
    let mut used = [0usize; COLOURS.len()];
    for (&region, around) in neighbours {
        let mut near = [0usize; COLOURS.len()];
        around.iter().filter_map(|other| colours.get(other)).for_each(|&colour: &usize| near[colour] += 1);
        let best = (0..COLOURS.len())
            .min_by_key(|&colour| (near[colour], used[colour]))
            .expect("there are colours (bug in covimap)");
        used[best] += 1;
        colours.insert(region, best);
    }
    colours
}
