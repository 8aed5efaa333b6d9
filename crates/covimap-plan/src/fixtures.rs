//! Small maps, for unit tests.

use std::sync::Arc;

use covimap_embed::Point;
use covimap_map::{
    BuildReport, GlobalMap, LandmarkId, LandmarkNames, MapperParams, PlacedLandmark, SightLines,
    delaunay_edges,
};
use proptest::prelude::ProptestConfig;
use proptest::test_runner::RngSeed;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::MapIndex;

/// How often every landmark of these maps was seen.
pub(crate) const SIGHTINGS: u32 = 100;

/// So many cases of a property, the same ones in every run.
pub(crate) fn cases(cases: u32) -> ProptestConfig {
    ProptestConfig { cases, rng_seed: RngSeed::Fixed(1), failure_persistence: None, ..Default::default() }
}

/// Landmarks `L0, L1, ...` with their components, and lines of sight between them.
pub(crate) fn map_of(placed: &[(Point, u32)], lines: &[(u32, u32, u32)]) -> GlobalMap {
    map_seen(placed, lines, SIGHTINGS)
}

/// The same with all landmarks seen in so many steps.
pub(crate) fn map_seen(placed: &[(Point, u32)], lines: &[(u32, u32, u32)], sightings: u32) -> GlobalMap {
    let mut names = LandmarkNames::default();
    for number in 0..placed.len() {
        names.push(&format!("L{number}"));
    }
    let partners =
        |i: usize| lines.iter().filter(|line| line.0 as usize == i || line.1 as usize == i).count();
    let landmark = |(i, &(position, component)): (usize, &(Point, u32))| PlacedLandmark {
        position,
        component,
        region: component,
        sightings,
        partners: partners(i) as u32,
    };
    let landmarks = placed.iter().enumerate().map(landmark).collect();
    let lines = lines.iter().map(|&(a, b, steps)| (LandmarkId(a), LandmarkId(b), steps));
    GlobalMap::from_parts(names, landmarks, MapperParams::default(), BuildReport::default())
        .unwrap()
        .with_sight_lines(SightLines::from_pairs(placed.len(), lines).unwrap())
        .unwrap()
}

/// Landmarks of one component.
pub(crate) fn index_of(points: &[Point], lines: &[(u32, u32, u32)]) -> MapIndex {
    let placed: Vec<_> = points.iter().map(|&point| (point, 0)).collect();
    MapIndex::new(Arc::new(map_of(&placed, lines)))
}

/// Random places in a square of side 1.
pub(crate) fn scattered(n: usize, seed: u64) -> Vec<Point> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    (0..n).map(|_| [random.random_range(0.0..1.0), random.random_range(0.0..1.0)]).collect()
}

/// Four in five of the Delaunay edges, seen in 20 to 99 steps.
pub(crate) fn lines_among(points: &[Point], seed: u64) -> Vec<(u32, u32, u32)> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let edges = delaunay_edges(points).unwrap().into_iter();
    edges.map(|(a, b)| (a, b, random.random_range(0..100))).filter(|line| line.2 >= 20).collect()
}

/// Two components: a unit square L0 to L3, counter-clockwise, and two landmarks L4, L5.
pub(crate) fn square_and_pair() -> MapIndex {
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|point| (point, 0));
    let pair = [[0.0, 0.0], [0.5, 0.0]].map(|point| (point, 1));
    let lines = [(0, 1, 50), (1, 2, 50), (2, 3, 50), (0, 3, 50), (4, 5, 10)];
    MapIndex::new(Arc::new(map_of(&[&square[..], &pair].concat(), &lines)))
}

pub(crate) fn empty() -> MapIndex {
    index_of(&[], &[])
}
