//! Passes over complete lists.

use std::ops::Range;

use rayon::prelude::*;

use super::Forces;
use crate::{PairDistances, Point};

/// Pairs that are worked on together, and the number of interleaved sums.
const LANES: usize = 8;
/// Pairs of a task, at least.
const TASK: usize = 8192;
/// Tasks, at most: each has sums of its own for all objects.
const TASKS: usize = 16;

/// A complete pair list: row `i` of the triangle holds the pairs `(i, i + 1) .. (i, n - 1)`.
pub(crate) struct CompletePairs {
    n: usize,
    weights: Weights,
    /// Rows of each task, of about equal numbers of pairs.
    tasks: Vec<Range<usize>>,
}

enum Weights {
    Equal(f64),
    /// One a pair.
    Each(Vec<f64>),
}

/// The weights of a row, [`LANES`] at a time; known to the compiler where they are all one.
trait RowWeights: Copy + Send + Sync {
    /// Those of the pairs `from` and following.
    fn from(self, from: usize) -> impl Iterator<Item = Lanes>;
}

type Lanes = [f64; LANES];

#[derive(Clone, Copy)]
struct AllOne;

impl RowWeights for AllOne {
    fn from(self, _: usize) -> impl Iterator<Item = Lanes> {
        std::iter::repeat([1.0; LANES])
    }
}

impl RowWeights for &[f64] {
    fn from(self, from: usize) -> impl Iterator<Item = Lanes> {
        let (full, rest) = self[from..].as_chunks();
        full.iter().copied().chain(std::iter::once(padded(rest, 0.0)))
    }
}

/// Fewer than [`LANES`] values, filled up.
fn padded(values: &[f64], filler: f64) -> Lanes {
    let mut lanes = [filler; LANES];
    lanes[..values.len()].copy_from_slice(values);
    lanes
}

/// Coordinates or forces, axis by axis.
struct Axes {
    x: Vec<f64>,
    y: Vec<f64>,
}

impl CompletePairs {
    pub fn new(pairs: &PairDistances) -> Self {
        let n = pairs.objects();
        let weights = match pairs.complete_weight() {
            Some(weight) => Weights::Equal(weight),
            None => Weights::Each(pairs.pairs().iter().map(|pair| pair.weight).collect()),
        };
        let size = TASK.max(pairs.pairs().len().div_ceil(TASKS));
        let mut tasks = Vec::new();
        let mut from = 0;
        while from + 1 < n {
            let mut to = from;
            let mut count = 0;
            while to + 1 < n && count < size {
                to += 1;
                count += n - to;
            }
            tasks.push(from..to);
            from = to;
        }
        Self { n, weights, tasks }
    }

    pub fn forces(&self, points: &[Point], disparities: &[f64]) -> Forces {
        match &self.weights {
            // A common weight is multiplied in at the end.
            Weights::Equal(weight) => self.weighted(points, disparities, AllOne, *weight),
            Weights::Each(weights) => self.weighted(points, disparities, weights.as_slice(), 1.0),
        }
    }

    fn weighted(
        &self,
        points: &[Point],
        disparities: &[f64],
        weights: impl RowWeights,
        factor: f64,
    ) -> Forces {
        let [x, y] = [0, 1].map(|axis| points.iter().map(|point| point[axis]).collect());
        let at = Axes { x, y };
        let of_task = |rows: &Range<usize>| self.of_rows(rows.clone(), &at, disparities, weights);
        let partial: Vec<(f64, Axes)> = self.tasks.par_iter().map(of_task).collect();
        let mut forces = vec![[0.0; 2]; self.n];
        let mut stress = 0.0;
        for (rows, (part, sums)) in self.tasks.iter().zip(&partial) {
            stress += part;
            for (force, (x, y)) in forces[rows.start..].iter_mut().zip(sums.x.iter().zip(&sums.y)) {
                *force = [force[0] + factor * x, force[1] + factor * y];
            }
        }
        Forces { stress: factor * stress, forces }
    }

    /// Stress of the pairs in `rows`, and their forces on the objects from the first row on.
    fn of_rows(
        &self,
        rows: Range<usize>,
        at: &Axes,
        disparities: &[f64],
        weights: impl RowWeights,
    ) -> (f64, Axes) {
        let n = self.n;
        let first = rows.start;
        let mut forces = Axes { x: vec![0.0; n - first], y: vec![0.0; n - first] };
        let mut stress = [0.0; LANES];
        for i in rows {
            let pair = i * (2 * n - i - 1) / 2;
            let (own_x, x) =
                forces.x[i - first..].split_first_mut().expect("a row of its own (bug in covimap)");
            let (own_y, y) =
                forces.y[i - first..].split_first_mut().expect("a row of its own (bug in covimap)");
            let mut row = Row { own: [at.x[i], at.y[i]], stress, x: [0.0; LANES], y: [0.0; LANES] };
            let partners = [&at.x[i + 1..], &at.y[i + 1..]];
            row.pass(partners, &disparities[pair..pair + n - i - 1], weights.from(pair), [x, y]);
            stress = row.stress;
            *own_x += row.x.iter().sum::<f64>();
            *own_y += row.y.iter().sum::<f64>();
        }
        (stress.iter().sum(), forces)
    }
}

/// What adds up along a row, in interleaved sums.
struct Row {
    /// Position of the row's object.
    own: Point,
    stress: Lanes,
    /// Force on the row's object.
    x: Lanes,
    y: Lanes,
}

impl Row {
    /// Adds up the row, and subtracts the forces from those on its partners.
    fn pass(
        &mut self,
        partners: [&[f64]; 2],
        disparities: &[f64],
        mut weights: impl Iterator<Item = Lanes>,
        forces: [&mut [f64]; 2],
    ) {
        let (x, last_x) = partners[0].as_chunks();
        let (y, last_y) = partners[1].as_chunks();
        let (disparities, last_disparities) = disparities.as_chunks();
        let [fx, fy] = forces;
        let (fx, last_fx) = fx.as_chunks_mut();
        let (fy, last_fy) = fy.as_chunks_mut();
        let full = x.iter().zip(y).zip(disparities).zip(fx).zip(fy).zip(&mut weights);
        for (((((x, y), e), fx), fy), w) in full {
            self.add(x, y, e, &w, fx, fy);
        }
        if last_x.is_empty() {
            return;
        }
        // Partners in the place of the object itself, at a disparity of zero, add nothing.
        let [mut fx, mut fy] = [padded(last_fx, 0.0), padded(last_fy, 0.0)];
        let [x, y] = [padded(last_x, self.own[0]), padded(last_y, self.own[1])];
        let w = weights.next().expect("a weight a pair (bug in covimap)");
        self.add(&x, &y, &padded(last_disparities, 0.0), &w, &mut fx, &mut fy);
        last_fx.copy_from_slice(&fx[..last_fx.len()]);
        last_fy.copy_from_slice(&fy[..last_fy.len()]);
    }

    #[inline(always)]
    fn add(&mut self, x: &Lanes, y: &Lanes, e: &Lanes, w: &Lanes, fx: &mut Lanes, fy: &mut Lanes) {
        for k in 0..LANES {
            let (dx, dy) = (self.own[0] - x[k], self.own[1] - y[k]);
            let r = (dx * dx + dy * dy).sqrt();
            let miss = r - e[k];
            self.stress[k] += w[k] * miss * miss;
            let pull = if r > 0.0 { w[k] * miss / r } else { 0.0 };
            let (px, py) = (pull * dx, pull * dy);
            self.x[k] += px;
            self.y[k] += py;
            fx[k] -= px;
            fy[k] -= py;
        }
    }
}
