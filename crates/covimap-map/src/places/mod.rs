//! Refinement: the map under which the whole log is most likely.
//!
//! Distances made of pair counts use the log two landmarks at a time, and their distance function
//! is only an assumption. Here every step is used as a whole. It was made at *some* place `y`,
//! which is unknown and is summed out; a landmark at `x_i` is seen from there with probability
//!
//! `P_i(y) = e + (p_i - e) / (1 + exp((|y - x_i| - R) / s))`  (1)
//!
//! with a range `R` and an edge width `s` shared by all, and a detectability `p_i` of each
//! landmark. The log-likelihood of the log is, up to a constant,
//!
//! `sum_t ln sum_y prod_{i seen at t} P_i(y) prod_{j not seen, but near} (1 - P_j(y))`.  (2)
//!
//! Summing the places out instead of fitting them is what keeps the estimate consistent: a fit of
//! places has as many unknowns as steps and bends the map (Neyman and Scott, 1948).
//!
//! Walls make landmarks unseen from places nearby. A landmark therefore counts as *near* only if
//! it is linked to at least half of those seen in the step: of one behind a wall, not being seen
//! says nothing.
//!
//! # Algorithm
//! Expectation-maximisation. The posterior of each step's place is taken on a grid around the
//! landmarks seen ([`posterior`]); then every landmark makes one Fisher-scoring step in position
//! and detectability, and `s` one in common ([`scoring`]). `R` is fitted first and then held: it
//! fixes the unit.
//!
//! # Complexity
//! `O(k c)` a step and iteration, `k` landmarks near and `c` grid cells (about 80). Equal sets are
//! handled once.
//!
//! # Determinism
//! Steps are handled in chunks of fixed size, whose sums are added up in order.
//!
//! # References
//! R. D. Bock, M. Aitkin, "Marginal maximum likelihood estimation of item parameters: application
//! of an EM algorithm", Psychometrika 46, 1981;
//! J. Neyman, E. L. Scott, "Consistent estimates based on partially consistent observations",
//! Econometrica 16, 1948.

mod posterior;
mod scoring;
mod sets;

use std::sync::Mutex;

use covimap_embed::Point;
use rayon::prelude::*;

use crate::{LinkGraph, MapError, Observer};
use posterior::{Posterior, Workspace};
use scoring::{Scores, SharedScores};
pub(crate) use sets::SeenSets;

/// Sets of one parallel task.
const CHUNK: usize = 2048;
/// Tasks whose scores are held at the same time.
const WAVE: usize = 64;
/// Iterations that fit the sensor to the map before landmarks move.
const SENSOR_ITERATIONS: usize = 4;
/// Sets, evenly spread over the log, that this fit looks at: a few shared numbers need no more.
const SENSOR_SETS: usize = 20_000;
/// Done when the landmarks move by less than this share of the range in the mean.
const STILL: f64 = 2e-3;

/// What the log says of the sensor, in map units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Sensor {
    /// Range within which a landmark is seen.
    pub range: f64,
    /// Width of the range's soft edge.
    pub edge: f64,
}

/// Positions and detectabilities under refinement.
pub(crate) struct Model {
    pub points: Vec<Point>,
    /// Probability of being seen from close by, one a landmark.
    pub detectability: Vec<f64>,
    pub sensor: Sensor,
}

/// Moves the landmarks of a connected graph to where the log is most likely.
pub(crate) fn refine(
    graph: &LinkGraph,
    sets: &SeenSets,
    start: Vec<Point>,
    iterations: usize,
    observer: &dyn Observer,
) -> Result<Model, MapError> {
    let range = half_far_link(graph, &start);
    let sensor = Sensor { range, edge: 0.15 * range };
    let mut model = Model { detectability: vec![0.9; start.len()], points: start, sensor };
    let sample = sets.len().div_ceil(SENSOR_SETS).max(1);
    for _ in 0..SENSOR_ITERATIONS {
        let (landmarks, shared) = expectation(graph, sets, sample, &model, observer)?;
        model.update_detectability(&landmarks);
        model.update_edge(&shared);
        model.update_range(&shared);
    }
    for _ in 0..iterations {
        let (landmarks, shared) = expectation(graph, sets, 1, &model, observer)?;
        let moved = model.update_points(&landmarks);
        model.update_detectability(&landmarks);
        model.update_edge(&shared);
        observer.advanced(1);
        if moved < STILL * model.sensor.range {
            break;
        }
    }
    Ok(model)
}

/// Half the length of a long link: two landmarks at twice the range are just seen together.
fn half_far_link(graph: &LinkGraph, points: &[Point]) -> f64 {
    let mut lengths: Vec<f64> = (0..graph.landmarks() as u32)
        .into_par_iter()
        .flat_map_iter(|i| {
            let here = points[i as usize];
            graph.of(i).iter().filter(move |link| link.to > i).map(move |link| {
                let there = points[link.to as usize];
                (there[0] - here[0]).hypot(there[1] - here[1])
            })
        })
        .collect();
    let far = (lengths.len() * 19 / 20).min(lengths.len() - 1);
    let (_, &mut length, _) = lengths.select_nth_unstable_by(far, f64::total_cmp);
    length / 2.0
}

/// Scores of all landmarks and of the sensor under the present model, over every `stride`-th set.
fn expectation(
    graph: &LinkGraph,
    sets: &SeenSets,
    stride: usize,
    model: &Model,
    observer: &dyn Observer,
) -> Result<(Vec<Scores>, SharedScores), MapError> {
    let posterior = Posterior::new(graph, model);
    let pool = Mutex::new(Vec::new());
    let mut landmarks = vec![Scores::default(); graph.landmarks()];
    let mut shared = SharedScores::default();
    let chosen: Vec<usize> = (0..sets.len()).step_by(stride).collect();
    for wave in chosen.chunks(CHUNK * WAVE) {
        if observer.interrupted() {
            return Err(MapError::Interrupted);
        }
        let scored: Vec<_> = wave
            .par_chunks(CHUNK)
            .map(|chunk| {
                let idle = pool.lock().expect("no worker panics (bug in covimap)").pop();
                let mut workspace = idle.unwrap_or_else(|| Workspace::new(graph.landmarks()));
                for &set in chunk {
                    posterior.score(sets.seen(set), sets.times(set), &mut workspace);
                }
                let scored = workspace.take();
                pool.lock().expect("no worker panics (bug in covimap)").push(workspace);
                scored
            })
            .collect();
        for (touched, sensor) in scored {
            for (landmark, scores) in touched {
                landmarks[landmark as usize].add(&scores);
            }
            shared.add(&sensor);
        }
    }
    Ok((landmarks, shared))
}
