//! Residuals after the best similarity fit.

use covimap_embed::{Point, Similarity};

use super::Chart;

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
    pub fn of(charts: &[Chart]) -> Self {
        let mut sum = Self::default();
        for chart in charts {
            let truth_from_map = truth_from_map(chart);
            let centre = centroid(&chart.truth);
            sum.landmarks += chart.len();
            for (&map, &truth) in chart.map.iter().zip(&chart.truth) {
                sum.residual += squared(truth_from_map.apply(map), truth);
                sum.spread += squared(centre, truth);
            }
        }
        sum
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

/// The similarity, mirror image allowed, that brings the map nearest to the truth.
pub(crate) fn truth_from_map(chart: &Chart) -> Similarity {
    let (from, to) = (centroid(&chart.map), centroid(&chart.truth));
    let (mut plain, mut mirrored, mut size) = ([0.0; 2], [0.0; 2], 0.0);
    for (m, t) in chart.map.iter().zip(&chart.truth) {
        let (m, t) = ([m[0] - from[0], m[1] - from[1]], [t[0] - to[0], t[1] - to[1]]);
        plain[0] += m[0] * t[0] + m[1] * t[1];
        plain[1] += m[0] * t[1] - m[1] * t[0];
        mirrored[0] += m[0] * t[0] - m[1] * t[1];
        mirrored[1] += m[0] * t[1] + m[1] * t[0];
        size += m[0] * m[0] + m[1] * m[1];
    }
    let length = |v: [f64; 2]| v[0].hypot(v[1]);
    let mirror = length(mirrored) > length(plain);
    let best = if mirror { mirrored } else { plain };
    if length(best) == 0.0 {
        return Similarity { scale: 0.0, shift: to, ..Similarity::IDENTITY };
    }
    let turn = Similarity {
        cos: best[0] / length(best),
        sin: best[1] / length(best),
        mirrored: mirror,
        scale: length(best) / size,
        shift: [0.0; 2],
    };
    let moved = turn.apply(from);
    Similarity { shift: [to[0] - moved[0], to[1] - moved[1]], ..turn }
}

fn centroid(points: &[Point]) -> Point {
    [0, 1].map(|axis| points.iter().map(|point| point[axis]).sum::<f64>() / points.len() as f64)
}

fn squared(a: Point, b: Point) -> f64 {
    (a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2)
}
