//! Fisher scoring of a curve with a few parameters.

use nalgebra::{SMatrix, SVector};

use super::observation::expected;
use super::{DistanceFunction, Observation};

/// Lengths tried as starts, each half again as long as the one before.
const STARTS: i32 = 12;
/// Parameters other than the first start here: a logit of 0.85, or the logarithm of an exponent of 2.
const START: [f64; 3] = [0.0, 1.75, 0.7];
/// Most steps.
const STEPS: usize = 100;
/// Done when a step gains less than this share.
const TOLERANCE: f64 = 1e-12;
/// Step of the numerical derivatives.
const DERIVATIVE: f64 = 1e-4;
/// Longest step of a parameter, all of which are logarithms or logits.
const LONGEST: f64 = 1.0;
/// Bounds of the parameters other than the first: a logit of 0.9997, an exponent between 0.05 and 20.
const BOUND: [f64; 3] = [f64::INFINITY, 8.0, 3.0];

/// Numbers mapped into `(0, 1)`.
pub(super) trait Logistic {
    /// `1 / (1 + exp(-x))`.
    fn logistic(self) -> f64;
}

impl Logistic for f64 {
    fn logistic(self) -> f64 {
        1.0 / (1.0 + (-self).exp())
    }
}

/// The curve that makes the counts most likely. The first parameter is the logarithm of a length.
///
/// Fisher scoring, damped as by Levenberg and Marquardt: with `r = (n - m f) / (f (1 - f))` and
/// `J` the derivatives of `f`, `(sum m J J' / (f (1 - f)) + mu I) s = sum r J`.
pub(super) fn maximise<C: DistanceFunction, const P: usize>(
    bins: &[Observation],
    curve: impl Fn([f64; P]) -> C,
) -> C {
    let likelihood = |at: &SVector<f64, P>| {
        let curve = curve((*at).into());
        bins.iter().map(|bin| bin.log_likelihood(&curve)).sum::<f64>()
    };
    let longest = bins.iter().map(|bin| bin.distance).fold(0.0, f64::max);
    let start = |k: i32| {
        let mut at = SVector::<f64, P>::from_fn(|row, _| START[row]);
        at[0] = (longest * 1.5_f64.powi(2 - k)).ln();
        at
    };
    let mut at = start(0);
    let mut best = likelihood(&at);
    for start in (1..STARTS).map(start) {
        let value = likelihood(&start);
        if value > best {
            (at, best) = (start, value);
        }
    }
    let mut damping = 1e-3;
    for _ in 0..STEPS {
        let (score, information) = derivatives(bins, &curve, &at);
        let scale = information.trace() / P as f64;
        let damped = information + SMatrix::<f64, P, P>::identity() * (damping * scale);
        let Some(factor) = damped.cholesky() else { break };
        let step = factor.solve(&score).map(|s| s.clamp(-LONGEST, LONGEST));
        let mut next = at + step;
        for row in 1..P {
            next[row] = next[row].clamp(-BOUND[row], BOUND[row]);
        }
        let value = likelihood(&next);
        let gain = value - best;
        // Written so that a NaN counts as a failed step.
        if gain >= 0.0 {
            (at, best) = (next, value);
            damping *= 0.1;
            if gain <= TOLERANCE * best.abs() {
                break;
            }
        } else {
            damping *= 10.0;
        }
    }
    curve(at.into())
}

/// Score and information of the parameters.
fn derivatives<C: DistanceFunction, const P: usize>(
    bins: &[Observation],
    curve: &impl Fn([f64; P]) -> C,
    at: &SVector<f64, P>,
) -> (SVector<f64, P>, SMatrix<f64, P, P>) {
    let moved: [[C; 2]; P] = std::array::from_fn(|row| {
        [DERIVATIVE, -DERIVATIVE].map(|step| {
            let mut at = *at;
            at[row] += step;
            curve(at.into())
        })
    });
    let here = curve((*at).into());
    let mut score = SVector::zeros();
    let mut information = SMatrix::zeros();
    for bin in bins {
        let f = expected(&here, bin.distance);
        let slope = |row: usize, _| {
            let [more, less] = &moved[row];
            (expected(more, bin.distance) - expected(less, bin.distance)) / (2.0 * DERIVATIVE)
        };
        let j = SVector::<f64, P>::from_fn(slope);
        let spread = f * (1.0 - f);
        score += j * ((bin.together - bin.either * f) / spread);
        information += j * j.transpose() * (bin.either / spread);
    }
    (score, information)
}
