//! How far a distance made of counts can be trusted.
//!
//! The variance of `phi(f)` is that of the counts, carried through the curve, and that of the
//! curve itself, which is never quite true of a pair:
//!
//! `sigma_ij^2 = v_ij + s^2`, `v_ij = ((phi(f - e) - phi(f + e)) / 2)^2`, `e^2 = tau f (1 - f) / (m + 1)`.  (1)
//!
//! Walls are different. They hide landmarks from each other, so that `f` falls and `phi(f)` is too
//! long, never too short. A distance that is longer than the map has it, by several times what is
//! usual, is doubted (Geman and McClure), one that is shorter is not:
//!
//! `w_ij = 1 / sigma_ij^2 * 1 / (1 + (r / (3 q))^2)^2`, `r = max(0, (phi(f_ij) - d_ij) / sigma_ij)`  (2)
//!
//! where `q` is the median of `|r|` over the sample, scaled to a standard deviation.
//!
//! S. Geman, D. McClure, "Statistical methods for tomographic image reconstruction", Bull. ISI 52, 1987.

use covimap_embed::{DistanceCurve, DistanceFunction};
use serde::{Deserialize, Serialize};

use super::counts::PairCount;

/// Standard deviation of a normal distribution over its median absolute deviation.
const FROM_MEDIAN: f64 = 1.4826;
/// Deviations, in standard ones, at which a long distance keeps a quarter of its weight.
const DOUBTED: f64 = 3.0;
/// Least share of its weight that a doubted distance keeps: it still holds the map together.
pub(super) const KEPT: f64 = 0.01;
/// The misfit of the curve is sought among so many values, each 0.7 times the one before.
const MISFITS: i32 = 24;

/// What (1) and (2) need to know of all pairs.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub(super) struct Trust {
    /// `tau`.
    pub repetition: f64,
    /// `s`, in map units.
    pub misfit: f64,
    /// `q`.
    pub usual: f64,
}

impl Trust {
    /// Learns `s` and `q` from pairs whose distances in the map are given.
    ///
    /// `s` makes the residuals of (1) most likely, as normal deviations.
    pub fn learn(curve: &DistanceCurve, repetition: f64, pairs: &[(PairCount, f64)]) -> Self {
        let mut trust = Self { repetition, misfit: 0.0, usual: 1.0 };
        let residuals: Vec<(f64, f64)> = pairs
            .iter()
            .map(|&(count, distance)| {
                let residual = curve.distance(count.frequency()) - distance;
                (residual * residual, trust.variance(curve, count))
            })
            .collect();
        let mean = residuals.iter().map(|residual| residual.0).sum::<f64>() / residuals.len() as f64;
        let cost = |misfit: f64| {
            let cost = |&(square, variance): &(f64, f64)| {
                let variance = variance + misfit;
                variance.ln() + square / variance
            };
            residuals.iter().map(cost).sum::<f64>()
        };
        let misfits = (0..MISFITS).map(|k| mean.max(f64::MIN_POSITIVE) * 0.7_f64.powi(k));
        let best = misfits.map(|misfit| (cost(misfit), misfit)).min_by(|a, b| a.0.total_cmp(&b.0));
        trust.misfit = best.expect("there is more than one value (bug in covimap)").1.sqrt();
        let mut deviations: Vec<f64> = pairs
            .iter()
            .zip(&residuals)
            .map(|(_, (square, variance))| (square / (variance + trust.misfit.powi(2))).sqrt())
            .collect();
        let half = deviations.len() / 2;
        let (_, &mut median, _) = deviations.select_nth_unstable_by(half, f64::total_cmp);
        trust.usual = FROM_MEDIAN * median;
        trust
    }

    /// `v_ij` of eq. (1).
    fn variance(&self, curve: &DistanceCurve, count: PairCount) -> f64 {
        let f = count.frequency();
        let error = (self.repetition * f * (1.0 - f) / (f64::from(count.either) + 1.0)).sqrt();
        // No further than half of the way to 0 or 1. Above g(0) the distance is 0, but not certainly so.
        let lower = f.min(curve.frequency(0.0));
        let (less, more) = ((lower - error).max(lower / 2.0), (f + error).min((1.0 + f) / 2.0));
        ((curve.distance(less) - curve.distance(more)) / 2.0).powi(2)
    }

    /// The weight `1 / sigma_ij^2` of a pair, and the share of it that eq. (2) leaves.
    pub fn weight(&self, curve: &DistanceCurve, count: PairCount, in_map: f64) -> (f64, f64) {
        let variance = self.variance(curve, count) + self.misfit.powi(2);
        let excess = (curve.distance(count.frequency()) - in_map).max(0.0) / variance.sqrt();
        let share = (1.0 + (excess / (DOUBTED * self.usual)).powi(2)).powi(-2);
        // All pairs may lie exactly on the curve.
        (variance.recip(), if share.is_finite() { share.max(KEPT) } else { 1.0 })
    }
}
