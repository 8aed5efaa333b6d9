//! What a log allows: the map that the same minimisation reaches from the truth.
//!
//! A map that is no worse than that has no problem of optimisation or stitching; what is left is the distance
//! function, the model of the sensor, and the log. A map that is worse has.

use covimap_embed::Point;
use rustc_hash::{FxHashMap, FxHashSet};
use serde::Serialize;

use super::bound::{Bound, BoundSum};
use super::neighbours::NearestNeighbours;
use super::{Chart, EvaluateParams, Evaluation, Matching, against, truth_from_map};
use crate::{GlobalMap, MapError, Mapper, Method, Observer, SightingLog, Truth, delaunay_edges};

/// A map beside the one that the same minimisation reaches from the truth.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Limit {
    /// Errors of the map.
    pub map: Evaluation,
    /// Errors of what is reached from the truth.
    pub from_truth: Evaluation,
    /// Stress-1 of the map; `None` for one by the classical method, whose stress is over other distances.
    pub map_stress1: Option<f64>,
    /// Stress-1 of what is reached from the truth.
    pub stress1: f64,
    /// The map's figures over those from the truth.
    pub ratio: Ratios,
    /// What known places of observation would allow; `None` if the log is too small to learn the sensor.
    pub bound: Option<Bound>,
}

/// Figures of a map over those of another; 1 is equal, above 1 is worse. `None` where one of the two is not
/// known or the second is 0.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Ratios {
    /// Of stress-1.
    pub stress1: Option<f64>,
    /// Of the Delaunay errors.
    pub delaunay_error: Option<f64>,
    /// Of the orientation errors.
    pub orientation_error: Option<f64>,
    /// Of the orientation errors of near triples.
    pub local_orientation_error: Option<f64>,
    /// Of the root mean square residuals.
    pub rmse: Option<f64>,
}

/// Starts the minimisation of the map's settings from the truth, and compares.
///
/// Polish and refinement are those of `auto`, also for a map by the classical method, which starts from nowhere.
/// Landmarks without a surveyed position start where the map has them, after the best fit of their component.
///
/// # Errors
/// [`MapError::OtherLog`] for a log of other landmarks; as [`against`] and [`Mapper::build`].
pub fn limit(
    map: &GlobalMap,
    truth: &Truth,
    log: &SightingLog,
    params: &EvaluateParams,
    observer: &dyn Observer,
) -> Result<Limit, MapError> {
    let found = against(map, truth, params)?;
    let start = start(map, truth, log)?;
    let best = Mapper::new(map.params().clone())?.build_from(log, &start, observer)?;
    let from_truth = against(&best, truth, params)?;
    let map_stress1 = (map.params().method == Method::Auto).then_some(map.report().stress1);
    let stress1 = best.report().stress1;
    let ratio = |ours: Option<f64>, theirs: Option<f64>| Some(ours? / theirs.filter(|&value| value > 0.0)?);
    Ok(Limit {
        ratio: Ratios {
            stress1: ratio(map_stress1, Some(stress1)),
            delaunay_error: ratio(Some(found.delaunay_error), Some(from_truth.delaunay_error)),
            orientation_error: ratio(found.orientation_error, from_truth.orientation_error),
            local_orientation_error: ratio(found.local_orientation_error, from_truth.local_orientation_error),
            rmse: ratio(Some(found.rmse), Some(from_truth.rmse)),
        },
        map: found,
        from_truth,
        map_stress1,
        stress1,
        bound: bound(&best, truth)?,
    })
}

/// The truth, by the log's numbers; where it is silent, the map carried onto it.
fn start(map: &GlobalMap, truth: &Truth, log: &SightingLog) -> Result<Vec<Point>, MapError> {
    let mut points: Vec<Point> = map.landmarks().iter().map(|placed| placed.position).collect();
    for chart in Matching::of(map, truth)?.charts {
        if let Some(fit) = truth_from_map(&chart)? {
            let own =
                map.landmarks().iter().zip(&mut points).filter(|own| own.0.component == chart.component);
            own.for_each(|(placed, point)| *point = fit.apply(placed.position));
        }
        for (landmark, &surveyed) in chart.landmarks.iter().zip(&chart.truth) {
            points[landmark.index()] = surveyed;
        }
    }
    let known: FxHashMap<&str, Point> = map.names().iter().zip(points).collect();
    let other = |id: &str| MapError::OtherLog { id: id.to_owned(), map: map.len(), log: log.names().len() };
    let in_log: FxHashSet<&str> = log.names().iter().collect();
    if let Some(id) = map.names().iter().find(|id| !in_log.contains(id)) {
        return Err(other(id));
    }
    log.names().iter().map(|id| known.get(id).copied().ok_or_else(|| other(id))).collect()
}

/// The bound by the sensor that the map from the truth implies.
fn bound(map: &GlobalMap, truth: &Truth) -> Result<Option<Bound>, MapError> {
    let Some(sensing) = map.sensing() else { return Ok(None) };
    let mut sum = BoundSum::default();
    for chart in Matching::of(map, truth)?.charts {
        let Some(fit) = truth_from_map(&chart)? else { return Ok(None) };
        let sensor = sensing.sensor(chart.component);
        let landmarks = chart
            .landmarks
            .iter()
            .map(|&id| (sensing.of(id).detectability, map.landmarks()[id.index()].sightings));
        sum.add(fit.scale * sensor.range, fit.scale * sensor.edge, nearest(&chart)?, landmarks);
    }
    Ok(sum.bound())
}

/// Mean distance from a landmark to the nearest other one.
fn nearest(chart: &Chart) -> Result<f64, MapError> {
    let near = NearestNeighbours::of(&chart.truth, &delaunay_edges(&chart.truth)?);
    let distance = |i: usize| {
        let (here, there) = (chart.truth[i], chart.truth[near.row(i)[0] as usize]);
        (here[0] - there[0]).hypot(here[1] - there[1])
    };
    Ok((0..chart.len()).map(distance).sum::<f64>() / chart.len() as f64)
}

#[cfg(test)]
mod tests;
