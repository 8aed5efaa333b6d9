//! The stop rule: how good the map is by its own account, and what it would take to be as good as is wanted.
//!
//! The measure is the share of triangles of near landmarks that turn the wrong way. The map tells the probability
//! `1 - P` of that for each (see `docs/maths/planning.md`); the mean over all triangles is the error `e` to be expected.
//! Turns are wrong where the triangle is flatter than positions are certain, so that `e` goes with the standard
//! deviations, and these fall with the root of the steps:
//!
//! `e(T') = e(T) sqrt(T / T')`  (2)
//!
//! Exploration may stop when `e` is at most what is wanted and no part of the map hangs on a hinge.

use covimap_map::LandmarkId;
use rayon::prelude::*;
use serde::Serialize;

use super::ExploreParams;
use crate::{MapIndex, PlanError};

/// Near are a landmark and so many landmarks nearest to it.
const NEAREST: usize = 7;

/// Whether to go on.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Forecast {
    /// Share of the triangles of near landmarks that are expected to turn the wrong way, in `[0, 0.5]`.
    pub error: f64,
    /// What is wanted of that.
    pub wanted: f64,
    /// Steps of the log.
    pub steps: u64,
    /// Steps of the same kind that are expected to be missing, by eq. (2).
    pub more_steps: u64,
    /// Hinges that the side of some part of the map hangs on.
    pub hinges: usize,
    /// Whether it is good enough: the error is what is wanted or less, and there is no hinge.
    pub stop: bool,
}

/// Judges the map by its own account. A map without three landmarks in a component counts as wrong in every second triangle.
/// `O(n log n)` after the covariances are known.
///
/// # Errors
/// [`PlanError::BadParameter`].
pub fn forecast(index: &MapIndex, params: ExploreParams) -> Result<Forecast, PlanError> {
    params.check()?;
    let report = index.map().report();
    let error = near_error(index)?;
    let hinges = report.components.iter().map(|component| component.seams.hinges.len()).sum();
    let factor = (error / params.error).powi(2) - 1.0;
    Ok(Forecast {
        error,
        wanted: params.error,
        steps: report.steps,
        more_steps: (report.steps as f64 * factor.max(0.0)).ceil() as u64,
        hinges,
        stop: error <= params.error && hinges == 0,
    })
}

/// The mean of `1 - P` over the triangles of every landmark with two of those nearest to it.
fn near_error(index: &MapIndex) -> Result<f64, PlanError> {
    // Once, before all threads ask for it.
    index.confidence();
    let of_one = |id: u32| {
        let id = LandmarkId(id);
        let near: Vec<LandmarkId> =
            index.nearest(id, NEAREST)?.into_iter().map(|near| near.landmark).collect();
        let (mut sum, mut count) = (0.0, 0);
        for (k, &a) in near.iter().enumerate() {
            for &b in &near[..k] {
                sum += 1.0 - index.orientation(id, a, b)?.probability;
                count += 1;
            }
        }
        Ok((sum, count))
    };
    let all = (0..index.map().len() as u32).into_par_iter().map(of_one);
    let all = all.collect::<Result<Vec<(f64, u32)>, PlanError>>()?;
    let count: u32 = all.iter().map(|one| one.1).sum();
    Ok(if count == 0 { 0.5 } else { all.iter().map(|one| one.0).sum::<f64>() / f64::from(count) })
}
