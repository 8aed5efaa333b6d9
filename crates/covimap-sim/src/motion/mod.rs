//! Motions: how the robot goes from one observation to the next.
//!
//! A motion only wants a direction; [`Walker`] turns the wish into a step that keeps clear of everything.
//! Motions that know the floor think in patches, pieces of at most 1.5 m, and the openings between them.

mod patches;
mod patrol;
mod route;
mod scatter;
mod sweep;
mod walker;
mod wander;
mod waypoints;

#[cfg(test)]
mod tests;

use crate::error::SimError;
use crate::geometry::{Point, Pose};
use crate::seed::{Stream, stream};
use crate::spec::{Motion, RunSpec};
use crate::world::World;
use patches::Patches;
use route::Route;
pub(crate) use walker::Walker;

/// Chooses the next place.
trait Pilot: Send {
    /// Where the robot goes from here.
    fn next(&mut self, from: Pose, walker: &mut Walker<'_>) -> Pose;
}

/// One or several robots on their way, one after another.
pub(crate) struct Journey<'w> {
    walker: Walker<'w>,
    pilot: Box<dyn Pilot>,
    pose: Option<Pose>,
    /// Steps that each robot takes; the last one may take fewer.
    steps_each: u64,
    taken: u64,
}

impl<'w> Journey<'w> {
    pub(crate) fn new(world: &'w World, spec: &RunSpec, seed: u64) -> Result<Self, SimError> {
        let walker = Walker::new(world, spec.step, stream(seed, Stream::Motion))?;
        let patches = || Patches::new(world.plan(), spec.step.clearance);
        let pilot: Box<dyn Pilot> = match spec.motion {
            Motion::Wander {} => Box::new(wander::Wander),
            Motion::Scatter {} => Box::new(scatter::Scatter),
            Motion::Patrol {} => Box::new(patrol::Patrol::new(patches()?)),
            Motion::Waypoints {} => Box::new(waypoints::Waypoints::new(Route::new(world.plan(), patches()?))),
            Motion::Sweep { lane } => {
                let goals = sweep::goals(world.plan(), lane);
                Box::new(sweep::Sweep::new(Route::new(world.plan(), patches()?), goals))
            }
        };
        let steps_each = spec.steps.div_ceil(u64::from(spec.robots)).max(1);
        Ok(Self { walker, pilot, pose: None, steps_each, taken: 0 })
    }

    /// The next pose: a random start for the first step of each robot, then as the motion says.
    pub(crate) fn next(&mut self) -> Pose {
        let is_start = self.taken.is_multiple_of(self.steps_each);
        self.taken += 1;
        let pose = match self.pose {
            Some(from) if !is_start => self.pilot.next(from, &mut self.walker),
            _ => self.walker.start(),
        };
        self.pose = Some(pose);
        pose
    }
}

/// The direction from one place to another.
pub(crate) fn bearing(from: Point, to: Point) -> f64 {
    (to[1] - from[1]).atan2(to[0] - from[0])
}
