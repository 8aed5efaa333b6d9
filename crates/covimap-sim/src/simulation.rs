//! The loop: a pose, what is seen from it, and on to the next.

use crate::error::SimError;
use crate::geometry::Pose;
use crate::motion::{Walker, Wander};
use crate::seed::{Stream, stream};
use crate::sensor::RangeSensor;
use crate::spec::RunSpec;
use crate::world::World;

/// One observation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Step<'s> {
    /// Where the robot truly was.
    pub pose: Pose,
    /// Numbers of the landmarks seen, ascending, each once.
    pub seen: &'s [u32],
}

/// A robot in a world, one step at a time.
pub struct Simulation<'w> {
    walker: Walker<'w>,
    motion: Wander,
    sensor: RangeSensor,
    seen: Vec<u32>,
    left: u64,
}

impl<'w> Simulation<'w> {
    /// Sets a robot down in the world. Nothing happens until the first step is asked for.
    ///
    /// # Errors
    /// [`SimError::Setting`] if a setting is out of its range.
    pub fn new(world: &'w World, spec: &RunSpec, seed: u64) -> Result<Self, SimError> {
        Ok(Self {
            walker: Walker::new(world, spec.step, stream(seed, Stream::Motion)),
            motion: Wander::new(),
            sensor: RangeSensor::new(world, spec.range, stream(seed, Stream::Sensing)),
            seen: Vec::new(),
            left: spec.steps,
        })
    }

    /// The next observation, or `None` after the last.
    pub fn next_step(&mut self) -> Option<Step<'_>> {
        self.left = self.left.checked_sub(1)?;
        let pose = self.motion.next(&mut self.walker);
        self.seen.clear();
        self.sensor.sense(pose, &mut self.seen);
        self.seen.sort_unstable();
        Some(Step { pose, seen: &self.seen })
    }
}
