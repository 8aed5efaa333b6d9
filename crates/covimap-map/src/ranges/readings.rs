//! The ranges of a component, by step and by landmark.

/// A range within a component.
#[derive(Debug, Clone, Copy)]
pub(super) struct Reading {
    pub landmark: u32,
    pub step: u32,
    pub metres: f64,
}

/// All ranges of a component.
#[derive(Debug, Default)]
pub(super) struct Readings {
    /// By step, and by landmark within a step.
    all: Vec<Reading>,
    /// Those of step t are `starts[t]..starts[t + 1]`.
    starts: Vec<usize>,
    /// Places in `all`, by landmark.
    by_landmark: Vec<u32>,
    landmark_starts: Vec<usize>,
}

impl Readings {
    /// From the landmark and the metres of every range, one list a step, ascending by landmark.
    pub fn new(steps: &[Vec<(u32, f64)>], landmarks: usize) -> Self {
        let mut readings =
            Self { starts: vec![0], landmark_starts: vec![0; landmarks + 1], ..Self::default() };
        for (step, ranges) in (0..).zip(steps) {
            let reading = |&(landmark, metres)| Reading { landmark, step, metres };
            readings.all.extend(ranges.iter().map(reading));
            readings.starts.push(readings.all.len());
        }
        for reading in &readings.all {
            readings.landmark_starts[reading.landmark as usize + 1] += 1;
        }
        for i in 0..landmarks {
            readings.landmark_starts[i + 1] += readings.landmark_starts[i];
        }
        readings.by_landmark = (0..readings.all.len() as u32).collect();
        readings.by_landmark.sort_by_key(|&place| readings.all[place as usize].landmark);
        readings
    }

    /// By step, and by landmark within a step.
    pub fn all(&self) -> &[Reading] {
        &self.all
    }

    /// How many steps there are.
    pub fn steps(&self) -> usize {
        self.starts.len() - 1
    }

    /// Where the ranges of a step are.
    pub fn of_step(&self, step: usize) -> std::ops::Range<usize> {
        self.starts[step]..self.starts[step + 1]
    }

    /// The ranges to later landmarks in the same step.
    pub fn after(&self, place: usize) -> &[Reading] {
        &self.all[place + 1..self.starts[self.all[place].step as usize + 1]]
    }

    /// Where the ranges to a landmark are.
    pub fn of_landmark(&self, landmark: usize) -> impl Iterator<Item = usize> {
        let places = self.landmark_starts[landmark]..self.landmark_starts[landmark + 1];
        self.by_landmark[places].iter().map(|&place| place as usize)
    }
}
