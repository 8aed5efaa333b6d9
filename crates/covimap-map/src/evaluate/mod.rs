//! How far a map is from surveyed positions.
//!
//! A map from co-visibility has no unit, no origin and no handedness, so the first two measures
//! ask for its *shape* alone and the third aligns it first:
//!
//! | measure | definition | perfect | random |
//! |---|---|---|---|
//! | Delaunay error, eq. (7) | edges in one of the two Delaunay graphs only / `(3n - 6)` | 0 | about 2 |
//! | orientation error, eq. (8) | share of triples that turn the other way than in truth | 0 | 0.5 |
//! | rmse | `sqrt(mean |t_i - (s R m_i + b)|^2)` after the best similarity fit, in truth's unit | 0 | spread |
//! | knn10 | share of the 10 nearest true neighbours that are among the 10 nearest in the map | 1 | `k / (n - 1)` |
//!
//! Equation numbers are those of T. Yairi, K. Hori, K. Hirama, *Qualitative map learning based on
//! co-visibility of objects* (the CoviMap paper).
//!
//! # Which landmarks count
//! Landmarks that map and truth share. Those of the truth that the map lacks are `missing`, those
//! of the map without a surveyed position `unknown`. Each component of the map is a chart of its
//! own, with its own frame and mirror image, so every measure is taken inside components and
//! pooled: differing edges over the sum of `3n - 6`, wrong triples over all triples inside
//! components, squared residuals over landmarks. Components with fewer than three shared
//! landmarks have no shape; their landmarks are `isolated` and left out.
//!
//! # Failure
//! [`MapError::NoCommonLandmarks`] and [`MapError::TooFewCommon`]. A measure that does not exist
//! is `None` and `null` in JSON, never NaN: collinear truth has no orientation.

mod bound;
mod charts;
mod edges;
mod limit;
mod neighbours;
mod orientation;
mod residual;

pub use bound::Bound;
pub(crate) use charts::{Chart, Matching};
pub use limit::{Limit, Ratios, limit};
pub(crate) use residual::truth_from_map;

use serde::Serialize;

use crate::{GlobalMap, MapError, Truth, delaunay_edges};
use edges::EdgeDifference;
use neighbours::NearestNeighbours;
use orientation::{Orientations, Tally};
use residual::Residual;

/// Settings of an evaluation.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct EvaluateParams {
    /// Components up to this many shared landmarks have all their triples counted, `O(n^3)`; larger
    /// ones are sampled. Default 1000: 1.7 * 10^8 triples, well under a second.
    pub exact_up_to: usize,
    /// Triples drawn from components above that size, shared out by their number of triples, at least
    /// 10 000 each. Default 2 000 000: a standard error of at most 0.0004.
    pub samples: u64,
    /// Seed of the draw. Default 0.
    pub seed: u64,
}

impl Default for EvaluateParams {
    fn default() -> Self {
        Self { exact_up_to: 1000, samples: 2_000_000, seed: 0 }
    }
}

/// What [`against`] found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Evaluation {
    /// Landmarks compared.
    pub n: usize,
    /// Components compared.
    pub components: usize,
    /// Shared landmarks in components that have fewer than three of them; left out.
    pub isolated: usize,
    /// Landmarks of the truth that the map lacks.
    pub missing: usize,
    /// Landmarks of the map that the truth lacks.
    pub unknown: usize,
    /// Eq. (7), in `[0, 2]`.
    pub delaunay_error: f64,
    /// Eq. (8), in `[0, 1]`, after each component took the better of its two mirror images. Triples
    /// that are collinear in truth have no orientation and do not count; triples that are
    /// collinear in the map alone are wrong. `None`: no triple counts.
    pub orientation_error: Option<f64>,
    /// Standard error of `orientation_error`; `None`: all triples were counted.
    pub orientation_standard_error: Option<f64>,
    /// The same over near triples alone: each landmark with the pairs of its 10 nearest true
    /// neighbours, in the mirror image chosen above.
    pub local_orientation_error: Option<f64>,
    /// Root mean square residual after the best similarity fit of each component, mirror image
    /// allowed, in the unit of the truth.
    pub rmse: f64,
    /// `rmse` over the root mean square distance of the landmarks from their component's centroid,
    /// in `[0, 1]`; `None`: the true positions coincide.
    pub relative_rmse: Option<f64>,
    /// Mean recall of the `min(10, n - 1)` nearest true neighbours inside the component. A landmark
    /// as near as the last of them counts as one of them.
    pub knn10: f64,
}

/// Compares a map with surveyed positions.
///
/// # Errors
/// [`MapError::NoCommonLandmarks`] when no ID stands in both, [`MapError::TooFewCommon`] when no
/// component holds three of those that do, [`MapError::Embed`] for coordinates above 1e100.
///
/// # Complexity
/// `O(n log n)`, and `O(n^3)` for components of up to `params.exact_up_to` landmarks.
pub fn against(map: &GlobalMap, truth: &Truth, params: &EvaluateParams) -> Result<Evaluation, MapError> {
    let Matching { charts, missing, unknown, isolated } = Matching::of(map, truth)?;
    let n = charts.iter().map(Chart::len).sum();
    let mut edges = EdgeDifference::default();
    let mut recall = 0.0;
    let orientations = Orientations::of(&charts, params);
    let mut local = Tally::default();
    for (chart, mirrored) in charts.iter().zip(orientations.mirrored()) {
        let [map_edges, true_edges] = [delaunay_edges(&chart.map)?, delaunay_edges(&chart.truth)?];
        edges.add(&map_edges, &true_edges, chart.len());
        let near = NearestNeighbours::of(&chart.truth, &true_edges);
        recall += near.recall(&chart.truth, &NearestNeighbours::of(&chart.map, &map_edges));
        local += orientation::near(chart, &near, mirrored);
    }
    let residual = Residual::of(&charts)?;
    Ok(Evaluation {
        n,
        components: charts.len(),
        isolated,
        missing,
        unknown,
        delaunay_error: edges.error(),
        orientation_error: orientations.error(),
        orientation_standard_error: orientations.standard_error(),
        local_orientation_error: local.error(),
        rmse: residual.rmse(),
        relative_rmse: residual.relative(),
        knn10: recall / n as f64,
    })
}

#[cfg(test)]
mod tests;
