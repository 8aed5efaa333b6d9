//! What to simulate: settings with their units, ranges and defaults, checked before anything is built.

mod run;
mod sensor;
mod world;

pub use run::{Motion, RunSpec, StepSpec};
pub use sensor::{ErrorSpec, Recognition, SensorSpec};
pub use world::{Floor, WorldSpec};

use serde::{Deserialize, Serialize};

use crate::error::SimError;

/// A world and a robot's run through it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SimSpec {
    /// The world.
    pub world: WorldSpec,
    /// The run.
    pub run: RunSpec,
}

impl SimSpec {
    /// A large world of point landmarks, and a robot that sees them from about half a metre.
    #[must_use]
    pub fn large(floor: Floor, landmarks: usize, steps_per_landmark: u64) -> Self {
        Self {
            world: WorldSpec { floor, landmarks, ..WorldSpec::default() },
            run: RunSpec {
                steps: steps_per_landmark * landmarks as u64,
                motion: floor.motion(),
                ..RunSpec::default()
            },
        }
    }

    /// The paper's room: a square with solid cylinders, a small robot with a camera that looks all round.
    ///
    /// `side` is in metres. Cylinders are 48 mm across and keep 0.1 m from each other and from the walls;
    /// steps are 0.1 m within +-45 degrees; a cylinder is recognised when more than 5 degrees of it show.
    #[must_use]
    pub fn paper_room(objects: usize, side: f64, steps: u64) -> Self {
        Self {
            world: WorldSpec {
                floor: Floor::Hall {},
                landmarks: objects,
                density: objects as f64 / (side * side),
                diameter: 0.048,
                min_gap: 0.1,
                id_prefix: "ob".to_owned(),
                ..WorldSpec::default()
            },
            run: RunSpec {
                steps,
                step: StepSpec { shortest: 0.1, longest: 0.1, clearance: 0.04, ..StepSpec::default() },
                sensor: SensorSpec { recognition: Recognition::paper(), ..SensorSpec::default() },
                ..RunSpec::default()
            },
        }
    }
}

/// The error for a setting, unless it is all right.
fn require(fine: bool, name: &'static str, value: f64, range: &'static str) -> Result<(), SimError> {
    if fine { Ok(()) } else { Err(SimError::Setting { name, value, range }) }
}

/// Checks a length that must be positive and finite.
fn require_positive(name: &'static str, value: f64) -> Result<(), SimError> {
    require(value > 0.0 && value.is_finite(), name, value, "positive and finite")
}

/// Checks a length that must not be negative, and finite.
fn require_not_negative(name: &'static str, value: f64) -> Result<(), SimError> {
    require(value >= 0.0 && value.is_finite(), name, value, "at least 0 and finite")
}

/// Checks a probability or share.
fn require_share(name: &'static str, value: f64) -> Result<(), SimError> {
    require((0.0..=1.0).contains(&value), name, value, "between 0 and 1")
}

#[cfg(test)]
mod tests;
