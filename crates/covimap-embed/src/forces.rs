//! One pass over the pairs: the stress of a configuration and the forces of its springs.
//!
//! With `r_ij = |x_i - x_j|` and disparities `e_ij`, a pass yields
//!
//! `sigma(X) = sum w_ij (e_ij - r_ij)^2` and `G = (V - B(X)) X`, half its gradient:
//! row i is `sum_j w_ij (1 - e_ij / r_ij) (x_i - x_j)`.
//!
//! `G` is summed pair by pair and not as the difference of `V X` and `B(X) X`, which are nearly
//! equal where a map fits well. A pair whose objects coincide pulls in no direction and rests: its
//! term is zero, which is a subgradient of its distance, so that majorisation holds.
//!
//! Complete lists have their disparities in memory as the rows of a triangle and are worked on
//! many pairs at a time; other lists go pair by pair and then object by object. Either way the
//! sums have a fixed order: the same bits for any number of threads.

use crate::{PairDistances, Point};

mod complete;
mod listed;

use complete::CompletePairs;
use listed::ListedPairs;

/// Stress and forces of a configuration.
pub(crate) struct Forces {
    /// `sigma(X)`.
    pub stress: f64,
    /// `G`.
    pub forces: Vec<Point>,
}

/// A pair list, laid out for passes over it.
pub(crate) enum PairLayout<'a> {
    /// All pairs.
    Complete(CompletePairs),
    /// Some pairs.
    Listed(ListedPairs<'a>),
}

impl<'a> PairLayout<'a> {
    pub fn new(pairs: &'a PairDistances) -> Self {
        if pairs.is_complete() {
            Self::Complete(CompletePairs::new(pairs))
        } else {
            Self::Listed(ListedPairs::new(pairs))
        }
    }

    /// Stress and forces of `points` for one disparity a pair.
    pub fn forces(&self, points: &[Point], disparities: &[f64]) -> Forces {
        match self {
            Self::Complete(pairs) => pairs.forces(points, disparities),
            Self::Listed(pairs) => pairs.forces(points, disparities),
        }
    }
}

#[cfg(test)]
mod tests;
