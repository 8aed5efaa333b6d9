//! How well positions are known, from the evidence that the map carries.
//!
//! A line of sight between landmarks i and j says how far they are apart: `d = sqrt(-alpha ln f)` of the
//! co-visibility frequency `f = n_ij / (n_i + n_j - n_ij)`. The count is a draw of chance, so that `ln f`
//! has the variance `(1 - f) / n_ij`, and the distance
//!
//! ```text
//! v_ij = u^2 (alpha / 2 d)^2 (1 - f) / n_ij,
//! ```
//!
//! `u` being the length of a map unit of the build in units of the map: the median of length over `d` over the lines of sight
//! of the component. Neighbours in the directions `e_ij` hold a landmark as springs of stiffness `1 / v_ij` do:
//!
//! ```text
//! C_i = F (I / (u R / 2)^2 + sum_j e_ij e_ij' / v_ij)^-1.
//! ```
//!
//! The first term is what is known of a landmark that no neighbour holds: it is somewhere within the
//! range R of the sensor of the place that saw it. `F` makes up for what the model leaves out, and
//! is measured: see `docs/maths/planning.md`.
//!
//! The covariance is that of a landmark against its surroundings, which is what relations between near
//! landmarks and a robot among them need. A map as a whole bends: against landmarks at a distance L the
//! variances count `1 + L / 4 u` times, a random walk away from them.

use covimap_embed::Point;
use covimap_map::{GlobalMap, LandmarkId, SightLine};
use rayon::prelude::*;

use crate::charts::Chart;

/// The paper's `alpha_2`, which sets the map unit.
const ALPHA: f64 = 0.3;

/// Range of a sensor in map units: the disc on which the unit rests, see `docs/conventions.md`.
const RANGE: f64 = 1.0 / 1.7;

/// The variances measured on simulated worlds, over those of the model.
const INFLATION: f64 = 2.0;

/// Over this length, in map units, a map bends by as much as its landmarks are uncertain: measured too.
const BENDING_LENGTH: f64 = 4.0;

/// Covariance of a position, in squared units of the map. Positive definite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Covariance {
    /// Variance of x.
    pub xx: f64,
    /// Covariance of x and y.
    pub xy: f64,
    /// Variance of y.
    pub yy: f64,
}

impl Covariance {
    /// Root mean square over all directions of the standard deviation, in units of the map.
    #[must_use]
    pub fn deviation(&self) -> f64 {
        (0.5 * (self.xx + self.yy)).sqrt()
    }

    /// `g' C g`: the variance of a quantity whose gradient over the position is `g`.
    #[must_use]
    pub fn along(&self, g: Point) -> f64 {
        g[0] * g[0] * self.xx + 2.0 * g[0] * g[1] * self.xy + g[1] * g[1] * self.yy
    }

    /// Standard deviations along the principal axes, the greater first, and the direction of the first, in radians
    /// from the x axis, in `(-pi/2, pi/2]`.
    #[must_use]
    pub fn axes(&self) -> (f64, f64, f64) {
        let (mean, half) = (0.5 * (self.xx + self.yy), 0.5 * (self.xx - self.yy));
        let radius = half.hypot(self.xy);
        // A negative zero would turn the axis by half a turn.
        ((mean + radius).sqrt(), (mean - radius).max(0.0).sqrt(), 0.5 * (self.xy + 0.0).atan2(half))
    }
}

/// The co-visibility frequency of the ends of a line of sight, drawn a little from 0 and 1 so that it lies
/// strictly between them: `(n_ij + 1/2) / (n_i + n_j - n_ij + 1)`.
pub(crate) fn frequency(map: &GlobalMap, from: LandmarkId, line: &SightLine) -> f64 {
    let [n, m] = [from, line.to].map(|id| f64::from(map.landmarks()[id.index()].sightings));
    let both = f64::from(line.steps);
    (both + 0.5) / (n + m - both + 1.0)
}

/// How well all positions of a map are known.
#[derive(Debug, Clone)]
pub(crate) struct Confidence {
    /// Of every landmark, relative to its surroundings.
    pub covariances: Vec<Covariance>,
    /// Length of a map unit, by place of the chart.
    units: Vec<f64>,
}

impl Confidence {
    /// `O(n + m)` for `m` lines of sight.
    pub fn new(map: &GlobalMap, charts: &[Chart]) -> Self {
        let units: Vec<f64> = charts.iter().map(|chart| unit(map, chart)).collect();
        let mut covariances = vec![Covariance { xx: 0.0, xy: 0.0, yy: 0.0 }; map.len()];
        for (chart, &unit) in charts.iter().zip(&units) {
            let found: Vec<Covariance> =
                chart.members.par_iter().map(|&id| covariance(map, id, unit)).collect();
            for (id, covariance) in chart.members.iter().zip(found) {
                covariances[id.index()] = covariance;
            }
        }
        Self { covariances, units }
    }

    /// By how much variances grow between landmarks this far apart, in the chart at this place of the list.
    pub fn growth(&self, chart: usize, apart: f64) -> f64 {
        1.0 + apart / (BENDING_LENGTH * self.units[chart])
    }
}

/// Length of a map unit of the build, in units of the map: 1 without lines of sight.
fn unit(map: &GlobalMap, chart: &Chart) -> f64 {
    let mut ratios: Vec<f64> = chart
        .members
        .par_iter()
        .flat_map_iter(|&from| {
            let later = map.sight_lines().of(from).iter().filter(move |line| line.to > from);
            later.map(move |line| length(map, from, line.to) / distance(frequency(map, from, line)))
        })
        .filter(|&ratio| ratio > 0.0)
        .collect();
    let middle = ratios.len() / 2;
    if ratios.is_empty() { 1.0 } else { *ratios.select_nth_unstable_by(middle, f64::total_cmp).1 }
}

fn covariance(map: &GlobalMap, id: LandmarkId, unit: f64) -> Covariance {
    let lone = (0.5 * RANGE * unit).powi(-2);
    let (mut xx, mut xy, mut yy) = (lone, 0.0, lone);
    for line in map.sight_lines().of(id) {
        let apart = length(map, id, line.to);
        if apart > 0.0 {
            let f = frequency(map, id, line);
            let variance = (unit * 0.5 * ALPHA / distance(f)).powi(2) * (1.0 - f) / f64::from(line.steps);
            let [dx, dy] = toward(map, id, line.to).map(|d| d / apart);
            (xx, xy, yy) = (xx + dx * dx / variance, xy + dx * dy / variance, yy + dy * dy / variance);
        }
    }
    let scale = INFLATION / (xx * yy - xy * xy);
    Covariance { xx: yy * scale, xy: -xy * scale, yy: xx * scale }
}

/// Eq. (10) of the paper without its clamps, in map units.
fn distance(f: f64) -> f64 {
    (-ALPHA * f.ln()).sqrt()
}

fn toward(map: &GlobalMap, from: LandmarkId, to: LandmarkId) -> Point {
    let [a, b] = [from, to].map(|id| map.landmarks()[id.index()].position);
    [b[0] - a[0], b[1] - a[1]]
}

/// How far two landmarks of a component are apart, in units of the map.
pub(crate) fn length(map: &GlobalMap, from: LandmarkId, to: LandmarkId) -> f64 {
    let [dx, dy] = toward(map, from, to);
    // Half the time of a search is spent here, and `hypot` takes three times as long.
    (dx * dx + dy * dy).sqrt()
}

#[cfg(test)]
mod tests;
