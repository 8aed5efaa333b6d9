//! One round after the other: places of the steps, noise, landmarks. Lengths are metres.

use covimap_embed::Point;
use rayon::prelude::*;

use super::noise::{Noise, median};
use super::normal::{Normal, add, length, sub, times};
use super::readings::{Reading, Readings};

/// Gauss-Newton steps of a place in one round.
const STEPS: usize = 3;
/// Share of the curvature added to both axes: landmarks on a line leave a place free across it.
const RIDGE: f64 = 0.01;
/// Share of the length between neighbours by which the map is taken to be off at first.
const HELD: f64 = 0.1;
/// The same where the neighbours were never seen together, at all times.
const HARDLY_HELD: f64 = 1.0;
/// Weights fall from this many standard deviations on, in the end.
pub(super) const FAR: f64 = 3.0;

/// Neighbours on the map, and how far it has them apart.
#[derive(Debug, Clone, Copy)]
pub(super) struct Edge {
    pub ends: [u32; 2],
    /// Whether they were ever seen together.
    pub seen: bool,
    pub length: f64,
    pub weight: f64,
}

/// All unknowns.
pub(super) struct Sweep<'a> {
    pub readings: &'a Readings,
    pub points: Vec<Point>,
    places: Vec<Point>,
    pub edges: Vec<Edge>,
    /// Of the ranges.
    pub weights: Vec<f64>,
    pub noise: Noise,
    /// Share of its length by which an edge whose ends were seen together is off.
    pub held: f64,
    /// Weights fall from this many standard deviations on, [`FAR`] or more.
    pub far: f64,
    /// Metres a map unit.
    pub scale: f64,
    /// Of all ranges.
    pub median: f64,
}

impl<'a> Sweep<'a> {
    /// Places in the middle of what their steps show, and the scale that the median range then has. `None` without a
    /// length. `edges` are neighbours on the map; those that were never `seen` together only hold landmarks without ranges.
    pub fn start(
        readings: &'a Readings,
        points: &[Point],
        edges: &[(u32, u32)],
        seen: impl Fn(u32, u32) -> bool,
    ) -> Option<Self> {
        let middle = |step: usize| {
            let own = &readings.all()[readings.of_step(step)];
            let sum = own.iter().fold([0.0; 2], |sum, reading| add(sum, points[reading.landmark as usize]));
            sum.map(|c| c / own.len() as f64)
        };
        let places: Vec<Point> = (0..readings.steps()).map(middle).collect();
        let mut ranges: Vec<f64> = readings.all().iter().map(|reading| reading.metres).collect();
        let away = readings
            .all()
            .iter()
            .map(|reading| length(sub(points[reading.landmark as usize], places[reading.step as usize])));
        let (range, away) = (median(&mut ranges)?, median(&mut away.collect::<Vec<_>>())?);
        let ranged = |landmark: u32| readings.of_landmark(landmark as usize).next().is_some();
        let edge = |&(a, b): &(u32, u32)| {
            let length = length(sub(points[b as usize], points[a as usize]));
            // How far apart landmarks are that a wall separates the map knows least of all.
            let held = seen(a, b) || !ranged(a) || !ranged(b);
            (length > 0.0 && held).then(|| Edge { ends: [a, b], seen: seen(a, b), length, weight: 1.0 })
        };
        (away > 0.0).then(|| {
            let mut sweep = Self {
                readings,
                points: points.to_vec(),
                places,
                edges: edges.iter().filter_map(edge).collect(),
                weights: vec![1.0; readings.all().len()],
                noise: Noise { fixed: range * range, growing: 0.0 },
                held: HELD,
                far: FAR,
                scale: 1.0,
                median: range,
            };
            sweep.enlarge(range / away);
            sweep
        })
    }

    /// The direction from the place to the landmark of a range, and by how much the range is longer than that way.
    pub fn look(&self, place: usize) -> (Point, f64) {
        let reading = &self.readings.all()[place];
        self.look_from(self.places[reading.step as usize], place)
    }

    fn look_from(&self, from: Point, place: usize) -> (Point, f64) {
        let reading = &self.readings.all()[place];
        let way = sub(self.points[reading.landmark as usize], from);
        let away = length(way).max(f64::MIN_POSITIVE);
        (way.map(|c| c / away), reading.metres - away)
    }

    /// The direction of an edge, and by how much it was longer on the map.
    pub fn strain(&self, edge: usize) -> (Point, f64) {
        let Edge { ends: [a, b], length: wanted, .. } = self.edges[edge];
        let way = sub(self.points[b as usize], self.points[a as usize]);
        let away = length(way).max(f64::MIN_POSITIVE);
        (way.map(|c| c / away), wanted - away)
    }

    fn weight(&self, place: usize, miss: f64) -> f64 {
        weight(miss, self.variance(place, miss), self.far)
    }

    /// Weighs the edges by what they miss now.
    pub fn weigh_edges(&mut self) {
        for k in 0..self.edges.len() {
            let (miss, Edge { seen, length, .. }) = (self.strain(k).1, self.edges[k]);
            let share = if seen { self.held } else { HARDLY_HELD };
            self.edges[k].weight = weight(miss, (share * length).powi(2), self.far);
        }
    }

    /// Of a range that misses by so much: by the length that the map has for it. Those of near landmarks count as
    /// no more exact than at half the median: no place is known as well as that.
    pub fn variance(&self, place: usize, miss: f64) -> f64 {
        self.noise.variance((self.readings.all()[place].metres - miss).max(0.5 * self.median))
    }

    /// Every place to where the ranges of its step fit best, and the weights of the ranges there.
    pub fn place_steps(&mut self) {
        self.place_from(|_, _, start| start);
    }

    /// The same from the other side of the landmarks of the step, where that fits better: ranges to landmarks on a
    /// line fit on both sides.
    pub fn place_across(&mut self) {
        self.place_from(|now, step, start| {
            let across = now.settled(step, now.mirrored(step, start));
            if now.cost(step, across) < now.cost(step, start) { across } else { start }
        });
    }

    fn place_from(&mut self, first: impl Fn(&Self, usize, Point) -> Point + Sync) {
        let best = |(step, &start): (usize, &Point)| self.settled(step, first(self, step, start));
        self.places = self.places.par_iter().enumerate().map(best).collect();
        self.weights = (0..self.weights.len())
            .into_par_iter()
            .map(|place| self.weight(place, self.look(place).1))
            .collect();
    }

    /// Where some Gauss-Newton steps lead.
    fn settled(&self, step: usize, mut from: Point) -> Point {
        for _ in 0..STEPS {
            let mut normal = Normal::default();
            for place in self.readings.of_step(step) {
                let (toward, miss) = self.look_from(from, place);
                normal.add(toward, -miss, self.weight(place, miss));
            }
            from = add(from, times(normal.inverse(RIDGE), normal.side));
        }
        from
    }

    /// The place on the other side of the line that best goes along the landmarks of a step.
    fn mirrored(&self, step: usize, from: Point) -> Point {
        let own = &self.readings.all()[self.readings.of_step(step)];
        let at = |reading: &Reading| self.points[reading.landmark as usize];
        let middle =
            own.iter().fold([0.0; 2], |sum, reading| add(sum, at(reading))).map(|c| c / own.len() as f64);
        let (mut even, mut odd) = (0.0, 0.0);
        for reading in own {
            let [x, y] = sub(at(reading), middle);
            (even, odd) = (even + x * x - y * y, odd + 2.0 * x * y);
        }
        // The line goes along half the angle of (even, odd); a mirror doubles it again.
        let size = length([even, odd]).max(f64::MIN_POSITIVE);
        let ([c, s], [x, y]) = ([even / size, odd / size], sub(from, middle));
        add(middle, [c * x + s * y, s * x - c * y])
    }

    /// What the ranges of a step cost from a place: `sum c^2 (e^2 / v) / (c^2 + e^2 / v)`, of which the weights are the
    /// slope.
    fn cost(&self, step: usize, from: Point) -> f64 {
        let cost = |place: usize| {
            let miss = self.look_from(from, place).1;
            let square = miss * miss / self.variance(place, miss);
            let far = self.far * self.far;
            far * square / (far + square)
        };
        self.readings.of_step(step).map(cost).sum()
    }

    /// Moves every landmark.
    pub fn move_landmarks(&mut self, moves: &[Point]) {
        self.points.iter_mut().zip(moves).for_each(|(point, &by)| *point = add(*point, by));
    }

    /// Eq. (1).
    pub fn fit_scale(&mut self) {
        let (mut across, mut square) = (0.0, 0.0);
        for (place, reading) in self.readings.all().iter().enumerate() {
            let away = reading.metres - self.look(place).1;
            across += self.weights[place] * reading.metres * away;
            square += self.weights[place] * away * away;
        }
        if across > 0.0 && square > 0.0 {
            self.enlarge(across / square);
        }
    }

    fn enlarge(&mut self, factor: f64) {
        self.scale *= factor;
        self.points.iter_mut().chain(&mut self.places).flatten().for_each(|c| *c *= factor);
        for edge in &mut self.edges {
            edge.length *= factor;
        }
    }

    /// Standard error of the scale, metres a map unit: `s / sqrt(sum w d^2)`.
    pub fn scale_error(&self) -> f64 {
        let away = |(place, reading): (usize, &Reading)| {
            self.weights[place] * (reading.metres - self.look(place).1).powi(2)
        };
        self.scale / self.readings.all().iter().enumerate().map(away).sum::<f64>().sqrt()
    }
}

/// `1 / v (c^2 / (c^2 + e^2 / v))^2` for a miss `e` of the variance `v`, `c` being `far`.
fn weight(miss: f64, variance: f64, far: f64) -> f64 {
    (far * far / (far * far + miss * miss / variance)).powi(2) / variance
}
