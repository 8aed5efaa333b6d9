//! How far a chart as a whole may be bent, and where.
//!
//! Every region may be in order and the chart still bent, because small errors of the links add up. What the
//! links leave free is that of [`covimap_embed::flexibility`]; the size of their errors is read off what the
//! chart leaves of them, `z_ij = |x_i - x_j| - m(d_ij)`, `m` the mean length of links of that distance.
//!
//! Counting alone leaves `c_ij = (alpha / 2 d)^2 (1 - f) / n_ij` of `z_ij^2`. That is an error of each link for itself, and
//! [`CHANCE`] times as large as told, because steps repeat each other. What is left beyond that is wrong in a way that
//! neighbours share, near walls as a rule: `s_ij^2`, the mean of `z^2 - c` over all links of `i` and `j`. It falls much
//! more slowly with the steps than chance does, and since errors shared do not cancel, it is most of what bends a map of many
//! steps among walls.
//!
//! The two constants are fitted to simulated worlds; `docs/maths/localisation.md` has the figures.

use covimap_embed::{DistanceErrors, Pair, PairDistances, Point, flexibility, flexibility_steps};
use rayon::prelude::*;

use crate::links::ALPHA;
use crate::{CoVisibility, LandmarkId, LinkGraph, MapError, Observer};

/// Links over which the mean length is taken, at least.
const BIN: usize = 50;
/// Bins of about equal size.
const BINS: usize = 40;
/// Random errors that are tried.
const DRAWS: usize = 24;
/// Errors by chance over those of independent steps.
const CHANCE: f64 = 2.8;
/// Shared errors over what the chart leaves of them.
const SHARED: f64 = 0.7;

/// Steps of which [`warp`] tells.
pub(super) fn steps() -> u64 {
    flexibility_steps(DRAWS) as u64
}

/// Standard deviation of a coordinate of every landmark of a component, by what bends its chart. The observer is told of
/// [`steps`], each of which counts for `worth`.
///
/// # Errors
/// Those of [`flexibility`].
pub(super) fn warp(
    counts: &CoVisibility,
    graph: &LinkGraph,
    members: &[u32],
    points: &[Point],
    worth: u64,
    observer: &dyn Observer,
) -> Result<Vec<f64>, MapError> {
    let pairs = graph.to_pairs();
    let chance = by_chance(counts, members, &pairs);
    let shared = beyond_chance(&pairs, &residuals(&pairs, points), &chance);
    let errors = DistanceErrors {
        own: chance.into_iter().map(|variance| CHANCE * variance.sqrt()).collect(),
        shared: shared.into_iter().map(|variance| SHARED * variance.sqrt()).collect(),
    };
    let stepped = || {
        observer.advanced(worth);
        !observer.interrupted()
    };
    flexibility(&pairs, points, &errors, DRAWS, 0, stepped)?.ok_or(MapError::Interrupted)
}

/// Variance of the distance of every link by counting, `c` of [the module](self), for independent steps.
fn by_chance(counts: &CoVisibility, members: &[u32], pairs: &PairDistances) -> Vec<f64> {
    let variance = |pair: &Pair| {
        let [a, b] = [pair.i, pair.j].map(|place| LandmarkId(members[place as usize]));
        let (f, both) = (counts.frequency(a, b), f64::from(counts.together(a, b)));
        let slope = ALPHA / (2.0 * pair.distance);
        // Twins, always seen together, leave nothing to chance.
        slope * slope * ((1.0 - f) / both).max(1e-6)
    };
    pairs.pairs().par_iter().map(variance).collect()
}

/// Mean square, over the links of both its ends, of what every link leaves beyond chance: `s^2` of [the module](self), `>= 0`.
fn beyond_chance(pairs: &PairDistances, residuals: &[f64], chance: &[f64]) -> Vec<f64> {
    let mut sums = vec![(0.0, 0.0); pairs.objects()];
    for ((pair, z), chance) in pairs.pairs().iter().zip(residuals).zip(chance) {
        for end in [pair.i, pair.j] {
            let (sum, count) = &mut sums[end as usize];
            *sum += z * z - chance;
            *count += 1.0;
        }
    }
    let mean = |pair: &Pair| {
        let [a, b] = [pair.i, pair.j].map(|end| sums[end as usize]);
        ((a.0 + b.0) / (a.1 + b.1)).max(0.0)
    };
    pairs.pairs().iter().map(mean).collect()
}

/// What a chart leaves of the links, without regard to sign.
fn residuals(pairs: &PairDistances, points: &[Point]) -> Vec<f64> {
    let all = pairs.pairs();
    let length = |k: usize| {
        let [a, b] = [all[k].i, all[k].j].map(|end| points[end as usize]);
        ((a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2)).sqrt()
    };
    // Distances are not negative: their bits ascend as they do.
    let mut order: Vec<(u64, usize)> = (0..).zip(all).map(|(k, pair)| (pair.distance.to_bits(), k)).collect();
    order.par_sort_unstable();
    let order: Vec<usize> = order.into_iter().map(|(_, k)| k).collect();
    let mut left = vec![0.0; all.len()];
    for bin in order.chunks((all.len() / BINS).max(BIN)) {
        // A bin spans some distance; within it lengths go with the distance.
        let count = bin.len() as f64;
        let ratio = bin.iter().map(|&k| length(k)).sum::<f64>()
            / count
            / (bin.iter().map(|&k| all[k].distance).sum::<f64>() / count);
        for &k in bin {
            left[k] = (length(k) - ratio * all[k].distance).abs();
        }
    }
    left
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixtures::{distance, exact_links, scattered};

    #[test]
    fn a_chart_that_fits_its_links_leaves_nothing() {
        let points = scattered(60, [2.0, 2.0], 3);
        let pairs = exact_links(&points, 0.7).to_pairs();
        assert!(residuals(&pairs, &points).iter().all(|z| *z < 1e-12));
        // Lengths that grow with the distance by the same factor are no residual either.
        let twice: Vec<Point> = points.iter().map(|point| point.map(|c| 2.0 * c)).collect();
        assert!(residuals(&pairs, &twice).iter().all(|z| *z < 1e-12));
        let mut bent = points.clone();
        bent[7][0] += 0.2;
        let left = residuals(&pairs, &bent);
        let of_seven = |k: &usize| pairs.pairs()[*k].i == 7 || pairs.pairs()[*k].j == 7;
        let worst = (0..left.len()).max_by(|&a, &b| left[a].total_cmp(&left[b])).unwrap();
        assert!(of_seven(&worst) && distance(bent[7], points[7]) > 0.19);
    }
}
