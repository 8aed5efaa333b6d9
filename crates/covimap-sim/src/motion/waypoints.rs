//! Way-points: by a short way to one random place after the other.

use super::route::Route;
use super::{Pilot, Walker};
use crate::geometry::Pose;

/// On its way to a random place.
pub(super) struct Waypoints {
    route: Route,
}

impl Waypoints {
    pub(super) fn new(route: Route) -> Self {
        Self { route }
    }
}

impl Pilot for Waypoints {
    fn next(&mut self, from: Pose, walker: &mut Walker<'_>) -> Pose {
        if self.route.goal().is_none_or(|goal| walker.has_arrived(from.at, goal)) {
            self.route.set_goal(walker.place());
        }
        walker.step(from, self.route.direction(from.at))
    }
}
