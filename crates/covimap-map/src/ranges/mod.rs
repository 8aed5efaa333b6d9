//! Ranges: where the log tells how far landmarks were, the map becomes metric, and more exact.
//!
//! A range `r` of landmark i in step t is `s |x_i - y_t|` but for noise, with a scale `s` of the whole component,
//! metres a map unit, and the place `y_t` of the step. Both are unknown, and so are the errors of the landmarks; the
//! start is the map that the sightings made, and the mean of what the step shows. Then, in turn,
//!
//! - every place moves to where the ranges of its step fit best (Gauss and Newton);
//! - on the map as it is, the scale becomes `sum w r d / sum w d^2`, `d = |x_i - y_t|`;  (1)
//! - after that all landmarks move at once to where the ranges fit best, neighbours being held at their distance
//!   by the map: see `reduced`;
//! - the variance of a range, `v = a + b d^2`, is fitted to what the ranges miss.
//!
//! A range that misses by `e` has the weight `w = (c^2 / (c^2 + e^2 / v))^2 / v` (Geman and McClure), `c` being 3: one
//! that is far off has no say. A step takes part if it has ranges to three landmarks or more.
//! `docs/maths/ranges.md` has reasons and figures.
//!
//! # Complexity
//! `O(m)` a product with the matrix for `m` ranges, at most 60 of them a round; some 40 bytes a range.

mod noise;
mod normal;
mod readings;
mod reduced;
mod sweep;

use covimap_embed::Point;
use serde::{Deserialize, Serialize};

use crate::component::put_in_frame;
use crate::{ChartFit, GlobalMap, MapError, PlacedLandmark, Range, SightingLog, delaunay_edges};
use readings::Readings;
use reduced::{fit_noise, move_landmarks};
use sweep::Sweep;

/// Rounds of places, scale and noise on the map as it is.
const FIRST_ROUNDS: usize = 5;
/// Rounds of places, landmarks and noise.
const ROUNDS: usize = 8;
/// Ranges of a step that takes part, at least: two fix its place, the third tells something.
const FEWEST: usize = 3;
/// Misses of more than this many standard deviations are outliers.
const OUTLIER: f64 = 4.0;

/// What the ranges of a component came to.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RangeReport {
    /// Ranges that took part.
    pub ranges: u64,
    /// Steps that they belong to.
    pub steps: u64,
    /// Metres a map unit.
    pub scale: f64,
    /// Standard error of the scale, metres a map unit.
    pub scale_error: f64,
    /// Standard deviation of the ranges about the map, metres, outliers left out.
    pub deviation: f64,
    /// Ranges that miss by more than four of these deviations.
    pub outliers: u64,
}

/// Fits the points of every component to its ranges; `None` for components that have too few.
///
/// `components` lists the landmarks of each, ascending, and `charts` their points.
pub(crate) fn fit(
    log: &SightingLog,
    components: &[Vec<u32>],
    charts: &mut [&mut Vec<Point>],
) -> Vec<Option<RangeReport>> {
    let mut place = vec![(0, 0); log.names().len()];
    for (component, members) in components.iter().enumerate() {
        members.iter().enumerate().for_each(|(k, &member)| place[member as usize] = (component, k as u32));
    }
    let mut steps: Vec<Vec<Vec<(u32, f64)>>> = vec![Vec::new(); components.len()];
    for ranges in log.ranges().chunk_by(|a, b| a.step == b.step) {
        let mut left: Vec<&Range> = ranges.iter().collect();
        while let Some(first) = left.first() {
            let component = place[first.landmark as usize].0;
            let (own, others): (Vec<&Range>, _) =
                left.iter().partition(|range| place[range.landmark as usize].0 == component);
            if own.len() >= FEWEST {
                let reading = |range: &&Range| (place[range.landmark as usize].1, range.metres);
                steps[component].push(own.iter().map(reading).collect());
            }
            left = others;
        }
    }
    steps.into_iter().zip(charts).map(|(steps, points)| fit_component(&steps, points)).collect()
}

/// The map with every component that has ranges in metres.
///
/// # Errors
/// Those of [`GlobalMap::with_positions`].
pub(crate) fn in_metres(map: GlobalMap) -> Result<GlobalMap, MapError> {
    let reports = || (0..).zip(&map.report().components);
    let fit = |(component, report): (u32, &crate::ComponentReport)| {
        let ranges = report.ranges.as_ref()?;
        let (scale, rmse) = (ranges.scale, ranges.deviation);
        Some(ChartFit { component, scale, anchors: 0, distances: ranges.ranges, rmse, handed: false })
    };
    let fits: Vec<ChartFit> = reports().filter_map(fit).collect();
    if fits.is_empty() {
        return Ok(map);
    }
    let scale =
        |component: u32| fits.iter().find(|fit| fit.component == component).map_or(1.0, |fit| fit.scale);
    let metres = |placed: &PlacedLandmark| placed.position.map(|c| scale(placed.component) * c);
    let positions: Vec<Point> = map.landmarks().iter().map(metres).collect();
    map.with_positions(&positions, fits)
}

/// `None`, and the points as they were, if no step takes part or all landmarks of the steps are in one place.
fn fit_component(steps: &[Vec<(u32, f64)>], points: &mut Vec<Point>) -> Option<RangeReport> {
    let readings = Readings::new(steps, points.len());
    let edges = delaunay_edges(points).expect("positions of a map are finite (bug in covimap)");
    let mut sweep = Sweep::start(&readings, points, &edges)?;
    for _ in 0..FIRST_ROUNDS {
        sweep.place_steps();
        sweep.fit_scale();
        fit_noise(&mut sweep);
    }
    for _ in 0..ROUNDS {
        sweep.place_across();
        move_landmarks(&mut sweep);
        sweep.place_steps();
        fit_noise(&mut sweep);
    }
    let misses: Vec<(f64, f64)> = (0..readings.all().len())
        .map(|place| (sweep.look(place).1, place))
        .map(|(miss, place)| (miss, sweep.variance(place, miss)))
        .collect();
    let outliers =
        misses.iter().filter(|(miss, variance)| miss * miss > OUTLIER * OUTLIER * variance).count();
    let report = RangeReport {
        ranges: misses.len() as u64,
        steps: steps.len() as u64,
        scale: sweep.scale,
        scale_error: sweep.scale_error(),
        deviation: (misses.iter().map(|miss| miss.1).sum::<f64>() / misses.len() as f64).sqrt(),
        outliers: outliers as u64,
    };
    *points = sweep.points.iter().map(|point| point.map(|c| c / sweep.scale)).collect();
    put_in_frame(points, &mut []);
    Some(report)
}

#[cfg(test)]
mod tests;
