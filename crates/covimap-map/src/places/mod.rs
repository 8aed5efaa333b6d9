//! Refinement: the map under which the whole log is most likely.
//!
//! Distances made of pair counts use the log two landmarks at a time, and their distance function
//! is only an assumption. Here every step is used as a whole. It was made at *some* place `y`,
//! which is unknown and is summed out; a landmark at `x_i` is seen from there with probability
//!
//! `P_i(y) = e + (p_i - e) / (1 + exp((|y - x_i| - R) / s))`  (1)
//!
//! with a range `R`, an edge width `s` and a probability `e` of a false sighting shared by all, and a
//! detectability `p_i` of each landmark. The log-likelihood of the log is, up to a constant,
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
//! Expectation-maximisation. The posterior of each step's place is taken on a [`grid`] around the
//! landmarks seen ([`posterior`]); then every landmark makes one Fisher-scoring step in position
//! and detectability ([`scoring`]), and `s` and `e` one in common ([`sensor_fit`]). `R` is fitted first and
//! then held: it fixes the unit.
//!
//! # Complexity
//! `O(k c)` a step and iteration, `k` landmarks near and `c` grid cells (64). Equal sets are
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

mod again;
mod grid;
mod observe;
mod posterior;
mod scoring;
mod sensor;
mod sensor_fit;
mod sets;

use std::sync::Mutex;

use covimap_embed::Point;
use rayon::prelude::*;

use crate::{LinkGraph, MapError, Observer};
pub(crate) use again::{Again, refine_some};
pub(crate) use observe::{observe, sets_observed};
use posterior::{Neighbours, Posterior, Workspace};
use scoring::{ScoreBoard, Scores};
use sensor::FALSE_SIGHTING;
pub(crate) use sensor::Sensor;
use sensor_fit::SensorScores;
pub(crate) use sets::SeenSets;

/// Sets of one parallel task.
const CHUNK: usize = 2048;
/// Tasks whose scores are held at the same time.
const WAVE: usize = 64;
/// Steps of the sensor before landmarks move.
const SENSOR_STEPS: usize = 5;
/// Sets, evenly spread over the log, that the sensor is fitted to: two numbers need no more.
const SENSOR_SETS: usize = 4096;
/// Sets of one parallel task of the sensor.
const SENSOR_CHUNK: usize = 512;
/// Longest move of a landmark in one iteration, as a share of the range.
const LONGEST_MOVE: f64 = 0.2;
/// Landmarks move by this many scoring steps at once: the place of a step follows its landmarks
/// only in part, so that single steps fall short.
const RELAXED: f64 = 1.5;
/// Done when the landmarks move by less than this share of their standard deviations: what is left
/// to gain is far below what the log leaves open.
const STILL: f64 = 0.35;

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
    let neighbours = Neighbours::new(graph);
    let mut model = fit_sensor(graph, &neighbours, sets, start);
    for _ in 0..iterations {
        let scores = landmark_scores(&neighbours, sets, &model, |_| (), observer)?;
        let moved = model.move_landmarks(&scores, |_| true);
        model.sensor = sensor_scores(&neighbours, sets, &model).improve(model.sensor, false);
        observer.advanced(1);
        if moved < STILL {
            break;
        }
    }
    Ok(model)
}

/// The sensor that fits these positions best; detectabilities are all the same so far.
fn fit_sensor(graph: &LinkGraph, neighbours: &Neighbours, sets: &SeenSets, points: Vec<Point>) -> Model {
    let range = half_far_link(graph, &points);
    let false_sighting = FALSE_SIGHTING.0;
    let sensor = Sensor { range, edge: 0.15 * range, detectability: 0.8, false_sighting };
    let mut model = Model { detectability: Vec::new(), points, sensor };
    for _ in 0..SENSOR_STEPS {
        model.detectability = vec![model.sensor.detectability; graph.landmarks()];
        model.sensor = sensor_scores(neighbours, sets, &model).improve(model.sensor, true);
    }
    model
}

impl Model {
    /// One Fisher-scoring step of every landmark that is free; returns the length of the moves in standard
    /// deviations, both as root mean squares over the landmarks.
    fn move_landmarks(&mut self, scores: &[Scores], free: impl Fn(usize) -> bool) -> f64 {
        let longest = LONGEST_MOVE * self.sensor.range;
        let (mut squares, mut variances) = (0.0, 0.0);
        let landmarks = self.points.iter_mut().zip(&mut self.detectability).zip(scores).enumerate();
        for (_, ((point, p), scores)) in landmarks.filter(|landmark| free(landmark.0)) {
            let step = scores.step(longest);
            *point = [point[0] + RELAXED * step[0], point[1] + RELAXED * step[1]];
            *p = scores.improved_detectability(*p, self.sensor.detectability);
            squares += step[0] * step[0] + step[1] * step[1];
            variances += scores.variance();
        }
        if squares > 0.0 { (squares / variances).sqrt() } else { 0.0 }
    }
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

/// Scores of the sensor under the present model, over a sample of the sets.
fn sensor_scores(neighbours: &Neighbours, sets: &SeenSets, model: &Model) -> SensorScores {
    let posterior = Posterior::new(neighbours, model);
    let sample: Vec<usize> = (0..sets.len()).step_by(sets.len().div_ceil(SENSOR_SETS).max(1)).collect();
    let parts: Vec<SensorScores> = sample
        .par_chunks(SENSOR_CHUNK)
        .map(|chunk| {
            let mut workspace = Workspace::new(neighbours.landmarks());
            let mut scores = SensorScores::default();
            for &set in chunk {
                let step = posterior.of(sets.seen(set), &mut workspace);
                scores.gather(&step, sets.times(set), model.sensor, posterior.sight());
            }
            scores
        })
        .collect();
    let mut scores = SensorScores::default();
    parts.iter().for_each(|part| scores.add(part));
    scores
}

/// Scores of all landmarks under the present model, over all sets; `done` is told how many more of these are.
fn landmark_scores(
    neighbours: &Neighbours,
    sets: &SeenSets,
    model: &Model,
    done: impl Fn(u64),
    observer: &dyn Observer,
) -> Result<Vec<Scores>, MapError> {
    let n = neighbours.landmarks();
    let posterior = Posterior::new(neighbours, model);
    let idle = Mutex::new(Vec::new());
    let mut landmarks = vec![Scores::default(); n];
    for wave in (0..sets.len()).step_by(CHUNK * WAVE) {
        if observer.interrupted() {
            return Err(MapError::Interrupted);
        }
        let end = sets.len().min(wave + CHUNK * WAVE);
        let scored: Vec<_> = (wave..end)
            .into_par_iter()
            .step_by(CHUNK)
            .map(|first| {
                let idling = idle.lock().expect("no worker panics (bug in covimap)").pop();
                let (mut workspace, mut board) =
                    idling.unwrap_or_else(|| (Workspace::new(n), ScoreBoard::new(n)));
                for set in first..sets.len().min(first + CHUNK) {
                    let step = posterior.of(sets.seen(set), &mut workspace);
                    board.gather(&step, sets.times(set), posterior.sight());
                }
                let scores = board.take();
                idle.lock().expect("no worker panics (bug in covimap)").push((workspace, board));
                scores
            })
            .collect();
        for (landmark, scores) in scored.into_iter().flatten() {
            landmarks[landmark as usize].add(&scores, 1.0);
        }
        done((end - wave) as u64);
    }
    Ok(landmarks)
}

#[cfg(test)]
mod tests;
