//! Raw stress of a configuration and what the solvers need of it, pair by pair.

use rayon::prelude::*;

use crate::{PairDistances, Point};

/// Pairs handled by one task, and the unit of the fixed-order sums: a partial sum covers the same
/// pairs however many threads there are.
const CHUNK: usize = 4096;

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
    ordered_sum(
        pairs,
        |pair_distance, pair| {
            let miss = pair_distance - pair.distance;
            pair.weight * miss * miss
        },
        points,
    )
}

/// Kruskal's stress-1, `sqrt(sum w (|x_i - x_j| - d)^2 / sum w |x_i - x_j|^2)`, in `[0, 1]` at a minimum.
///
/// 0 where there is no pair; Kruskal's words for .2, .1, .05, .025 and 0 are poor, fair, good,
/// excellent and perfect (Kruskal, Psychometrika 29, 1964).
#[must_use]
pub fn stress1(pairs: &PairDistances, points: &[Point]) -> f64 {
    let size = ordered_sum(pairs, |pair_distance, pair| pair.weight * pair_distance * pair_distance, points);
    if size > 0.0 { (raw_stress(pairs, points) / size).sqrt() } else { 0.0 }
}

fn ordered_sum(
    pairs: &PairDistances,
    term: impl Fn(f64, &crate::Pair) -> f64 + Sync,
    points: &[Point],
) -> f64 {
    let partial: Vec<f64> = pairs
        .pairs()
        .par_chunks(CHUNK)
        .map(|chunk| {
            chunk
                .iter()
                .map(|pair| term(distance(points[pair.i as usize], points[pair.j as usize]), pair))
                .sum()
        })
        .collect();
    partial.iter().sum()
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

/// Fills `pull[k] = w d / r` for every pair (0 where the two objects coincide, so that the pair
/// rests for this step) and returns the raw stress of `points`.
pub(crate) fn pulls(pairs: &PairDistances, points: &[Point], pull: &mut [f64]) -> f64 {
    let partial: Vec<f64> = pairs
        .pairs()
        .par_chunks(CHUNK)
        .zip(pull.par_chunks_mut(CHUNK))
        .map(|(pairs, pulls)| {
            let mut stress = 0.0;
            for (pair, pull) in pairs.iter().zip(pulls) {
                let r = distance(points[pair.i as usize], points[pair.j as usize]);
                let miss = r - pair.distance;
                stress += pair.weight * miss * miss;
                *pull = if r > 0.0 { pair.weight * pair.distance / r } else { 0.0 };
            }
            stress
        })
        .collect();
    partial.iter().sum()
}

#[cfg(test)]
mod tests;
