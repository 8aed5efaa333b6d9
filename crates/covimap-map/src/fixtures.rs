//! Small worlds whose truth is known, for unit tests.

use covimap_embed::Point;
use proptest::prelude::ProptestConfig;
use proptest::test_runner::RngSeed;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::{Link, LinkGraph, SightingLog};

/// So many cases of a property, the same ones in every run.
pub(crate) fn cases(cases: u32) -> ProptestConfig {
    ProptestConfig {
        cases,
        rng_seed: RngSeed::Fixed(1),
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

/// Random landmarks in a rectangle.
pub(crate) fn scattered(n: usize, [width, height]: Point, seed: u64) -> Vec<Point> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    (0..n).map(|_| [rng.random_range(0.0..width), rng.random_range(0.0..height)]).collect()
}

pub(crate) fn distance(a: Point, b: Point) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// Links with the true distances between all landmarks nearer than `reach`.
pub(crate) fn exact_links(points: &[Point], reach: f64) -> LinkGraph {
    links_where(points.len(), |i, j| {
        let length = distance(points[i], points[j]);
        (length < reach).then_some(length)
    })
}

/// Links of weight 1 between the pairs `i < j` that have a length.
pub(crate) fn links_where(n: usize, length: impl Fn(usize, usize) -> Option<f64>) -> LinkGraph {
    let mut rows = vec![Vec::new(); n];
    for i in 0..n {
        for j in (0..n).filter(|&j| j != i) {
            if let Some(distance) = length(i.min(j), i.max(j)) {
                rows[i].push(Link { to: j as u32, distance, weight: 1.0 });
            }
        }
    }
    LinkGraph::from_rows(rows)
}

/// What a robot reports from random places all over a rectangle if it sees nine of ten landmarks
/// within its range. Landmark i is called by its number.
pub(crate) fn sightings(points: &[Point], [width, height]: Point, range: f64, steps: usize) -> SightingLog {
    let mut rng = ChaCha8Rng::seed_from_u64(steps as u64);
    let steps: Vec<Vec<String>> = (0..steps)
        .map(|_| {
            let place = [rng.random_range(0.0..width), rng.random_range(0.0..height)];
            let near = (0..points.len()).filter(|&i| distance(points[i], place) < range);
            near.filter(|_| rng.random_bool(0.9)).map(|i| i.to_string()).collect()
        })
        .collect();
    SightingLog::from_steps(&steps)
}

/// Runs on a pool of so many threads.
pub(crate) fn on_threads<T: Send>(threads: usize, run: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(run)
}
