//! Wandering: on and on in about the direction of the last step.

use super::Walker;
use crate::geometry::Pose;

/// Where a wandering robot is.
pub(crate) struct Wander {
    pose: Option<Pose>,
}

impl Wander {
    pub(crate) fn new() -> Self {
        Self { pose: None }
    }

    pub(crate) fn next(&mut self, walker: &mut Walker<'_>) -> Pose {
        let pose = match self.pose {
            None => walker.start(),
            Some(pose) => walker.step(pose, pose.heading),
        };
        self.pose = Some(pose);
        pose
    }
}
