//! Angles that cannot be given in the wrong unit.

use std::f64::consts::PI;

use serde::{Deserialize, Serialize};

/// An angle; a plain number of radians in files.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Angle(f64);

impl Angle {
    /// All the way round.
    pub const FULL: Self = Self(2.0 * PI);

    /// From degrees.
    #[must_use]
    pub fn from_deg(degrees: f64) -> Self {
        Self(degrees.to_radians())
    }

    /// From radians.
    #[must_use]
    pub fn from_rad(radians: f64) -> Self {
        Self(radians)
    }

    /// In degrees.
    #[must_use]
    pub fn deg(self) -> f64 {
        self.0.to_degrees()
    }

    /// In radians.
    #[must_use]
    pub fn rad(self) -> f64 {
        self.0
    }
}

/// The same direction as `radians`, in `[-pi, pi)`.
pub(crate) fn wrap(radians: f64) -> f64 {
    let turned = (radians + PI).rem_euclid(2.0 * PI) - PI;
    // Just below 0 the remainder rounds up to the full turn itself.
    if turned < PI { turned } else { -PI }
}
