//! How often each landmark was seen, and how often each two of them together.

use crate::LandmarkId;

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
