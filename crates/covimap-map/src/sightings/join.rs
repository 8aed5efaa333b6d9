//! Logs one after the other.

use super::interner::{Interner, NameHash};
use super::{Range, SightingLog};
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
        let renumbered = |range: &Range| Range { landmark: numbers[range.landmark as usize], ..*range };
        let mut ranges: Vec<Range> = later.ranges.iter().map(renumbered).collect();
        ranges.sort_by_key(|range| (range.step, range.landmark));
        let (names, starts) = (names.into_names(), later.starts.clone());
        Self { names, starts, seen, ranges, lines: later.lines, duplicates: later.duplicates }
    }

    /// This log and the steps of one that [`SightingLog::renumber`] made after it.
    pub(crate) fn followed_by(&self, later: &Self) -> Self {
        let mut seen = Vec::with_capacity(self.seen.len() + later.seen.len());
        seen.extend_from_slice(&self.seen);
        seen.extend_from_slice(&later.seen);
        let mut starts = Vec::with_capacity(self.starts.len() + later.steps());
        starts.extend_from_slice(&self.starts);
        starts.extend(later.starts[1..].iter().map(|end| self.seen.len() + end));
        let shifted = later.ranges.iter().map(|range| Range { step: self.steps() + range.step, ..*range });
        Self {
            names: later.names.clone(),
            starts,
            seen,
            ranges: self.ranges.iter().copied().chain(shifted).collect(),
            lines: self.lines + later.lines,
            duplicates: self.duplicates + later.duplicates,
        }
    }

    /// A log without ranges of steps that were numbered before: step t shows `seen[starts[t]..starts[t + 1]]`.
    pub(crate) fn from_numbers(names: LandmarkNames, starts: Vec<usize>, seen: Vec<u32>) -> Self {
        Self { names, starts, seen, ranges: Vec::new(), lines: 0, duplicates: 0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn logs_joined_are_the_log_that_was_cut() {
        let steps = [vec!["A", "B"], vec![], vec!["C", "A"], vec!["D", "B", "E"], vec!["E", "A"]];
        let range = |step, landmark, metres| Range { step, landmark, metres };
        let ranges = |log: SightingLog, of: &[(usize, &str, f64)]| {
            let number = |id| log.names().iter().position(|name| name == id).unwrap() as u32;
            let all = of.iter().map(|&(step, id, metres)| range(step, number(id), metres)).collect();
            log.with_ranges(all).unwrap()
        };
        let [first, second] = [&steps[..2], &steps[2..]].map(SightingLog::from_steps);
        let [first, second] =
            [ranges(first, &[(0, "B", 1.0)]), ranges(second, &[(0, "A", 2.0), (0, "C", 3.0)])];
        let joined = first.followed_by(&first.renumber(&second));
        assert_eq!(joined.ranges(), [range(0, 1, 1.0), range(2, 0, 2.0), range(2, 2, 3.0)]);
        let whole = SightingLog::from_steps(&steps);
        for cut in 0..=steps.len() {
            let [first, second] = [&steps[..cut], &steps[cut..]].map(SightingLog::from_steps);
            let later = first.renumber(&second);
            assert_eq!(later.names(), whole.names());
            assert_eq!(first.followed_by(&later), whole, "cut at {cut}");
        }
    }
}
