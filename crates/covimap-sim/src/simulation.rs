//! The loop: a pose, what is seen from it, and on to the next.

use crate::error::SimError;
use crate::motion::Journey;
use crate::recording::{Recording, Step};
use crate::sensor::Observer;
use crate::spec::RunSpec;
use crate::tally::{Summary, Tally};
use crate::world::World;

/// A run through a world, one step at a time; memory does not grow with the number of steps.
///
/// ```
/// use covimap_sim::{Floor, SimSpec, Simulation, World};
///
/// let spec = SimSpec::large(Floor::Hall {}, 50, 40);
/// let world = World::new(&spec.world, 1)?;
/// let mut simulation = Simulation::new(&world, &spec.run, 1)?;
/// let mut pairs = 0;
/// while let Some(step) = simulation.next_step() {
///     pairs += step.seen.len() * step.seen.len().saturating_sub(1) / 2;
/// }
/// assert_eq!(simulation.summary().steps, 2000);
/// assert!(pairs > 10_000);
/// # Ok::<(), covimap_sim::SimError>(())
/// ```
pub struct Simulation<'w> {
    journey: Journey<'w>,
    observer: Observer,
    seen: Vec<u32>,
    ranges: Vec<f64>,
    tally: Tally,
    left: u64,
}

impl<'w> Simulation<'w> {
    /// Sets everything up. Nothing moves until the first step is asked for.
    ///
    /// The seed gives the way, the sensing and the errors one independent stream of random numbers each; the
    /// world keeps its own seed.
    ///
    /// # Errors
    /// [`SimError::Setting`] if a setting is out of its range, [`SimError::SolidNeeded`] if a visual angle is
    /// to be measured where landmarks are points, [`SimError::NoFreePlace`] if the robot does not fit
    /// anywhere, [`SimError::OutOfReach`] if a motion that plans its way finds parts of the floor cut off.
    pub fn new(world: &'w World, spec: &RunSpec, seed: u64) -> Result<Self, SimError> {
        spec.check()?;
        Ok(Self {
            journey: Journey::new(world, spec, seed)?,
            observer: Observer::new(world, &spec.sensor, spec.errors, seed)?,
            seen: Vec::new(),
            ranges: Vec::new(),
            tally: Tally::new(world.landmarks().len()),
            left: spec.steps,
        })
    }

    /// The next observation, or `None` after the last.
    pub fn next_step(&mut self) -> Option<Step<'_>> {
        self.left = self.left.checked_sub(1)?;
        let pose = self.journey.next();
        self.observer.observe(pose, &mut self.seen);
        self.ranges.clear();
        self.ranges.extend(self.observer.ranges());
        self.tally.add(&self.seen);
        Some(Step { pose, seen: &self.seen, ranges: &self.ranges })
    }

    /// Runs to the end and keeps everything in memory.
    #[must_use]
    pub fn record(mut self) -> Recording {
        let mut recording = Recording::default();
        while let Some(step) = self.next_step() {
            recording.push(step);
        }
        recording
    }

    /// What was seen so far. Time `O(landmarks)`.
    #[must_use]
    pub fn summary(&self) -> Summary {
        self.tally.summary()
    }
}

#[cfg(test)]
mod tests;
