//! How often each landmark was seen, and how often each two of them together.

mod count;
mod join;
mod rows;
mod tally;

use rows::{RowBlock, Rows};

use crate::{LandmarkId, MapError, Observer, SightingLog};

/// Exact counts over a log: `n_i` (steps that show landmark i) and the sparse symmetric `n_ij`
/// (steps that show both), as one ascending row of partners a landmark.
///
/// A pair that is not stored was never seen together.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CoVisibility {
    steps: u64,
    sightings: Vec<u32>,
    /// Row i: the partners of landmark i and `n_ij` of each.
    pairs: Rows,
}

impl CoVisibility {
    /// Counts a log: exact, and the same for any number of threads.
    ///
    /// Time O(sum over steps of k^2) for steps of k landmarks, shared by all threads. The result
    /// takes 16 bytes a pair; while it is made, 4 bytes a sighting and 4 N a thread come on top.
    /// Tells the observer of [`crate::Stage::Count`], counted in landmarks.
    ///
    /// # Errors
    ///
    /// - [`MapError::TooManySteps`]: the log has 2^32 steps or more.
    /// - [`MapError::Interrupted`]: the observer asked for it.
    pub fn count(log: &SightingLog, observer: &dyn Observer) -> Result<Self, MapError> {
        count::count(log, observer)
    }

    /// Makes counts of numbers that somebody else counted: T, `n_i`, and `(i, j, n_ij)` of every
    /// pair seen together, each pair once, in any order.
    ///
    /// # Errors
    ///
    /// [`MapError::BadCounts`] if `n_i > T`, or a pair names the same landmark twice or one that
    /// does not exist, occurs twice, or has an `n_ij` outside of `1..=min(n_i, n_j)`.
    pub fn from_counts(
        steps: u64,
        sightings: Vec<u32>,
        pairs: impl IntoIterator<Item = (LandmarkId, LandmarkId, u32)>,
    ) -> Result<Self, MapError> {
        let bad = |what: String| MapError::BadCounts { what };
        if let Some(i) = sightings.iter().position(|&count| u64::from(count) > steps) {
            return Err(bad(format!("landmark {i} is seen {} times in {steps} steps", sightings[i])));
        }
        let mut entries = Vec::new();
        for (a, b, count) in pairs {
            check_pair((a.0, b.0), count, &sightings).map_err(bad)?;
            entries.extend([(a.0, b.0, count), (b.0, a.0, count)]);
        }
        entries.sort_unstable();
        if let Some(twice) = entries.windows(2).find(|two| (two[0].0, two[0].1) == (two[1].0, two[1].1)) {
            let (a, b, _) = twice[0];
            return Err(bad(format!("pair ({a}, {b}) occurs twice; give every pair once")));
        }
        let mut block = RowBlock::new(0);
        let mut entries = entries.into_iter().peekable();
        for row in 0..sightings.len() {
            while let Some((_, partner, count)) = entries.next_if(|entry| entry.0 as usize == row) {
                block.push(partner, count);
            }
            block.end_row();
        }
        Ok(Self { steps, sightings, pairs: Rows::new(vec![block]) })
    }

    /// From `n_i` and, of every landmark, the partners that come later, ascending, with `n_ij` of each. `O(m)`.
    ///
    /// # Errors
    /// [`MapError::BadCounts`] as for [`CoVisibility::from_counts`].
    pub(crate) fn from_later_partners(
        steps: u64,
        sightings: Vec<u32>,
        later: &[Vec<(u32, u32)>],
    ) -> Result<Self, MapError> {
        let mut sizes: Vec<usize> = later.iter().map(Vec::len).collect();
        for (i, row) in (0..).zip(later) {
            for &(j, count) in row {
                check_pair((i, j), count, &sightings).map_err(|what| MapError::BadCounts { what })?;
                sizes[j as usize] += 1;
            }
        }
        let mut block = RowBlock::sized(&sizes);
        for (i, row) in (0..).zip(later) {
            for &(j, count) in row {
                block.put(j as usize, i, count);
            }
            // All earlier partners of i are in its row by now.
            for &(j, count) in row {
                block.put(i as usize, j, count);
            }
        }
        Ok(Self { steps, sightings, pairs: Rows::new(vec![block.ended()]) })
    }

    /// Number of landmarks N.
    #[must_use]
    pub fn landmarks(&self) -> usize {
        self.sightings.len()
    }

    /// Number of steps T of the log, empty ones included.
    #[must_use]
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// `n_i` of every landmark.
    #[must_use]
    pub fn sightings(&self) -> &[u32] {
        &self.sightings
    }

    /// Number of unordered pairs seen together at least once.
    #[must_use]
    pub fn pair_count(&self) -> usize {
        self.pairs.entries() / 2
    }

    /// The partners of a landmark, ascending, and `n_ij` of each.
    #[must_use]
    pub fn row(&self, id: LandmarkId) -> (&[u32], &[u32]) {
        self.pairs.row(id.index())
    }

    /// `n_ij`; 0 for a pair never seen together, `n_i` for a landmark with itself.
    #[must_use]
    pub fn together(&self, a: LandmarkId, b: LandmarkId) -> u32 {
        if a == b {
            return self.sightings[a.index()];
        }
        let (partners, together) = self.row(a);
        partners.binary_search(&b.0).map_or(0, |k| together[k])
    }

    /// Co-visibility frequency, eq. (4): `f_ij = n_ij / (n_i + n_j - n_ij)`, in `[0, 1]`.
    #[must_use]
    pub fn frequency(&self, a: LandmarkId, b: LandmarkId) -> f64 {
        let both = f64::from(self.together(a, b));
        both / (f64::from(self.sightings[a.index()]) + f64::from(self.sightings[b.index()]) - both)
    }
}

/// Whether a pair can have been seen together so often.
fn check_pair((a, b): (u32, u32), count: u32, sightings: &[u32]) -> Result<(), String> {
    let Some(&of_last) = sightings.get(a.max(b) as usize) else {
        let landmarks = sightings.len();
        return Err(format!("pair ({a}, {b}) names a landmark beyond the {landmarks} there are"));
    };
    let most = of_last.min(sightings[a.min(b) as usize]);
    if a == b {
        Err(format!("pair ({a}, {b}) names one landmark twice"))
    } else if (1..=most).contains(&count) {
        Ok(())
    } else {
        Err(format!("pair ({a}, {b}) is seen together {count} times, it can be 1 to {most}"))
    }
}

#[cfg(test)]
mod tests;
