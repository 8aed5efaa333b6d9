//! Residuals after the best similarity fit.

use covimap_embed::{Correspondence, EmbedError, Point, ProcrustesOptions, Similarity, procrustes};

use super::Chart;
use crate::MapError;

/// Sums of squares over charts, each aligned by itself.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Residual {
    landmarks: usize,
    /// Squared distances between aligned map and truth.
    residual: f64,
    /// Squared distances between truth and its centroid.
    spread: f64,
}

impl Residual {
    pub fn of(charts: &[Chart]) -> Result<Self, MapError> {
        let mut sum = Self::default();
        for chart in charts {
            let truth_from_map = truth_from_map(chart)?;
            let centre = centroid(&chart.truth);
            sum.landmarks += chart.len();
            for (&map, &truth) in chart.map.iter().zip(&chart.truth) {
                // Where nothing turns the map onto the truth, the best fit has scale 0.
                let aligned = truth_from_map.map_or(centre, |fit| fit.apply(map));
                sum.residual += squared(aligned, truth);
                sum.spread += squared(centre, truth);
            }
        }
        Ok(sum)
    }

    /// Root mean square residual.
    pub fn rmse(self) -> f64 {
        (self.residual / self.landmarks as f64).sqrt()
    }

    /// The same over the root mean square spread; `None`: there is no spread.
    pub fn relative(self) -> Option<f64> {
        (self.spread > 0.0).then(|| (self.residual / self.spread).sqrt())
    }
}

/// The similarity, mirror image allowed, that brings the map nearest to the truth; `None` when no
/// rotation is better than any other, as for a map in one place.
pub(crate) fn truth_from_map(chart: &Chart) -> Result<Option<Similarity>, MapError> {
    let pair = |(&source, &target)| Correspondence { source, target, weight: 1.0 };
    let pairs: Vec<_> = chart.map.iter().zip(&chart.truth).map(pair).collect();
    match procrustes(&pairs, ProcrustesOptions::default()) {
        Ok(fit) => Ok(Some(fit.target_from_source)),
        Err(EmbedError::CoincidingPoints { .. } | EmbedError::UndeterminedRotation { .. }) => Ok(None),
        Err(error) => Err(error.into()),
    }
}

fn centroid(points: &[Point]) -> Point {
    [0, 1].map(|axis| points.iter().map(|point| point[axis]).sum::<f64>() / points.len() as f64)
}

fn squared(a: Point, b: Point) -> f64 {
    (a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2)
}
