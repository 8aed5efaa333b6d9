//! Wandering: on and on in about the direction of the last step.

use super::{Pilot, Walker};
use crate::geometry::Pose;

/// The paper's robot, which remembers nothing but its heading.
pub(super) struct Wander;

impl Pilot for Wander {
    fn next(&mut self, from: Pose, walker: &mut Walker<'_>) -> Pose {
        walker.step(from, from.heading)
    }
}
