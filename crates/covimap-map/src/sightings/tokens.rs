//! Steps as numbers: what one block of text becomes, and how blocks become a log.
//!
//! Blocks are tokenised in parallel against the names known so far, which nobody changes
//! meanwhile. A name that is new gets a provisional number behind them. The blocks are then
//! absorbed one by one, in file order: that gives new names their final numbers in the order of
//! first appearance, whatever the number of threads and the size of the blocks.

use std::borrow::Cow;

use rayon::prelude::*;

use super::Range;
use super::interner::{Interner, NameHash};
use super::problem::Problems;
use super::shown::Shown;

/// The steps of one block.
#[derive(Debug, Default)]
pub(super) struct Tokens {
    /// Names that were unknown when the block was tokenised.
    fresh: Interner,
    seen: Vec<u32>,
    /// End of each step in `seen`.
    ends: Vec<usize>,
    /// Steps are counted from the first of the block.
    ranges: Vec<Range>,
    /// IDs that occurred again within their step.
    duplicates: u64,
    /// Lines of the block that were refused.
    pub(super) problems: Problems,
}

impl Tokens {
    /// Appends steps; step k shows the IDs `ends[k - 1]..ends[k]`.
    pub(super) fn push_steps(&mut self, known: &Interner, shown: &Shown<'_>, ends: &[usize]) {
        let ids: &[Cow<'_, str>] = &shown.ids;
        let first = self.ends.len();
        let hashes: Vec<_> = ids.iter().map(|id| NameHash::of(id)).collect();
        let mut numbers =
            known.find_all(&hashes, ids).zip(&hashes).zip(ids).map(|((found, &hash), id)| {
                found.unwrap_or_else(|| known.len() + self.fresh.intern(hash, id))
            });
        let mut from = 0;
        for &end in ends {
            let start = self.seen.len();
            self.seen.extend(numbers.by_ref().take(end - from));
            self.duplicates += sort_and_dedup(&mut self.seen, start);
            self.ends.push(self.seen.len());
            from = end;
        }
        for &(place, metres) in &shown.ranges {
            let (hash, id) = (hashes[place], &ids[place]);
            let landmark = known.find(hash, id).unwrap_or_else(|| known.len() + self.fresh.intern(hash, id));
            let step = first + ends.partition_point(|&end| end <= place);
            self.ranges.push(Range { step, landmark, metres });
        }
    }

    /// Replaces provisional numbers (those from `known` on) by final ones.
    fn renumber(&mut self, known: u32, finals: &[u32]) {
        for range in self.ranges.iter_mut().filter(|range| range.landmark >= known) {
            range.landmark = finals[(range.landmark - known) as usize];
        }
        let mut start = 0;
        for &end in &self.ends {
            let step = &mut self.seen[start..end];
            // A step is ascending, so its last number tells whether any is provisional.
            let first = step.partition_point(|&number| number < known);
            if first < step.len() {
                for number in &mut step[first..] {
                    *number = finals[(*number - known) as usize];
                }
                step[first..].sort_unstable();
            }
            start = end;
        }
    }
}

/// Sorts `seen[start..]`, drops repetitions, and returns how many there were.
fn sort_and_dedup(seen: &mut Vec<u32>, start: usize) -> u64 {
    seen[start..].sort_unstable();
    let mut kept = start;
    for next in start..seen.len() {
        if kept == start || seen[next] != seen[kept - 1] {
            seen[kept] = seen[next];
            kept += 1;
        }
    }
    let dropped = seen.len() - kept;
    seen.truncate(kept);
    dropped as u64
}

/// All steps so far.
#[derive(Debug)]
pub(super) struct LogBuilder {
    pub(super) names: Interner,
    pub(super) seen: Vec<u32>,
    /// Start of each step in `seen`, and the end of the last.
    pub(super) starts: Vec<usize>,
    pub(super) ranges: Vec<Range>,
    pub(super) duplicates: u64,
}

impl LogBuilder {
    pub(super) fn new() -> Self {
        Self {
            names: Interner::default(),
            seen: Vec::new(),
            starts: vec![0],
            ranges: Vec::new(),
            duplicates: 0,
        }
    }

    /// Adds a landmark to the step that is being made.
    pub(super) fn push_sighting(&mut self, id: &str) {
        self.seen.push(self.names.intern(NameHash::of(id), id));
    }

    /// Ends the step that the last sightings make.
    pub(super) fn end_step(&mut self) {
        let start = *self.starts.last().expect("starts begin with 0 (bug in covimap)");
        self.duplicates += sort_and_dedup(&mut self.seen, start);
        self.starts.push(self.seen.len());
    }

    /// Appends blocks that were all tokenised against the present `names`, in file order.
    pub(super) fn absorb(&mut self, blocks: Vec<Tokens>) {
        let known = self.names.len();
        let finals: Vec<Vec<u32>> = blocks.iter().map(|block| self.adopt(&block.fresh)).collect();
        let mut blocks = blocks;
        blocks.par_iter_mut().zip(&finals).for_each(|(block, finals)| block.renumber(known, finals));
        for block in blocks {
            let (offset, step) = (self.seen.len(), self.starts.len() - 1);
            self.ranges.extend(block.ranges.iter().map(|range| Range { step: step + range.step, ..*range }));
            self.seen.extend_from_slice(&block.seen);
            self.starts.extend(block.ends.iter().map(|end| offset + end));
            self.duplicates += block.duplicates;
        }
    }

    /// Final numbers of a block's new names; a block before it may have brought them already.
    fn adopt(&mut self, fresh: &Interner) -> Vec<u32> {
        fresh.names().iter().map(|name| self.names.intern(NameHash::of(name), name)).collect()
    }
}
