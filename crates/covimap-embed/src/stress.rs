//! How well a configuration fits: raw stress, normalised stress and stress-1.

use rayon::prelude::*;

use crate::{PairDistances, Point};

/// Pairs handled by one task, and the unit of the fixed-order sums: a partial sum covers the same
/// pairs however many threads there are.
pub(crate) const CHUNK: usize = 4096;

/// `r_ij = |x_i - x_j|`.
pub(crate) fn distance(a: Point, b: Point) -> f64 {
    let (dx, dy) = (a[0] - b[0], a[1] - b[1]);
    (dx * dx + dy * dy).sqrt()
}

/// Raw stress `sum w_ij (|x_i - x_j| - d_ij)^2`.
///
/// The sum is taken in a fixed order: the same bits for any number of threads.
#[must_use]
pub fn raw_stress(pairs: &PairDistances, points: &[Point]) -> f64 {
    FitSums::new(pairs, |k| pairs.pairs()[k].distance, points).residual
}

/// Kruskal's stress-1, `sqrt(sum w (|x_i - x_j| - d)^2 / sum w |x_i - x_j|^2)`, in `[0, 1]` at a minimum.
///
/// 0 where there is no pair; Kruskal's words for .2, .1, .05, .025 and 0 are poor, fair, good,
/// excellent and perfect (Kruskal, Psychometrika 29, 1964).
#[must_use]
pub fn stress1(pairs: &PairDistances, points: &[Point]) -> f64 {
    FitSums::new(pairs, |k| pairs.pairs()[k].distance, points).stress1()
}

/// What every kind of stress is made of, with `r_ij = |x_i - x_j|` and one disparity `e_ij` a pair.
#[derive(Clone, Copy)]
pub(crate) struct FitSums {
    /// `sum w (r - e)^2`, the raw stress.
    pub residual: f64,
    /// `sum w e^2`.
    pub disparities: f64,
    /// `sum w r^2`.
    pub distances: f64,
}

impl FitSums {
    /// The sums for the disparity that `disparity` gives each pair, by its place in the list.
    pub fn new(pairs: &PairDistances, disparity: impl Fn(usize) -> f64 + Sync, points: &[Point]) -> Self {
        let of_chunk = |(chunk, pairs): (usize, &[crate::Pair])| {
            let mut sums = [0.0; 3];
            for (k, pair) in pairs.iter().enumerate() {
                let r = distance(points[pair.i as usize], points[pair.j as usize]);
                let e = disparity(chunk * CHUNK + k);
                let miss = r - e;
                sums[0] += pair.weight * miss * miss;
                sums[1] += pair.weight * e * e;
                sums[2] += pair.weight * r * r;
            }
            sums
        };
        let partial: Vec<[f64; 3]> = pairs.pairs().par_chunks(CHUNK).enumerate().map(of_chunk).collect();
        let [residual, disparities, distances] = [0, 1, 2].map(|k| partial.iter().map(|sums| sums[k]).sum());
        Self { residual, disparities, distances }
    }

    /// `sum w (r - e)^2 / sum w e^2`; 0 if all disparities are zero.
    pub fn normalised(self) -> f64 {
        if self.disparities > 0.0 { self.residual / self.disparities } else { 0.0 }
    }

    /// `sqrt(sum w (r - e)^2 / sum w r^2)`; 0 if all objects coincide.
    pub fn stress1(self) -> f64 {
        if self.distances > 0.0 { (self.residual / self.distances).sqrt() } else { 0.0 }
    }
}

/// The pairs of each object: `rows[starts[i]..starts[i + 1]]` are `(other object, pair)`, ascending.
pub(crate) struct Incidence {
    starts: Vec<usize>,
    entries: Vec<(u32, u32)>,
}

impl Incidence {
    pub fn new(pairs: &PairDistances) -> Self {
        let mut starts = vec![0; pairs.objects() + 1];
        for pair in pairs.pairs() {
            starts[pair.i as usize + 1] += 1;
            starts[pair.j as usize + 1] += 1;
        }
        for i in 0..pairs.objects() {
            starts[i + 1] += starts[i];
        }
        let mut next = starts.clone();
        let mut entries = vec![(0, 0); 2 * pairs.pairs().len()];
        for (k, pair) in pairs.pairs().iter().enumerate() {
            for (own, other) in [(pair.i, pair.j), (pair.j, pair.i)] {
                entries[next[own as usize]] = (other, k as u32);
                next[own as usize] += 1;
            }
        }
        Self { starts, entries }
    }

    pub fn of(&self, object: usize) -> &[(u32, u32)] {
        &self.entries[self.starts[object]..self.starts[object + 1]]
    }
}

#[cfg(test)]
mod tests;
