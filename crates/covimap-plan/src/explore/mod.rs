//! Exploration: where to go next so that the map gains most, and when to stop.
//!
//! - [`next_best`] ranks places of a finished map: where more looks would gain most, and why.
//! - [`forecast`] tells how good the map is by its own account, and how many steps would make it as good as is
//!   wanted: the stop rule.
//! - [`Explorer`] steers a robot from look to look to where there is something new to see; it needs no map.
//!
//! # What a visit gains
//! A position of variance `s_k^2` that rests on `n_k` sightings has the variance `s_k^2 n_k / (n_k + m_k)` after `m_k`
//! more. A visit to landmark j makes `u` looks from about its place, which show landmark k in
//! `m_k = u p_k v(|x_j - x_k|)` of them, by the sensor model of the map. All together it takes away
//!
//! `G_j = sum_k s_k^2 m_k / (n_k + m_k)`  (1)
//!
//! of the sum of the variances. A way of length d costs looks as well: those of a visit are made while the robot
//! crosses the disc from which j is seen, a way of `2 R`, so that a goal at the distance d is worth
//! `G_j / (1 + d / 2 R)`. Hinges come first, the greatest `landmarks / (1 + exp(evidence))` before others: there the side
//! of a whole part of the map is open.
//!
//! # References
//! T. Yairi, K. Hori, K. Hirama, *Qualitative map learning based on co-visibility of objects*, section VII: places
//! whose landmarks have been observed least come first, and enough is enough when the distances do not change any more.

mod explorer;
mod forecast;

use covimap_map::{Hinge, LandmarkId, Sensing};
use rayon::prelude::*;
use serde::Serialize;

use crate::explain::typical_deviation;
use crate::{Location, MapIndex, PlanError};
pub use explorer::Explorer;
pub use forecast::{Forecast, forecast};

/// A landmark this many times less certain than the median of its component is uncertain.
const UNCERTAIN: f64 = 1.5;
/// A landmark seen less often than this share of the median of its component was seen in few steps.
const FEW: f64 = 0.5;

/// What a visit is, and when a map is good enough.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct ExploreParams {
    /// Looks that a visit makes, `u` of eq. (1), `>= 1`. Default 10.
    pub looks: u32,
    /// Share of the triangles of near landmarks that may turn the wrong way in a finished map, in `(0, 0.5)`.
    /// Default 0.03.
    pub error: f64,
}

impl Default for ExploreParams {
    fn default() -> Self {
        Self { looks: 10, error: 0.03 }
    }
}

impl ExploreParams {
    fn check(&self) -> Result<(), PlanError> {
        let bad = |name, value, wanted| Err(PlanError::BadParameter { name, value, wanted });
        if self.looks == 0 {
            return bad("explore.looks", 0.0, "1 or more");
        }
        if !(self.error > 0.0 && self.error < 0.5) {
            return bad("explore.error", self.error, "a share between 0 and 0.5");
        }
        Ok(())
    }
}

/// Why more looks are wanted somewhere.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Reason {
    /// The side of a part of the map hangs on the landmarks here.
    Hinge,
    /// Its links leave it a choice of places.
    Loose,
    /// Seen in less than half as many steps as the median of its component.
    FewSightings,
    /// Its standard deviation is more than one and a half times the median of its component.
    Uncertain,
}

impl Reason {
    /// The name that files use.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Hinge => "hinge",
            Self::Loose => "loose",
            Self::FewSightings => "few_sightings",
            Self::Uncertain => "uncertain",
        }
    }
}

/// A place to go to.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Goal {
    /// String ID of the landmark there.
    pub id: String,
    /// Its component.
    pub component: u32,
    /// Share of the variance of its component that a visit is expected to take away, in `(0, 1)`.
    pub gain: f64,
    /// How far it is from where the robot is, in units of the map; `None` in another component, or if that is not known.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub distance: Option<f64>,
    /// Steps that show the landmark.
    pub sightings: u32,
    /// Standard deviation of its place, in units of the map.
    pub deviation: f64,
    /// Why; none where the place merely gains most.
    pub reasons: Vec<Reason>,
}

/// The `k` best goals, the best first, in the same component no two of them nearer to each other than the range of
/// the sensor. Where the robot is makes near goals better ones; those of other components come last.
/// `O(n (m + k))` for `m` landmarks in a range.
///
/// # Errors
/// [`PlanError::NoSensor`], [`PlanError::BadParameter`].
pub fn next_best(
    index: &MapIndex,
    from: Option<&Location>,
    k: usize,
    params: ExploreParams,
) -> Result<Vec<Goal>, PlanError> {
    params.check()?;
    let map = index.map();
    let sensing = map.sensing().ok_or(PlanError::NoSensor { landmarks: map.len() })?;
    let here = from.and_then(Location::best);
    let mut candidates = Vec::with_capacity(map.len());
    for component in index.components() {
        let members = index.component(component)?;
        let typical = Typical::of(index, members);
        let hinges = hinges(index, component);
        let candidate = |&id: &LandmarkId| {
            let placed = index.placed(id);
            let away = here.filter(|here| here.component == component).map(|here| {
                let [x, y] = here.position;
                (placed.position[0] - x).hypot(placed.position[1] - y)
            });
            let gain = gain(index, sensing, id, f64::from(params.looks))? / typical.variance;
            let near = 1.0 + away.unwrap_or(0.0) / (2.0 * sensing.sensor(component).range);
            let stake = hinges.iter().filter(|hinge| hinge.0.binary_search(&id).is_ok());
            let stake = stake.map(|hinge| hinge.1).fold(0.0, f64::max);
            Ok(Candidate {
                id,
                elsewhere: here.is_some() && away.is_none(),
                stake,
                worth: gain / near,
                goal: typical.goal(index, id, gain, away, stake > 0.0),
            })
        };
        candidates.extend(members.par_iter().map(candidate).collect::<Result<Vec<_>, PlanError>>()?);
    }
    candidates.sort_by(|a, b| {
        let by_stake = b.stake.total_cmp(&a.stake).then(b.worth.total_cmp(&a.worth));
        a.elsewhere.cmp(&b.elsewhere).then(by_stake).then(a.id.cmp(&b.id))
    });
    Ok(apart(index, sensing, candidates, k))
}

/// A landmark with all that decides its rank.
struct Candidate {
    id: LandmarkId,
    /// In another component than the robot.
    elsewhere: bool,
    /// Landmarks whose side is expected to be wrong, if it is at a hinge; 0 elsewhere.
    stake: f64,
    /// Gain by the cost of the way.
    worth: f64,
    goal: Goal,
}

/// Eq. (1).
fn gain(index: &MapIndex, sensing: &Sensing, id: LandmarkId, looks: f64) -> Result<f64, PlanError> {
    let sensor = sensing.sensor(index.placed(id).component);
    let around = index.within(id, sensor.range + 4.0 * sensor.edge)?;
    let own = crate::Near { landmark: id, distance: 0.0 };
    let gains = std::iter::once(&own).chain(&around).map(|near| {
        let more = looks * sensing.of(near.landmark).detectability * sensor.visibility(near.distance);
        let n = f64::from(index.placed(near.landmark).sightings);
        index.covariance_of(near.landmark).deviation().powi(2) * more / (n + more)
    });
    Ok(gains.sum())
}

/// What is usual in a component.
struct Typical {
    sightings: f64,
    deviation: f64,
    /// Sum of the variances of all landmarks.
    variance: f64,
}

impl Typical {
    fn of(index: &MapIndex, members: &[LandmarkId]) -> Self {
        let mut sightings: Vec<u32> = members.iter().map(|&id| index.placed(id).sightings).collect();
        let middle = sightings.len() / 2;
        Self {
            sightings: f64::from(*sightings.select_nth_unstable(middle).1),
            deviation: typical_deviation(index, members),
            variance: members.iter().map(|&id| index.covariance_of(id).deviation().powi(2)).sum(),
        }
    }

    fn goal(&self, index: &MapIndex, id: LandmarkId, gain: f64, distance: Option<f64>, hinge: bool) -> Goal {
        let placed = index.placed(id);
        let deviation = index.covariance_of(id).deviation();
        let reasons = [
            (Reason::Hinge, hinge),
            (Reason::Loose, placed.loose),
            (Reason::FewSightings, f64::from(placed.sightings) < FEW * self.sightings),
            (Reason::Uncertain, deviation > UNCERTAIN * self.deviation),
        ];
        let reasons = reasons.into_iter().filter(|reason| reason.1).map(|reason| reason.0).collect();
        let id = index.name(id).to_owned();
        Goal {
            id,
            component: placed.component,
            gain,
            distance,
            sightings: placed.sightings,
            deviation,
            reasons,
        }
    }
}

/// The landmarks at every hinge of a component, ascending, and the number of landmarks whose side is expected to be
/// wrong. At a hinge are the ends of the lines of sight from the one region to the other.
fn hinges(index: &MapIndex, component: u32) -> Vec<(Vec<LandmarkId>, f64)> {
    let report = index.map().report().components.get(component as usize);
    let of_hinge = |hinge: &Hinge| {
        let [a, b] = hinge.seam.regions;
        let region = |id: LandmarkId| index.placed(id).region;
        let joins = |from: LandmarkId| {
            let other = if region(from) == a { b } else { a };
            index.map().sight_lines().of(from).iter().any(|line| region(line.to) == other)
        };
        let ends = [a, b].into_iter().flat_map(|end| index.region(end)).copied();
        let mut ends: Vec<LandmarkId> = ends.filter(|&id| joins(id)).collect();
        ends.sort_unstable();
        (ends, f64::from(hinge.landmarks) / (1.0 + hinge.seam.evidence.exp()))
    };
    report.map_or(Vec::new(), |report| report.seams.hinges.iter().map(of_hinge).collect())
}

/// The first `k` that keep a range away from those before.
fn apart(index: &MapIndex, sensing: &Sensing, candidates: Vec<Candidate>, k: usize) -> Vec<Goal> {
    let mut taken: Vec<LandmarkId> = Vec::new();
    let mut goals = Vec::new();
    for candidate in candidates {
        let placed = index.placed(candidate.id);
        let is_near = |&other: &LandmarkId| {
            let other = index.placed(other);
            let [dx, dy] = [0, 1].map(|axis| placed.position[axis] - other.position[axis]);
            other.component == placed.component && dx.hypot(dy) < sensing.sensor(placed.component).range
        };
        if goals.len() == k {
            break;
        }
        if !taken.iter().any(is_near) {
            taken.push(candidate.id);
            goals.push(candidate.goal);
        }
    }
    goals
}

#[cfg(test)]
mod tests;
