//! The families with two or three parameters.

use std::f64::consts::FRAC_2_PI;

use serde::{Deserialize, Serialize};

use super::DistanceFunction;

/// Newton steps for the inverse of the lens; its start is within 10 %.
const LENS_STEPS: usize = 6;

/// `f = f0 exp(-(d/a)^c)`: the families log (`c = 2`) and power.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct StretchedExponential {
    /// `f0`, the frequency of objects that coincide, in `(0, 1]`.
    pub nearest: f64,
    /// `a`, the distance at which the frequency has fallen to `f0 / e`, `> 0`.
    pub length: f64,
    /// `c > 0`.
    pub exponent: f64,
}

impl StretchedExponential {
    pub(super) fn scaled(self, factor: f64) -> Self {
        Self { length: factor * self.length, ..self }
    }
}

impl DistanceFunction for StretchedExponential {
    fn frequency(&self, distance: f64) -> f64 {
        self.nearest * (-(distance / self.length).powf(self.exponent)).exp()
    }

    fn distance(&self, frequency: f64) -> f64 {
        self.length * (self.nearest / frequency).ln().max(0.0).powf(1.0 / self.exponent)
    }
}

/// `f = 1 / (1/f0 + (d/a)^2)`: the family inverse.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct InverseSquare {
    /// `f0`, the frequency of objects that coincide, in `(0, 1]`.
    pub nearest: f64,
    /// `a`, the distance at which `1/f` has risen by 1, `> 0`.
    pub length: f64,
}

impl InverseSquare {
    pub(super) fn scaled(self, factor: f64) -> Self {
        Self { length: factor * self.length, ..self }
    }
}

impl DistanceFunction for InverseSquare {
    fn frequency(&self, distance: f64) -> f64 {
        1.0 / (1.0 / self.nearest + (distance / self.length).powi(2))
    }

    fn distance(&self, frequency: f64) -> f64 {
        self.length * (1.0 / frequency - 1.0 / self.nearest).max(0.0).sqrt()
    }
}

/// A sensor that finds objects within a range with one probability, and none beyond: the family
/// lens, `f = p l(u) / (2 - p l(u))`.
///
/// Either object is found from the places in one of two discs, both from those in their overlap:
/// `f = p^2 l / (2 p - p^2 l)`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Lens {
    /// `R > 0`; objects at twice the range are never found together.
    pub range: f64,
    /// `p` in `(0, 1]`.
    pub detectability: f64,
}

impl Lens {
    pub(super) fn scaled(self, factor: f64) -> Self {
        Self { range: factor * self.range, ..self }
    }
}

impl DistanceFunction for Lens {
    fn frequency(&self, distance: f64) -> f64 {
        let both = self.detectability * overlap(distance / (2.0 * self.range));
        both / (2.0 - both)
    }

    fn distance(&self, frequency: f64) -> f64 {
        let share = 2.0 * frequency / (self.detectability * (1.0 + frequency));
        2.0 * self.range * inverse_overlap(share)
    }
}

/// `l(u)`, the share of a disc that lies in an equal one whose middle is `2u` radii away.
fn overlap(u: f64) -> f64 {
    let u = u.min(1.0);
    FRAC_2_PI * (u.acos() - u * (1.0 - u * u).sqrt())
}

/// `u` in `[0, 1]` with `l(u) = share`.
fn inverse_overlap(share: f64) -> f64 {
    if share >= 1.0 {
        return 0.0;
    }
    // Near u = 1, l = 1.2 (1 - u)^(3/2). The curve is convex: after a first step to the left of the
    // solution, Newton's steps approach it from there.
    let mut u = 1.0 - (share / 1.2).powf(2.0 / 3.0);
    for _ in 0..LENS_STEPS {
        let slope = -2.0 * FRAC_2_PI * (1.0 - u * u).sqrt();
        u = (u - (overlap(u) - share) / slope).clamp(0.0, 1.0 - 1e-12);
    }
    u
}
