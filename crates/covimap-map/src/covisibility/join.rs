//! Counts of two logs, one after the other.

use rayon::prelude::*;

use super::CoVisibility;
use super::count::check_steps;
use super::rows::{RowBlock, Rows};
use crate::{LandmarkId, MapError};

/// Rows of one parallel task.
const ROWS: usize = 512;

impl CoVisibility {
    /// The counts of the log that `later` continues: the same as counting both as one log. `later` gives the
    /// landmarks the same numbers, and has perhaps more of them. `O(m)` for `m` pairs, in parallel by rows.
    ///
    /// # Errors
    /// [`MapError::TooManySteps`] if the two have 2^32 steps or more.
    pub(crate) fn joined(&self, later: &Self) -> Result<Self, MapError> {
        let steps = self.steps + later.steps;
        check_steps(usize::try_from(steps).unwrap_or(usize::MAX))?;
        let n = later.landmarks();
        let before = |i: usize| self.sightings.get(i).copied().unwrap_or(0);
        let sightings = later.sightings.iter().enumerate().map(|(i, &more)| before(i) + more).collect();
        let blocks: Vec<RowBlock> = (0..n)
            .into_par_iter()
            .step_by(ROWS)
            .map(|first| {
                let mut block = RowBlock::new(first);
                for row in first..n.min(first + ROWS) {
                    let old = if row < self.landmarks() { self.pairs.row(row) } else { (&[][..], &[][..]) };
                    merge(old, later.row(LandmarkId(row as u32)), &mut block);
                    block.end_row();
                }
                block.finish()
            })
            .collect();
        Ok(Self { steps, sightings, pairs: Rows::new(blocks) })
    }
}

/// The sum of two ascending rows.
fn merge(old: (&[u32], &[u32]), new: (&[u32], &[u32]), block: &mut RowBlock) {
    let mut at = 0;
    for (&column, &value) in new.0.iter().zip(new.1) {
        let same = old.0[at..].partition_point(|&before| before < column) + at;
        block.extend(&old.0[at..same], &old.1[at..same]);
        at = same;
        let mut sum = value;
        if old.0.get(at) == Some(&column) {
            sum += old.1[at];
            at += 1;
        }
        block.push(column, sum);
    }
    block.extend(&old.0[at..], &old.1[at..]);
}
