//! How much memory a build will take, told before it starts.
//!
//! Everything but the factor of the polish follows from four numbers: `N` landmarks, `T` steps, `S` sightings and `M`
//! pairs seen together.
//!
//! | what | bytes | while |
//! |---|---|---|
//! | log | `4 S + 8 T`, and the IDs | always |
//! | transposed log, a counter a landmark and thread | `4 S + 4 N` a thread | counting |
//! | counts | `16 M` | from counting on |
//! | links | `48 M`, twice where there are several components | from counting on |
//! | sets of landmarks seen | `4 S + 12 T` | from counting on |
//! | scaling problem, as it was and as measured, and its normal equations | `128 M + 48 N` | polish |
//! | sparse factor | see below | polish |
//! | paths from `p` pivots, where a map may be reconsidered | `100 p N` | polish |
//! | dense tables of the paper's method | `5 * 8 N^2` | classical |
//!
//! `M` is not known before counting; it is estimated from the partners of a sample of landmarks, with one pass over
//! the log. The factor of a graph in the plane has `O(N log N)` blocks. With `d = 2 M / N` links a landmark,
//!
//! `8 c N d log2(N / d)` bytes, `c = FACTOR`  (1)
//!
//! follows from taking patches of `d` landmarks for the nodes of a grid that is cut by nested dissection (A. George,
//! 1973), and `c` is measured: a hall of 20 000 landmarks needs nine tenths of that, streets and corridors about a third.
//! So the estimate is one to two times what is really taken, and more where no map has to be reconsidered.

use rustc_hash::FxHashSet;

use crate::network;
use crate::{MapError, MapperParams, Method, SightingLog};

/// Landmarks whose partners are counted.
const SAMPLE: usize = 512;
/// Entries of the factor by eq. (1).
const FACTOR: f64 = 4.5;
/// Program, buffers, and what is freed but not given back, for each byte that is in use.
const OVERHEAD: f64 = 1.25;
/// Bytes of the program and of the buffers of the reader.
const BASE: f64 = 32e6;

/// What a build is expected to take at its peak: as a rule one to two times what it does take.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct MemoryEstimate {
    /// Landmarks of the log.
    pub landmarks: u64,
    /// Pairs seen together, estimated.
    pub pairs: u64,
    /// Bytes at the peak of counting.
    pub counting: u64,
    /// Bytes at the peak of what follows: the polish, or the paper's dense tables.
    pub mapping: u64,
}

impl MemoryEstimate {
    /// Estimates the build of a log. `O(S)` time.
    #[must_use]
    pub fn of(log: &SightingLog, params: &MapperParams, threads: usize) -> Self {
        let pairs = estimated_pairs(log);
        let n = log.names().len() as f64;
        let (s, t, m) = (log.sightings() as f64, log.steps() as f64, pairs as f64);
        let ids: usize = log.names().iter().map(|id| id.len() + 48).sum();
        let held = 4.0 * s + 8.0 * t + ids as f64 + 16.0 * m;
        let counting = held + 4.0 * s + 4.0 * n * threads as f64;
        let paths = 100.0 * n * network::pivots(log.names().len()) as f64;
        let mapping = match params.method {
            Method::Auto => {
                held + 96.0 * m + 4.0 * s + 12.0 * t + 128.0 * m + 48.0 * n + factor(n, m) + paths
            }
            Method::Classical => held + 96.0 * m + 40.0 * n * n,
        };
        let peak = |bytes: f64| (BASE + OVERHEAD * bytes) as u64;
        Self { landmarks: log.names().len() as u64, pairs, counting: peak(counting), mapping: peak(mapping) }
    }

    /// Bytes at the peak.
    #[must_use]
    pub fn peak(&self) -> u64 {
        self.counting.max(self.mapping)
    }

    /// Refuses a build that is expected to take more than so many bytes.
    ///
    /// # Errors
    /// [`MapError::TooLittleMemory`].
    pub fn require(&self, allowed: u64) -> Result<(), MapError> {
        let needed = self.peak();
        if needed <= allowed {
            return Ok(());
        }
        Err(MapError::TooLittleMemory { needed, allowed, landmarks: self.landmarks, pairs: self.pairs })
    }
}

/// Eq. (1), bytes.
fn factor(n: f64, m: f64) -> f64 {
    if m <= 0.0 {
        return 0.0;
    }
    let d = (2.0 * m / n).max(1.0);
    8.0 * FACTOR * n * d * (n / d).max(2.0).log2()
}

/// Pairs seen together: exact for small logs, else from landmarks at even distances in the order of the log.
fn estimated_pairs(log: &SightingLog) -> u64 {
    let n = log.names().len();
    let every = n.div_ceil(SAMPLE).max(1);
    let mut partners = FxHashSet::default();
    for step in log.iter() {
        for &landmark in step.iter().filter(|&&landmark| (landmark as usize).is_multiple_of(every)) {
            partners.extend(step.iter().filter(|&&other| other != landmark).map(|&other| (landmark, other)));
        }
    }
    let sampled = n.div_ceil(every).max(1);
    // Every pair has two ends.
    (partners.len() as f64 / 2.0 * n as f64 / sampled as f64).round() as u64
}

#[cfg(test)]
mod tests;
