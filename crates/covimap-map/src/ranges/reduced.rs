//! All landmarks at once: one step of Gauss and Newton, the places of the steps being solved for on the way.
//!
//! To first order a range that misses by `e` asks for `u'(dx - dy) = e`, `u` being the direction from the place to
//! the landmark. For given moves `dx` of the landmarks the best move of a place is `A^-1 sum w u (u'dx - e)` with `A =
//! sum w u u'` over its ranges. Put in, equations for the landmarks alone are left:
//!
//! ```text
//! sum w u (v - u' A^-1 sum w u v) = 0,    v = e - u'dx.
//! ```
//!
//! They are solved by conjugate gradients, over the blocks of single landmarks: errors that bend a map as a whole
//! go in tens of steps, for which moving one landmark after the other takes thousands.

use covimap_embed::Point;
use rayon::prelude::*;

use super::noise::Noise;
use super::normal::{Normal, add, dot, sub, times};
use super::readings::Reading;
use super::sweep::Sweep;

/// Most products with the matrix in one solution.
const PRODUCTS: usize = 60;
/// Share of the right side that is left.
const LEFT: f64 = 1e-3;
/// Share of the curvature of a place that is added to both axes: landmarks on a line leave it free across.
const RIDGE: f64 = 1e-6;

/// A standard deviation is at least this share of the median range: no sensor is more exact, and what is exact to the
/// last digit still needs a width.
const LEAST: f64 = 1e-3;

/// Sets the noise to what the misses of a sweep tell, each made larger by what its own place took away from it.
pub(super) fn fit_noise(sweep: &mut Sweep) {
    let reduced = Reduced::new(sweep);
    let look = |(place, reading): (usize, &Reading)| {
        let miss = sweep.look(place).1;
        let free = 1.0 - reduced.leverage(place);
        (free > 0.1).then(|| (reading.metres - miss, miss / free.sqrt()))
    };
    let looks: Vec<(f64, f64)> = sweep.readings.all().par_iter().enumerate().filter_map(look).collect();
    sweep.noise = Noise::fit(looks, (LEAST * sweep.median).powi(2));
}

/// Moves every landmark of a sweep to where ranges and map fit best.
pub(super) fn move_landmarks(sweep: &mut Sweep) {
    let moves = Reduced::new(sweep).solve();
    sweep.points.iter_mut().zip(moves).for_each(|(point, by)| *point = add(*point, by));
}

/// The equations at the present state of a sweep.
struct Reduced<'a> {
    sweep: &'a Sweep<'a>,
    /// From place to landmark, for every range.
    toward: Vec<Point>,
    /// `A^-1` of every step.
    inverses: Vec<[f64; 3]>,
}

impl<'a> Reduced<'a> {
    pub fn new(sweep: &'a Sweep<'a>) -> Self {
        let toward: Vec<Point> =
            (0..sweep.weights.len()).into_par_iter().map(|place| sweep.look(place).0).collect();
        let inverse = |step: usize| {
            let mut normal = Normal::default();
            for place in sweep.readings.of_step(step) {
                normal.add(toward[place], 0.0, sweep.weights[place]);
            }
            normal.inverse(RIDGE)
        };
        let inverses = (0..sweep.readings.steps()).into_par_iter().map(inverse).collect();
        Self { sweep, toward, inverses }
    }

    /// The share of its own that a range has in the place of its step.
    pub fn leverage(&self, place: usize) -> f64 {
        let toward = self.toward[place];
        let step = self.sweep.readings.all()[place].step as usize;
        self.sweep.weights[place] * dot(toward, times(self.inverses[step], toward))
    }

    /// The moves of all landmarks.
    pub fn solve(&self) -> Vec<Point> {
        let blocks = self.blocks();
        let precondition = |v: &[Point]| -> Vec<Point> {
            blocks.iter().zip(v).map(|(&block, &v)| times(block, v)).collect()
        };
        let mut left = self.gather(|place| self.sweep.look(place).1, |edge| self.sweep.strain(edge).1);
        let mut moves = vec![[0.0; 2]; left.len()];
        let mut towards = precondition(&left);
        let mut direction = towards.clone();
        let mut square = inner(&left, &towards);
        let enough = LEFT * LEFT * square;
        for _ in 0..PRODUCTS {
            if square <= enough {
                break;
            }
            let product = self.times(&direction);
            let length = square / inner(&direction, &product);
            moves.iter_mut().zip(&direction).for_each(|(m, d)| *m = add(*m, d.map(|c| length * c)));
            left.iter_mut().zip(&product).for_each(|(l, p)| *l = sub(*l, p.map(|c| length * c)));
            towards = precondition(&left);
            let next = inner(&left, &towards);
            let share = next / square;
            direction.iter_mut().zip(&towards).for_each(|(d, t)| *d = add(*t, d.map(|c| share * c)));
            square = next;
        }
        moves
    }

    fn times(&self, moves: &[Point]) -> Vec<Point> {
        let along = |place: usize| {
            let landmark = self.sweep.readings.all()[place].landmark as usize;
            dot(self.toward[place], moves[landmark])
        };
        let stretch = |edge: usize| {
            let [a, b] = self.sweep.edges[edge].ends;
            dot(self.sweep.strain(edge).0, sub(moves[b as usize], moves[a as usize]))
        };
        self.gather(along, stretch)
    }

    /// For what each range and each edge asks for along its direction: what the landmarks are to do, less what the
    /// places do themselves.
    fn gather(&self, range: impl Fn(usize) -> f64 + Sync, edge: impl Fn(usize) -> f64) -> Vec<Point> {
        let sweep = self.sweep;
        let place_moves = |step: usize| {
            let mut normal = Normal::default();
            for place in sweep.readings.of_step(step) {
                normal.add(self.toward[place], range(place), sweep.weights[place]);
            }
            times(self.inverses[step], normal.side)
        };
        let own: Vec<Point> = (0..sweep.readings.steps()).into_par_iter().map(place_moves).collect();
        let landmark = |i: usize| {
            let mut normal = Normal::default();
            for place in sweep.readings.of_landmark(i) {
                let toward = self.toward[place];
                let by_place = dot(toward, own[sweep.readings.all()[place].step as usize]);
                normal.add(toward, range(place) - by_place, sweep.weights[place]);
            }
            normal.side
        };
        let mut sides: Vec<Point> = (0..sweep.points.len()).into_par_iter().map(landmark).collect();
        for (k, held) in sweep.edges.iter().enumerate() {
            let pull = sweep.strain(k).0.map(|c| held.weight * edge(k) * c);
            let [a, b] = held.ends.map(|end| end as usize);
            (sides[a], sides[b]) = (sub(sides[a], pull), add(sides[b], pull));
        }
        sides
    }

    /// Inverses of the blocks of single landmarks, the places being held.
    fn blocks(&self) -> Vec<[f64; 3]> {
        let sweep = self.sweep;
        let block = |i: usize| {
            let mut normal = Normal::default();
            sweep
                .readings
                .of_landmark(i)
                .for_each(|place| normal.add(self.toward[place], 0.0, sweep.weights[place]));
            normal
        };
        let mut normals: Vec<Normal> = (0..sweep.points.len()).into_par_iter().map(block).collect();
        for (k, held) in sweep.edges.iter().enumerate() {
            for end in held.ends {
                normals[end as usize].add(sweep.strain(k).0, 0.0, held.weight);
            }
        }
        normals.iter().map(|normal| normal.inverse(RIDGE)).collect()
    }
}

fn inner(a: &[Point], b: &[Point]) -> f64 {
    a.iter().zip(b).map(|(a, b)| dot(*a, *b)).sum()
}
