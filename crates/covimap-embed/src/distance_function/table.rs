//! Curves that are given by values: the families spline and isotonic.

use serde::{Deserialize, Serialize};

use super::DistanceFunction;

/// A rise of `-ln f` that is none.
const FLAT: f64 = 1e-6;

/// A falling curve through knots, `-ln f` straight in between.
///
/// Below the first knot it runs to `f = 1` at distance 0, beyond the last one it goes on with the mean
/// slope of its farther half.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Tabulated {
    /// Distances of the knots, ascending.
    distances: Vec<f64>,
    /// `-ln f` there, ascending.
    minus_log: Vec<f64>,
}

impl Tabulated {
    /// The curve through points `(d, -ln f)` of which both ascend; the middle of those on one
    /// level stands for all. `None` if fewer than two are left.
    pub(super) fn through(points: &[(f64, f64)]) -> Option<Self> {
        let (mut distances, mut minus_log) = (Vec::new(), Vec::new());
        for level in points.chunk_by(|a, b| b.1 - a.1 < FLAT) {
            let distance = level.iter().map(|point| point.0).sum::<f64>() / level.len() as f64;
            if distance > 0.0 && level[0].1 > 0.0 && distances.last().is_none_or(|&last| last < distance) {
                distances.push(distance);
                minus_log.push(level[0].1);
            }
        }
        (distances.len() >= 2).then_some(Self { distances, minus_log })
    }

    pub(super) fn scaled(mut self, factor: f64) -> Self {
        for distance in &mut self.distances {
            *distance *= factor;
        }
        self
    }
}

impl DistanceFunction for Tabulated {
    fn frequency(&self, distance: f64) -> f64 {
        (-follow(&self.distances, &self.minus_log, distance)).exp()
    }

    fn distance(&self, frequency: f64) -> f64 {
        follow(&self.minus_log, &self.distances, -frequency.ln()).max(0.0)
    }
}

/// The broken line through the origin and the points `(x, y)`, all ascending, at a place `>= 0`.
fn follow(x: &[f64], y: &[f64], at: f64) -> f64 {
    let last = x.len() - 1;
    let next = x.partition_point(|&x| x < at);
    let (from, to) = match next {
        0 => return y[0] * at / x[0],
        next if next > last => (last / 2, last),
        next => (next - 1, next),
    };
    let slope = (y[to] - y[from]) / (x[to] - x[from]);
    y[to] + slope * (at - x[to])
}
