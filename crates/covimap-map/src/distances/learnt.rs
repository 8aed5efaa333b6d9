//! Distances and weights by what a map has learnt: a curve, and how far it can be trusted.

use covimap_embed::{DistanceCurve, DistanceFunction};
use serde::{Deserialize, Serialize};

use super::counts::PairCount;
use super::weights::Trust;

/// What turns the counts of a pair into a distance and a weight, once it has been learnt.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Learnt {
    /// In the units of the map that it was fitted to.
    pub(super) curve: DistanceCurve,
    /// Units of the map that was made with it over those.
    pub(super) stretch: f64,
    pub(super) trust: Trust,
}

/// What a pair is to keep to.
pub(crate) struct Measured {
    pub distance: f64,
    pub weight: f64,
    /// Share of the weight that doubts about walls have left, in `(0, 1]`.
    pub(super) kept: f64,
}

impl Learnt {
    /// Distance and weight of a pair that lies `in_map` apart on the present map.
    pub fn measure(&self, count: PairCount, in_map: f64) -> Measured {
        let (weight, kept) = self.trust.weight(&self.curve, count, in_map);
        let distance = self.stretch * self.curve.distance(count.frequency());
        Measured { distance, weight: weight * kept, kept }
    }
}
