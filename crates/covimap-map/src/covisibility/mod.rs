//! How often each landmark was seen, and how often each two of them together.

mod count;
mod symmetric;

use symmetric::{LowerRows, symmetric};

use crate::{LandmarkId, MapError, Observer, SightingLog};

/// Exact counts over a log: `n_i` (steps that show landmark i) and the sparse symmetric `n_ij`
/// (steps that show both), as one ascending row of partners a landmark.
///
/// A pair that is not stored was never seen together.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CoVisibility {
    steps: u64,
    sightings: Vec<u32>,
    /// Row of landmark i: `starts[i]..starts[i + 1]` of `partners` and `together`.
    starts: Vec<usize>,
    partners: Vec<u32>,
    together: Vec<u32>,
}

impl CoVisibility {
    /// Counts a log: exact, and the same for any number of threads.
    ///
    /// Time O(sum over steps of k^2) for steps of k landmarks, shared by all threads; memory beside
    /// the result is 4 bytes a sighting and half of the result.
    ///
    /// # Errors
    ///
    /// [`MapError::Interrupted`] if the observer asks for it.
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
        let bad = |what: String| Err(MapError::BadCounts { what });
        if let Some(i) = sightings.iter().position(|&count| u64::from(count) > steps) {
            return bad(format!("landmark {i} is seen {} times in {steps} steps", sightings[i]));
        }
        let mut lower: Vec<(u32, u32, u32)> =
            pairs.into_iter().map(|(a, b, count)| (a.0.max(b.0), a.0.min(b.0), count)).collect();
        lower.sort_unstable();
        let mut rows = LowerRows::new(0);
        let mut pairs = lower.iter().peekable();
        for row in 0..sightings.len() {
            while let Some(&&(high, low, count)) = pairs.peek().filter(|pair| pair.0 as usize == row) {
                pairs.next();
                let most = sightings[row].min(sightings[low as usize]);
                if high == low || count == 0 || count > most {
                    return bad(format!("pair ({low}, {high}) is seen {count} times, of at most {most}"));
                }
                if pairs.peek().is_some_and(|next| (next.0, next.1) == (high, low)) {
                    return bad(format!("pair ({low}, {high}) occurs twice; give every pair once"));
                }
                rows.push(low, count);
            }
            rows.end_row();
        }
        if let Some((high, low, _)) = pairs.next() {
            return bad(format!("pair ({low}, {high}) names a landmark beyond {}", sightings.len()));
        }
        let (starts, partners, together) = symmetric(sightings.len(), &[rows]);
        Ok(Self { steps, sightings, starts, partners, together })
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
        self.partners.len() / 2
    }

    /// The partners of a landmark, ascending, and `n_ij` of each.
    #[must_use]
    pub fn row(&self, id: LandmarkId) -> (&[u32], &[u32]) {
        let range = self.starts[id.index()]..self.starts[id.index() + 1];
        (&self.partners[range.clone()], &self.together[range])
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

#[cfg(test)]
mod tests;
