//! Networks: links that are not distances in a plane.
//!
//! Bus stops are seen together when one line serves both, however near they are to each other; radios of a building
//! when a phone scans for long. No distance function makes such frequencies fit into the plane: under the best one
//! that can be learnt the stress-1 stays above .2, which Kruskal calls poor. (Logs of sensors with a range, at their
//! thinnest, unevenest and most erroneous, end below .16.) Near landmarks that are seen together rarely are then taken for far
//! ones, those are shortcuts at the same time, and the map crumples.
//!
//! What such a log does tell is its large shape. A link gets the odds against being seen together for a length,
//!
//! `l_ij = 1 / f_ij - 1`,  (1)
//!
//! so that one that is rare is long, and no shortcut; far landmarks get the length of the shortest path, and all lengths
//! count by their relative errors:
//!
//! `sum_pairs (r_ij - l_ij)^2 / l_ij^2`.  (2)
//!
//! Pairs that are not linked are sampled: those with one of `p` pivots, `n / p` times each.
//!
//! # Complexity
//! `O(p (n + m) log n)` for `m` links, and Newton steps on `p n` pairs.
//!
//! # Source
//! Weights of relative errors are those of T. Kamada and S. Kawai, Inf. Process. Lett. 31(1), 1989; pivots for all pairs those of M. Ortmann,
//! M. Klimenta and U. Brandes, J. Graph Algorithms Appl. 21(5), 2017.

use covimap_embed::{Pair, PairDistances, PivotDistances, Point, ShortestPaths, pivot_scaling};

use crate::MapError;
use crate::links::ALPHA;
use crate::shape::{MOST_LANDMARKS, with_paths};

/// Most pivots of eq. (2), and most pairs with one.
const PIVOTS: usize = 400;
const SAMPLES: usize = 1_500_000;
/// Least odds: those of pairs that are seen apart once in a thousand times.
const LEAST_ODDS: f64 = 1e-3;

/// The stress of a network, eq. (2).
pub(crate) struct Network {
    /// The terms of eq. (2).
    pub terms: PairDistances,
    /// Weight of all paths against all links.
    pub pull: f64,
    /// Where to begin: pivot scaling of the lengths.
    pub start: Vec<Point>,
}

/// Pivots for so many landmarks; none for more than are laid out as a network.
pub(crate) fn pivots(landmarks: usize) -> usize {
    if landmarks > MOST_LANDMARKS { 0 } else { PIVOTS.min(landmarks).min(SAMPLES / landmarks.max(1)) }
}

impl Network {
    /// Of links with the distances `sqrt(-alpha ln f)`.
    ///
    /// # Errors
    /// `Disconnected` where there are several components.
    pub fn new(links: &PairDistances) -> Result<Self, MapError> {
        let n = links.objects();
        let by_odds = |pair: &Pair| {
            let odds = (pair.distance * pair.distance / ALPHA).exp_m1().max(LEAST_ODDS);
            Pair { distance: odds, weight: 1.0 / (odds * odds), ..*pair }
        };
        let links = PairDistances::new(n, links.pairs().iter().map(by_odds).collect())?;
        let paths = PivotDistances::max_min(&ShortestPaths::new(&links), pivots(n))?;
        // Every one of the n^2 relative errors counts as much as that of a link.
        let pull = (n * n) as f64 / links.pairs().len() as f64;
        Ok(Self { terms: with_paths(&links, &paths, pull)?, start: pivot_scaling(&paths), pull })
    }
}

#[cfg(test)]
mod tests;
