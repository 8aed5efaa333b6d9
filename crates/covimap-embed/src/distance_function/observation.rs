//! Counts at a distance, and how likely a curve makes them.

use super::DistanceFunction;

/// Frequencies are kept this far from 0 and 1, where a single contrary look would be impossible.
const LEAST: f64 = 1e-6;

/// What was found of one pair of objects, or of several at about the same distance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Observation {
    /// Distance `d >= 0`.
    pub distance: f64,
    /// `n`: looks that found both, `0 <= n <= m`.
    pub together: f64,
    /// `m`: looks that found at least one, `> 0`.
    pub either: f64,
}

impl Observation {
    /// Log-likelihood of the counts under a curve, a term of (2), in natural units.
    #[must_use]
    pub fn log_likelihood(&self, curve: &(impl DistanceFunction + ?Sized)) -> f64 {
        let f = expected(curve, self.distance);
        self.together * f.ln() + (self.either - self.together) * (1.0 - f).ln()
    }

    pub(super) fn check(&self) -> Result<(), &'static str> {
        if !(self.distance >= 0.0 && self.distance.is_finite()) {
            return Err("the distance must be finite and not negative");
        }
        if !(self.either > 0.0 && self.either.is_finite() && (0.0..=self.either).contains(&self.together)) {
            return Err("the counts must be finite, with 0 <= together <= either and either > 0");
        }
        Ok(())
    }
}

/// `g(d)`, kept away from 0 and 1.
pub(super) fn expected(curve: &(impl DistanceFunction + ?Sized), distance: f64) -> f64 {
    curve.frequency(distance).clamp(LEAST, 1.0 - LEAST)
}
