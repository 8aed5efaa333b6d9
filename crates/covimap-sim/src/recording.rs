//! Observations, one by one and all of a run in memory.

use crate::geometry::Pose;

/// One observation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Step<'s> {
    /// Where the robot truly was.
    pub pose: Pose,
    /// Numbers of the landmarks seen, ascending, each once.
    pub seen: &'s [u32],
    /// Measured distances to them, metres, in their order; empty unless the sensor measures ranges.
    pub ranges: &'s [f64],
}

/// All observations of a run, in order.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Recording {
    poses: Vec<Pose>,
    seen: Vec<u32>,
    /// Of every sighting, or of none.
    ranges: Vec<f64>,
    /// Where the list of each step ends in `seen`.
    ends: Vec<usize>,
}

impl Recording {
    /// Appends an observation.
    pub fn push(&mut self, step: Step<'_>) {
        self.poses.push(step.pose);
        self.seen.extend_from_slice(step.seen);
        self.ranges.extend_from_slice(step.ranges);
        self.ends.push(self.seen.len());
    }

    /// Number of observations.
    #[must_use]
    pub fn len(&self) -> usize {
        self.poses.len()
    }

    /// Whether there is no observation.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.poses.is_empty()
    }

    /// The observation with this number, counted from 0.
    ///
    /// # Panics
    /// If there are not so many.
    #[must_use]
    pub fn step(&self, number: usize) -> Step<'_> {
        let start = if number == 0 { 0 } else { self.ends[number - 1] };
        let sightings = start..self.ends[number];
        let ranges = self.ranges.get(sightings.clone()).unwrap_or_default();
        Step { pose: self.poses[number], seen: &self.seen[sightings], ranges }
    }

    /// All observations in order; `.take(n)` is the log as it was after `n` steps.
    pub fn steps(&self) -> impl ExactSizeIterator<Item = Step<'_>> {
        (0..self.len()).map(|number| self.step(number))
    }
}
