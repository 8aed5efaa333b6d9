//! The Shepard diagram: similarity against distance, in the map and as the curve expects it.

use covimap_embed::{DistanceCurve, DistanceFunction};
use serde::{Deserialize, Serialize};

use super::counts::PairCount;

/// Rows of the diagram.
const ROWS: usize = 20;

/// One row of the diagram: pairs of about the same frequency.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct ShepardRow {
    /// Number of pairs.
    pub pairs: u64,
    /// Median of their frequencies.
    pub frequency: f64,
    /// The distance that the curve expects at that frequency, map units.
    pub expected: f64,
    /// Quantiles 10, 25, 50, 75 and 90 % of their distances in the map.
    pub distances: [f64; 5],
}

/// Rows of as many pairs each, the highest frequencies first.
pub(super) fn diagram(curve: &DistanceCurve, pairs: &[(PairCount, f64)]) -> Vec<ShepardRow> {
    let mut sorted: Vec<(f64, f64)> =
        pairs.iter().map(|(count, distance)| (count.frequency(), *distance)).collect();
    sorted.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.total_cmp(&b.1)));
    let rows = ROWS.min(sorted.len());
    let row = |k: usize| {
        let members = &sorted[k * sorted.len() / rows..(k + 1) * sorted.len() / rows];
        let frequency = members[members.len() / 2].0;
        let mut distances: Vec<f64> = members.iter().map(|member| member.1).collect();
        distances.sort_by(f64::total_cmp);
        let quantile = |percent: usize| distances[(distances.len() - 1) * percent / 100];
        ShepardRow {
            pairs: members.len() as u64,
            frequency,
            expected: curve.distance(frequency),
            distances: [10, 25, 50, 75, 90].map(quantile),
        }
    };
    (0..rows).map(row).collect()
}
