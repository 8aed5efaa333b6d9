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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn degrees_and_radians_agree() {
        assert!((Angle::from_deg(180.0).rad() - PI).abs() < 1e-15);
        assert!((Angle::from_rad(PI / 4.0).deg() - 45.0).abs() < 1e-13);
        assert!((Angle::FULL.deg() - 360.0).abs() < 1e-13);
    }

    #[test]
    fn wrapped_angles_are_the_same_direction_within_half_a_turn() {
        for step in -100..100 {
            let angle = f64::from(step) * 0.37;
            let wrapped = wrap(angle);
            assert!((-PI..PI).contains(&wrapped));
            assert!(
                (wrapped.sin() - angle.sin()).abs() < 1e-12 && (wrapped.cos() - angle.cos()).abs() < 1e-12
            );
        }
        assert!((-PI..PI).contains(&wrap(-1e-300)) && (-PI..PI).contains(&wrap(-PI - 1e-16)));
        assert!((-PI..PI).contains(&wrap(PI)) && (-PI..PI).contains(&wrap(-PI.next_up())));
    }
}
