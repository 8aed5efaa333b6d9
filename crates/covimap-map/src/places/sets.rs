//! The log as refinement reads it: the different sets of landmarks seen, and how often each was.

use rayon::prelude::*;

use crate::SightingLog;

/// Different sets of at least two landmarks, in lexical order, so that neighbours in the list are
/// neighbours in space.
pub(crate) struct SeenSets {
    starts: Vec<usize>,
    seen: Vec<u32>,
    times: Vec<u32>,
}

impl SeenSets {
    /// The sets of the steps that lie in one component; `place[landmark]` is the landmark's number in
    /// the component, or `u32::MAX` outside. Numbers ascend with those of the log.
    pub fn of_component(log: &SightingLog, place: &[u32]) -> Self {
        let inside = |step: &usize| {
            let seen = log.step(*step);
            seen.len() >= 2 && place[seen[0] as usize] != u32::MAX
        };
        let mut order: Vec<usize> = (0..log.steps()).filter(inside).collect();
        order.par_sort_unstable_by(|&a, &b| log.step(a).cmp(log.step(b)));
        let mut sets = Self { starts: vec![0], seen: Vec::new(), times: Vec::new() };
        for equal in order.chunk_by(|&a, &b| log.step(a) == log.step(b)) {
            sets.seen.extend(log.step(equal[0]).iter().map(|&landmark| place[landmark as usize]));
            sets.starts.push(sets.seen.len());
            sets.times.push(equal.len() as u32);
        }
        sets
    }

    /// Number of different sets.
    pub fn len(&self) -> usize {
        self.times.len()
    }

    /// The landmarks of a set, ascending.
    pub fn seen(&self, set: usize) -> &[u32] {
        &self.seen[self.starts[set]..self.starts[set + 1]]
    }

    /// Number of steps that show exactly this set.
    pub fn times(&self, set: usize) -> f64 {
        f64::from(self.times[set])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_sets_are_counted_and_lone_sightings_left_out() {
        let log = SightingLog::from_steps([
            vec!["A", "B"],
            vec!["C"],
            vec!["D", "E"],
            vec!["B", "A"],
            vec![],
            vec!["A", "B", "C"],
        ]);
        let sets = SeenSets::of_component(&log, &[0, 1, 2, u32::MAX, u32::MAX]);
        assert_eq!(sets.len(), 2);
        assert_eq!((sets.seen(0), sets.times(0)), ([0, 1].as_slice(), 2.0));
        assert_eq!((sets.seen(1), sets.times(1)), ([0, 1, 2].as_slice(), 1.0));
    }
}
