//! How well the distances in a map tell who was seen together.
//!
//! Stress compares maps that minimise the same sum. Maps that come from different sums, or from distances that were
//! learnt differently, can be compared by what they say of the log: landmarks near each other are seen together
//! more often than those far apart. Let `n_ij` of the `u_ij` steps that show landmark `i` or `j` show both. For the
//! curve that makes the log most likely,
//!
//! `ln L = max_g sum_{i<j} n_ij ln g(r_ij) + (u_ij - n_ij) ln(1 - g(r_ij))`,  `g` falling,  (1)
//!
//! over *all* pairs. Those never seen together have their say: a crumpled map, which costs the links nothing, lays
//! many of them next to each other. Nothing is asked of the unit, or of the distances that links were given.
//!
//! # Algorithm
//! Distances are sorted into bins that hold equally many linked pairs; `g` is constant in a bin, and the best falling
//! one is the monotone regression of the frequencies of the bins (T. Robertson, F. T. Wright, R. L. Dykstra, "Order
//! restricted statistical inference", 1988, section 1.5: least squares and binomial likelihood have the same solution).
//!
//! # Complexity
//! `O(n^2 log b)` for `n` landmarks and `b` bins.

use covimap_embed::{Point, isotonic_regression};
use rayon::prelude::*;

use crate::{CoVisibility, LandmarkId};

/// Most bins.
const BINS: usize = 1000;

/// `ln L` of eq. (1): `points[k]` is where landmark `members[k]` lies.
///
/// 0 where no two of them were seen together.
pub(crate) fn log_likelihood(counts: &CoVisibility, members: &[u32], points: &[Point]) -> f64 {
    let length = |i: usize, j: usize| (points[i][0] - points[j][0]).hypot(points[i][1] - points[j][1]);
    let together: Vec<(f64, u64)> = (0..members.len())
        .flat_map(|i| partners(counts, members, i).map(move |(j, both)| (length(i, j), both)))
        .collect();
    let edges = edges(together.iter().map(|&(length, _)| length).collect());
    let bin = |length: f64| edges.partition_point(|&edge| edge < length);

    let shown = |k: usize| u64::from(counts.sightings()[members[k] as usize]);
    let of_row = |i: usize| {
        let mut sums = vec![0u64; edges.len() + 1];
        (0..i).for_each(|j| sums[bin(length(i, j))] += shown(i) + shown(j));
        sums
    };
    let added = |mut sums: Vec<u64>, more: Vec<u64>| {
        sums.iter_mut().zip(more).for_each(|(sum, more)| *sum += more);
        sums
    };
    // Whole numbers: their sum does not depend on how the rows are shared out.
    let mut either =
        (0..members.len()).into_par_iter().map(of_row).reduce(|| vec![0; edges.len() + 1], added);
    let mut both = vec![0u64; edges.len() + 1];
    for (length, times) in together {
        both[bin(length)] += times;
        either[bin(length)] -= times;
    }
    let bins: Vec<(f64, f64)> =
        both.iter().zip(&either).filter(|&(_, &u)| u > 0).map(|(&n, &u)| (n as f64, u as f64)).collect();
    let rising: Vec<f64> = bins.iter().map(|&(n, u)| -n / u).collect();
    let weights: Vec<f64> = bins.iter().map(|&(_, u)| u).collect();
    let curve = isotonic_regression(&rising, &weights).expect("frequencies are finite (bug in covimap)");
    let times_log = |times: f64, chance: f64| if times > 0.0 { times * chance.ln() } else { 0.0 };
    bins.iter().zip(curve).map(|(&(n, u), g)| times_log(n, -g) + times_log(u - n, 1.0 + g)).sum()
}

/// The members after the `i`-th that were seen together with it, and how often.
fn partners<'a>(
    counts: &'a CoVisibility,
    members: &'a [u32],
    i: usize,
) -> impl Iterator<Item = (usize, u64)> + 'a {
    let (others, both) = counts.row(LandmarkId(members[i]));
    let known = others.iter().zip(both).filter(move |&(&other, _)| other > members[i]);
    known.filter_map(|(other, &both)| Some((members.binary_search(other).ok()?, u64::from(both))))
}

/// Upper edges of bins that hold equally many of the lengths.
fn edges(mut lengths: Vec<f64>) -> Vec<f64> {
    lengths.par_sort_unstable_by(f64::total_cmp);
    let size = lengths.len().div_ceil(BINS).max(1);
    let mut edges: Vec<f64> = lengths.chunks(size).map(|chunk| chunk[chunk.len() - 1]).collect();
    edges.dedup();
    edges
}

#[cfg(test)]
mod tests;
