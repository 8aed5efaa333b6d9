//! Small worlds whose truth is known, for unit tests.

use covimap_embed::Point;
use proptest::prelude::ProptestConfig;
use proptest::test_runner::RngSeed;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::{CoVisibility, Link, LinkGraph, SightingLog, Silent};

/// So many cases of a property, the same ones in every run.
pub(crate) fn cases(cases: u32) -> ProptestConfig {
    ProptestConfig { cases, rng_seed: RngSeed::Fixed(1), failure_persistence: None, ..Default::default() }
}

/// Runs on a pool of so many threads.
pub(crate) fn on_threads<T: Send>(threads: usize, run: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(run)
}

pub(crate) fn distance(a: Point, b: Point) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// Random landmarks in a rectangle.
pub(crate) fn scattered(n: usize, [width, height]: Point, seed: u64) -> Vec<Point> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    (0..n).map(|_| [rng.random_range(0.0..width), rng.random_range(0.0..height)]).collect()
}

/// Links of weight 1 between the pairs `i < j` that have a length.
pub(crate) fn links_where(n: usize, length: impl Fn(usize, usize) -> Option<f64>) -> LinkGraph {
    let row = |i: usize| {
        let link = |j: usize| {
            let distance = length(i.min(j), i.max(j))?;
            Some(Link { to: j as u32, distance, weight: 1.0 })
        };
        (0..n).filter(|&j| j != i).filter_map(link).collect()
    };
    LinkGraph::from_rows((0..n).map(row).collect())
}

/// Links with the true distances between all landmarks nearer than `reach`.
pub(crate) fn exact_links(points: &[Point], reach: f64) -> LinkGraph {
    links_where(points.len(), |i, j| {
        let length = distance(points[i], points[j]);
        (length < reach).then_some(length)
    })
}

/// What is seen from random places all over a rectangle. A landmark at distance d is seen with
/// probability `0.9 / (1 + exp((d - range) / (0.08 range)))`.
pub(crate) fn looks(points: &[Point], [width, height]: Point, range: f64, steps: usize) -> Vec<Vec<usize>> {
    let mut rng = ChaCha8Rng::seed_from_u64(steps as u64);
    let look = |_| {
        let place = [rng.random_range(0.0..width), rng.random_range(0.0..height)];
        let chance = |i: &usize| 0.9 / (1.0 + ((distance(points[*i], place) - range) / (0.08 * range)).exp());
        (0..points.len()).filter(|i| rng.random_bool(chance(i))).collect()
    };
    (0..steps).map(look).collect()
}

/// The log of such looks. A landmark is called by its number; before all others every landmark is seen
/// once by itself, so that numbers in the log are the numbers called.
pub(crate) fn log_of(looks: &[Vec<usize>]) -> SightingLog {
    let landmarks = looks.iter().flatten().max().map_or(0, |&last| last + 1);
    let alone = (0..landmarks).map(|i| vec![i.to_string()]);
    let steps = looks.iter().map(|look| look.iter().map(usize::to_string).collect());
    SightingLog::from_steps(alone.chain(steps).collect::<Vec<Vec<String>>>())
}

pub(crate) fn counts_of(log: &SightingLog) -> CoVisibility {
    CoVisibility::count(log, &Silent).unwrap()
}
