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
//! - the variance of a range, `v = a + b d^2`, is fitted to what the ranges miss, and the error of the map to what its
//!   neighbours miss.
//!
//! A range that misses by `e` has the weight `w = (c^2 / (c^2 + e^2 / v))^2 / v` (Geman and McClure): one that is far off has no
//! say. `c` comes down to 3 from 192, so that ranges are not dropped for errors of the map that they are about to mend. A step takes part if it has ranges to three landmarks or more.
//! `docs/maths/ranges.md` has reasons and figures.
//!
//! # Complexity
//! `sum k^2` a round over the steps with `k` ranges, and a sparse factorisation of order `2 n`; some 60 bytes a range, and 32 for
//! any two landmarks of which a step has ranges, and what the factor fills.

mod noise;
mod normal;
mod readings;
mod reduced;
mod sweep;

use covimap_embed::Point;
use serde::{Deserialize, Serialize};

use crate::component::put_in_frame;
use crate::progress::begin;
use crate::{
    ChartFit, CoVisibility, GlobalMap, LandmarkId, MapError, Observer, PlacedLandmark, Range, SightingLog,
    Stage, delaunay_edges,
};
use readings::Readings;
use reduced::{Equations, Solved, fit_held, fit_noise};
use sweep::{FAR, Sweep};

/// Rounds of places, scale and noise on the map as it is.
const FIRST_ROUNDS: usize = 5;
/// Rounds of places, landmarks and noise.
const ROUNDS: i32 = 10;
/// By this factor more may be missed in the first of them before a range loses its say; a quarter of it in the next, and so on.
const WIDEST: f64 = 64.0;
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
    counts: &CoVisibility,
    components: &[Vec<u32>],
    charts: &mut [&mut Vec<Point>],
    observer: &dyn Observer,
) -> Result<Vec<Option<RangeReport>>, MapError> {
    if log.ranges().is_empty() {
        return Ok(vec![None; components.len()]);
    }
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
    let taking_part = steps.iter().filter(|steps| !steps.is_empty()).count();
    begin(Stage::Ranges, Some((taking_part * (FIRST_ROUNDS + ROUNDS as usize)) as u64), observer)?;
    let mut reports = Vec::with_capacity(components.len());
    for ((members, steps), points) in components.iter().zip(steps).zip(charts) {
        let id = |landmark: u32| LandmarkId(members[landmark as usize]);
        let seen = |a, b| counts.together(id(a), id(b)) > 0;
        reports.push(fit_component(&steps, points, seen, observer)?);
    }
    observer.finished(Stage::Ranges);
    Ok(reports)
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

/// `None`, and the points as they were, if no step takes part or all landmarks of the steps are in one place. `seen` tells
/// whether two landmarks were ever seen together.
fn fit_component(
    steps: &[Vec<(u32, f64)>],
    points: &mut Vec<Point>,
    seen: impl Fn(u32, u32) -> bool,
    observer: &dyn Observer,
) -> Result<Option<RangeReport>, MapError> {
    let goes_on = || {
        observer.advanced(1);
        if observer.interrupted() { Err(MapError::Interrupted) } else { Ok(()) }
    };
    let readings = Readings::new(steps, points.len());
    let edges = delaunay_edges(points).expect("positions of a map are finite (bug in covimap)");
    let Some(mut sweep) = Sweep::start(&readings, points, &edges, seen) else { return Ok(None) };
    for _ in 0..FIRST_ROUNDS {
        sweep.place_steps();
        sweep.fit_scale();
        fit_noise(&mut sweep);
        goes_on()?;
    }
    let mut equations = Equations::new(&readings, &sweep.edges, points.len());
    for round in 0..ROUNDS {
        sweep.far = FAR * (WIDEST * 0.25_f64.powi(round)).max(1.0);
        sweep.place_across();
        sweep.weigh_edges();
        let Solved { moves, freedom } = equations.solve(&sweep)?;
        sweep.move_landmarks(&moves);
        sweep.place_steps();
        fit_noise(&mut sweep);
        fit_held(&mut sweep, &freedom);
        goes_on()?;
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
    Ok(Some(report))
}

#[cfg(test)]
mod tests;
