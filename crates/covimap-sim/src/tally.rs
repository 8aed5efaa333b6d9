//! Counts of a run.

use serde::Serialize;

/// What a run has seen.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Summary {
    /// Landmarks in the world.
    pub landmarks: usize,
    /// Landmarks that were never seen.
    pub never_seen: usize,
    /// Observations.
    pub steps: u64,
    /// Observations in which nothing was seen.
    pub empty_steps: u64,
    /// Sightings: landmarks seen, summed over the observations.
    pub sightings: u64,
    /// Sightings per observation, 0 without observations.
    pub mean_set_size: f64,
    /// Sightings of the landmark seen least.
    pub least_sightings: u64,
    /// Lower median of the sightings over the landmarks.
    pub median_sightings: u64,
}

/// Running counts.
#[derive(Debug, Clone)]
pub(crate) struct Tally {
    by_landmark: Vec<u64>,
    steps: u64,
    empty_steps: u64,
}

impl Tally {
    pub(crate) fn new(landmarks: usize) -> Self {
        Self { by_landmark: vec![0; landmarks], steps: 0, empty_steps: 0 }
    }

    pub(crate) fn add(&mut self, seen: &[u32]) {
        self.steps += 1;
        self.empty_steps += u64::from(seen.is_empty());
        for &number in seen {
            self.by_landmark[number as usize] += 1;
        }
    }

    pub(crate) fn summary(&self) -> Summary {
        let mut counts = self.by_landmark.clone();
        counts.sort_unstable();
        let sightings = counts.iter().sum();
        Summary {
            landmarks: counts.len(),
            never_seen: counts.partition_point(|&count| count == 0),
            steps: self.steps,
            empty_steps: self.empty_steps,
            sightings,
            mean_set_size: if self.steps > 0 { sightings as f64 / self.steps as f64 } else { 0.0 },
            least_sightings: counts.first().copied().unwrap_or(0),
            median_sightings: counts.get(counts.len().saturating_sub(1) / 2).copied().unwrap_or(0),
        }
    }
}
