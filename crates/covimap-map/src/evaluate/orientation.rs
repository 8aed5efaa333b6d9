//! Triangle-orientation error: which way triples of landmarks turn.
//!
//! The orientation of `(i, j, k)` is the sign of the sine of the angle at `i` from `j` to `k`.
//! A sine below `1e-12` is no orientation: the triple is collinear, or two of it coincide.
//!
//! # Algorithm
//! 1. For every landmark `i`, unit vectors to all later ones, in the map and in truth.
//! 2. For every two of these, compare the signs of the two sines: every triple is met once.
//!    In large charts random triples stand for all of them.
//! 3. A chart may be a mirror image as a whole; of the two the one with fewer errors counts.

use std::ops::AddAssign;

use covimap_embed::Point;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

use super::{Chart, EvaluateParams, neighbours::NearestNeighbours};

/// Sine of the angle at which three landmarks count as collinear.
const COLLINEAR: f64 = 1e-12;
/// Fewest triples drawn from a chart.
const FEWEST_SAMPLES: u64 = 10_000;
/// Triples drawn from one random stream.
const BATCH: u64 = 4096;

/// Triples counted.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Tally {
    /// Triples that are not collinear in truth.
    known: u64,
    /// Those that turn in the map as in truth.
    same: u64,
    /// Those that turn the other way; the rest is collinear in the map.
    opposite: u64,
}

impl Tally {
    fn mirrored(self) -> bool {
        self.opposite > self.same
    }

    /// What a mirrored map would give.
    fn reflected_if(self, mirrored: bool) -> Self {
        if mirrored { Self { same: self.opposite, opposite: self.same, ..self } } else { self }
    }

    /// Share of wrong triples, eq. (8).
    pub fn error(self) -> Option<f64> {
        (self.known > 0).then(|| (self.known - self.same) as f64 / self.known as f64)
    }
}

impl AddAssign for Tally {
    fn add_assign(&mut self, other: Self) {
        self.known += other.known;
        self.same += other.same;
        self.opposite += other.opposite;
    }
}

impl std::iter::Sum for Tally {
    fn sum<I: Iterator<Item = Self>>(tallies: I) -> Self {
        tallies.fold(Self::default(), |mut sum, tally| {
            sum += tally;
            sum
        })
    }
}

/// Unit vectors from one landmark to some others, in the map and in truth.
#[derive(Default)]
struct Directions {
    map: [Vec<f64>; 2],
    truth: [Vec<f64>; 2],
}

impl Directions {
    fn clear(&mut self) {
        self.map.iter_mut().chain(&mut self.truth).for_each(Vec::clear);
    }

    fn push(&mut self, chart: &Chart, from: usize, to: usize) {
        for (points, unit) in [(&chart.map, &mut self.map), (&chart.truth, &mut self.truth)] {
            let [x, y] = direction(points[from], points[to]);
            unit[0].push(x);
            unit[1].push(y);
        }
    }

    /// Compares the turn from each direction to each later one.
    fn tally(&self) -> Tally {
        (0..self.map[0].len()).map(|j| self.tally_from(j)).sum()
    }

    fn tally_from(&self, j: usize) -> Tally {
        let after = |unit: &[Vec<f64>; 2]| (unit[0][j], unit[1][j]);
        let ((map_x, map_y), (true_x, true_y)) = (after(&self.map), after(&self.truth));
        let map = self.map[0][j + 1..].iter().zip(&self.map[1][j + 1..]);
        let truth = self.truth[0][j + 1..].iter().zip(&self.truth[1][j + 1..]);
        let mut tally = Tally::default();
        for ((mx, my), (tx, ty)) in map.zip(truth) {
            let (map_sine, true_sine) = (map_x * my - map_y * mx, true_x * ty - true_y * tx);
            let known = true_sine.abs() > COLLINEAR;
            let turns = known & (map_sine.abs() > COLLINEAR);
            tally.known += u64::from(known);
            tally.same += u64::from(turns & (map_sine * true_sine > 0.0));
            tally.opposite += u64::from(turns & (map_sine * true_sine < 0.0));
        }
        tally
    }
}

/// The unit vector; zero between coincident points, which then turn nowhere.
fn direction(from: Point, to: Point) -> Point {
    let (x, y) = (to[0] - from[0], to[1] - from[1]);
    let length = x.hypot(y);
    if length > 0.0 { [x / length, y / length] } else { [0.0; 2] }
}

/// Every triple of a chart.
fn all(chart: &Chart) -> Tally {
    (0..chart.len())
        .into_par_iter()
        .map_init(Directions::default, |directions, i| {
            directions.clear();
            (i + 1..chart.len()).for_each(|j| directions.push(chart, i, j));
            directions.tally()
        })
        .sum()
}

/// `count` random triples of a chart.
fn sampled(chart: &Chart, count: u64, seed: u64) -> Tally {
    let n = chart.len();
    (0..count.div_ceil(BATCH))
        .into_par_iter()
        .map(|batch| {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            rng.set_stream(batch);
            let mut directions = Directions::default();
            let draw = |_| {
                let i = rng.random_range(0..n);
                // Two others: the ring from i on has n - 1 of them.
                let (a, b) = (rng.random_range(1..n), rng.random_range(1..n - 1));
                directions.clear();
                directions.push(chart, i, (i + a) % n);
                directions.push(chart, i, (i + if b < a { b } else { b + 1 }) % n);
                directions.tally()
            };
            (batch * BATCH..count.min((batch + 1) * BATCH)).map(draw).sum()
        })
        .sum()
}

/// Every landmark with the pairs of its nearest true neighbours.
pub(super) fn near(chart: &Chart, neighbours: &NearestNeighbours, mirrored: bool) -> Tally {
    let tally: Tally = (0..chart.len())
        .into_par_iter()
        .map_init(Directions::default, |directions, i| {
            directions.clear();
            neighbours.row(i).iter().for_each(|&j| directions.push(chart, i, j as usize));
            directions.tally()
        })
        .sum();
    tally.reflected_if(mirrored)
}

/// The orientation error of charts, each in the better of its two mirror images.
pub(super) struct Orientations {
    charts: Vec<ChartOrientation>,
}

struct ChartOrientation {
    mirrored: bool,
    tally: Tally,
    /// Whether the tally is of random triples.
    drawn: bool,
    /// Triples of the chart for each triple of the tally: 1 when all were counted.
    weight: f64,
}

impl Orientations {
    pub fn of(charts: &[Chart], params: &EvaluateParams) -> Self {
        let large = |chart: &Chart| chart.len() > params.exact_up_to;
        let to_sample: f64 = charts.iter().filter(|chart| large(chart)).map(triples).sum();
        let count = |chart: &Chart| {
            if !large(chart) {
                return ChartOrientation::counted(all(chart));
            }
            let share = params.samples as f64 * (triples(chart) / to_sample);
            let count = (share as u64).max(FEWEST_SAMPLES);
            let weight = triples(chart) / count as f64;
            let tally = sampled(chart, count, params.seed);
            ChartOrientation { drawn: true, weight, ..ChartOrientation::counted(tally) }
        };
        Self { charts: charts.iter().map(count).collect() }
    }

    /// Whether each chart is a mirror image.
    pub fn mirrored(&self) -> impl Iterator<Item = bool> {
        self.charts.iter().map(|chart| chart.mirrored)
    }

    /// Eq. (8) over the triples of all charts.
    pub fn error(&self) -> Option<f64> {
        let wrong: f64 = self.charts.iter().map(|c| c.weight * (c.tally.known - c.tally.same) as f64).sum();
        let known = self.known();
        (known > 0.0).then(|| wrong / known)
    }

    /// Standard error of [`Self::error`]; `None` when all triples were counted.
    ///
    /// The wrong triples among `m` known ones drawn are binomial: their number has the variance
    /// `m e (1 - e)`, and the number in the chart is `weight` times theirs.
    pub fn standard_error(&self) -> Option<f64> {
        let drawn = self.charts.iter().filter(|chart| chart.drawn);
        let variance = |chart: &ChartOrientation| {
            let error = chart.tally.error()?;
            Some(chart.weight.powi(2) * chart.tally.known as f64 * error * (1.0 - error))
        };
        let variances: Vec<f64> = drawn.filter_map(variance).collect();
        (!variances.is_empty()).then(|| variances.iter().sum::<f64>().sqrt() / self.known())
    }

    fn known(&self) -> f64 {
        self.charts.iter().map(|chart| chart.weight * chart.tally.known as f64).sum()
    }
}

impl ChartOrientation {
    fn counted(tally: Tally) -> Self {
        let mirrored = tally.mirrored();
        Self { mirrored, tally: tally.reflected_if(mirrored), drawn: false, weight: 1.0 }
    }
}

fn triples(chart: &Chart) -> f64 {
    let n = chart.len() as f64;
    n * (n - 1.0) * (n - 2.0) / 6.0
}

#[cfg(test)]
mod tests;
