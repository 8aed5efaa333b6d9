//! Logs one after the other.

use super::SightingLog;
use super::interner::{Interner, NameHash};
use crate::LandmarkNames;

impl SightingLog {
    /// The steps of `later` with the numbers of this log for the landmarks of this log; those that it does not
    /// know come behind, in the order of their first appearance.
    pub(crate) fn renumber(&self, later: &Self) -> Self {
        let mut names = Interner::default();
        for name in self.names.iter().chain(later.names.iter()) {
            names.intern(NameHash::of(name), name);
        }
        let number = |name| names.find(NameHash::of(name), name).expect("all names are in (bug in covimap)");
        let numbers: Vec<u32> = later.names.iter().map(number).collect();
        let mut seen: Vec<u32> = later.seen.iter().map(|&landmark| numbers[landmark as usize]).collect();
        for ends in later.starts.windows(2) {
            seen[ends[0]..ends[1]].sort_unstable();
        }
        let (names, starts) = (names.into_names(), later.starts.clone());
        Self { names, starts, seen, lines: later.lines, duplicates: later.duplicates }
    }

    /// This log and the steps of one that [`SightingLog::renumber`] made after it.
    pub(crate) fn followed_by(&self, later: &Self) -> Self {
        let mut seen = Vec::with_capacity(self.seen.len() + later.seen.len());
        seen.extend_from_slice(&self.seen);
        seen.extend_from_slice(&later.seen);
        let mut starts = Vec::with_capacity(self.starts.len() + later.steps());
        starts.extend_from_slice(&self.starts);
        starts.extend(later.starts[1..].iter().map(|end| self.seen.len() + end));
        Self {
            names: later.names.clone(),
            starts,
            seen,
            lines: self.lines + later.lines,
            duplicates: self.duplicates + later.duplicates,
        }
    }

    /// A log of steps that were numbered before: step t shows `seen[starts[t]..starts[t + 1]]`.
    pub(crate) fn from_numbers(names: LandmarkNames, starts: Vec<usize>, seen: Vec<u32>) -> Self {
        Self { names, starts, seen, lines: 0, duplicates: 0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn logs_joined_are_the_log_that_was_cut() {
        let steps = [vec!["A", "B"], vec![], vec!["C", "A"], vec!["D", "B", "E"], vec!["E", "A"]];
        let whole = SightingLog::from_steps(&steps);
        for cut in 0..=steps.len() {
            let [first, second] = [&steps[..cut], &steps[cut..]].map(SightingLog::from_steps);
            let later = first.renumber(&second);
            assert_eq!(later.names(), whole.names());
            assert_eq!(first.followed_by(&later), whole, "cut at {cut}");
        }
    }
}
