//! How far a chart as a whole may be bent.
//!
//! Every region may be in order and the chart still bent, because small errors of the links add up. What the
//! links leave free is that of [`covimap_embed::flexibility`]; the size of their errors is read off what the
//! chart leaves of them, `z_ij = |x_i - x_j| - m(d_ij)`, `m` the mean length of links of that distance.
//!
//! Chance alone would leave `(alpha / 2 d)^2 (1 - f) / n_ij` of `z^2`. What is left beyond that is wrong in a way that
//! neighbours share, near walls as a rule, and errors shared do not cancel. So the bend is larger than that of
//! independent errors as large as `z`, by `7.5 b^3` of the share `b` of `z^2` that is not chance. This form and its
//! constant are fitted to simulated worlds: halls have a share of .58 and bend 1.4 times as much as independent
//! errors would have it, street blocks .70 and 1.9 to 2.5 times, offices .74 to .75 and 3.0 to 4.5 times.

use covimap_embed::{PairDistances, Point, flexibility, flexibility_steps};
use rayon::prelude::*;

use crate::links::ALPHA;
use crate::{CoVisibility, LandmarkId, LinkGraph, MapError, Observer};

/// Links over which the mean length is taken, at least.
const BIN: usize = 50;
/// Bins of about equal size.
const BINS: usize = 40;
/// Random errors that are tried.
const DRAWS: usize = 12;
/// Bend over that of independent errors, were nothing of the errors chance.
const SHARED: f64 = 7.5;

/// Steps of which [`warp`] tells.
pub(super) fn steps() -> u64 {
    flexibility_steps(DRAWS) as u64
}

/// Standard deviation of a coordinate of a component, by what bends its chart. The observer is told of [`steps`], each
/// of which counts for `worth`.
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
) -> Result<f64, MapError> {
    let pairs = graph.to_pairs();
    let residuals = residuals(&pairs, points);
    let by_chance = |i: u32, j: u32| {
        let [a, b] = [i, j].map(|place| LandmarkId(members[place as usize]));
        let (f, both) = (counts.frequency(a, b), f64::from(counts.together(a, b)));
        (1.0 - f) / both
    };
    let ratios = pairs.pairs().iter().zip(&residuals).map(|(pair, z)| {
        let slope = ALPHA / (2.0 * pair.distance);
        // Twins, always seen together, leave nothing to chance.
        let variance = slope * slope * by_chance(pair.i, pair.j).max(1e-6);
        z * z / variance
    });
    let ratio = ratios.sum::<f64>() / residuals.len() as f64;
    let stepped = || {
        observer.advanced(worth);
        !observer.interrupted()
    };
    let independent = flexibility(&pairs, points, &residuals, DRAWS, 0, stepped)?;
    let independent = independent.ok_or(MapError::Interrupted)?;
    let shared = 1.0 - 1.0 / ratio.max(1.0);
    Ok((SHARED * shared.powi(3)).max(1.0) * independent)
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
