//! The road map: lines of sight as roads between landmarks, and ways over them.
//!
//! A road joins two neighbours that were seen together ([`covimap_map::SightLines`]): no wall stood
//! between the robot and either of them. Nothing is known of the ground, so a route is a plan for a
//! robot that looks where it goes, not a guarantee.
//!
//! | objective | cost of a road | in words |
//! |---|---|---|
//! | shortest | its length | least way |
//! | safest | `-ln f_ij` | the next landmark is most likely in sight all the way |
//!
//! `f_ij` is the co-visibility frequency: the chance that who sees one of the two sees both. The product of
//! the chances of all legs is `exp(-cost)`.
//!
//! Landmarks are things, often with a wall behind them, so a way-point is not a landmark but the middle
//! between the two ends of a leg.

use std::sync::Arc;

use covimap_embed::Point;
use covimap_map::{LandmarkId, SightLine};
use rayon::prelude::*;
use serde::Serialize;

use crate::confidence::{frequency, length};
use crate::index::each;
use crate::search::{AStar, RouteSearch, SearchGraph};
use crate::{LandmarkRef, MapIndex, PlanError};

mod bound;
mod cells;
mod overlay;

use bound::Bound;
use overlay::Overlay;

/// Most landmarks in a cell of prepared roads. Half as many save a third of the preparation where the view is open, and
/// cost half of the gain where walls part the map.
const CELL: usize = 1000;

/// What a route should be good at.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Objective {
    /// The least length (default).
    #[default]
    Shortest,
    /// The next landmark in sight as surely as can be.
    Safest,
}

/// Which roads count, and what they cost.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct RoadParams {
    /// What a route should be good at.
    pub objective: Objective,
    /// Fewest steps that must show both ends of a road; 1 (default) takes every road. More leaves out roads
    /// that a single misread ID may have made.
    pub min_steps: u32,
}

impl Default for RoadParams {
    fn default() -> Self {
        Self { objective: Objective::Shortest, min_steps: 1 }
    }
}

/// The roads of a map.
#[derive(Debug, Clone)]
pub struct Roads<'a> {
    index: &'a MapIndex,
    params: RoadParams,
    /// Costs by place in the rows of the lines of sight; none where roads cost their length.
    costs: Vec<f64>,
    bound: Bound,
    /// Of prepared roads.
    overlay: Option<Arc<Overlay>>,
}

/// A place on the way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Waypoint {
    /// Middle between the two landmarks, in the frame of the component.
    pub position: Point,
    /// The landmarks to keep in sight: the one left behind and the one ahead.
    pub in_sight: [LandmarkId; 2],
    /// Steps of the log that show both.
    pub steps: u32,
    /// Cost from the start to the landmark ahead.
    pub cost: f64,
}

/// A way from landmark to landmark.
#[derive(Debug, Clone, PartialEq)]
pub struct Route {
    /// From the start to the goal, both included.
    pub landmarks: Vec<LandmarkId>,
    /// One a leg; none if the goal is the start.
    pub waypoints: Vec<Waypoint>,
    /// Length from landmark to landmark, in units of the map.
    pub length: f64,
    /// Sum of the costs of the roads.
    pub cost: f64,
}

impl<'a> Roads<'a> {
    /// The roads of a map, in `O(n)` for `n` landmarks: 16 bytes each for the shortest, some 70 for the safest.
    ///
    /// # Errors
    /// [`PlanError::NoSightLines`] for a map that has landmarks but no roads.
    pub fn new(index: &'a MapIndex, params: RoadParams) -> Result<Self, PlanError> {
        let map = index.map();
        if map.sight_lines().count() == 0 {
            return Err(PlanError::NoSightLines);
        }
        let (costs, bound) = match params.objective {
            Objective::Shortest => (Vec::new(), Bound::of_lengths(map)),
            Objective::Safest => {
                let risks = |id: LandmarkId| {
                    map.sight_lines().of(id).iter().map(move |line| -frequency(map, id, line).ln())
                };
                let costs: Vec<f64> =
                    (0..map.len() as u32).into_par_iter().flat_map_iter(|id| risks(LandmarkId(id))).collect();
                let bound = Bound::of_costs(map, &costs);
                (costs, bound)
            }
        };
        Ok(Self { index, params, costs, bound, overlay: None })
    }

    /// The same roads made ready for many routes over a large map: [`Roads::route`] costs no less and no more, and
    /// takes a third of the time or less where the map is large. Of equally cheap ways another one may be found.
    ///
    /// Takes as long as some hundred routes do, and memory of some 100 bytes a landmark; what was measured stands in
    /// `docs/maths/planning.md`.
    #[must_use]
    pub fn prepare(self) -> Self {
        let overlay = Some(Arc::new(Overlay::new(&self, CELL)));
        Self { overlay, ..self }
    }

    /// The cheapest way between two landmarks; of equally cheap ones always the same.
    ///
    /// # Errors
    /// Those of [`MapIndex::id`]; [`PlanError::Apart`] for landmarks of different components;
    /// [`PlanError::NoRoute`] when all ways have a leg that [`RoadParams::min_steps`] leaves out.
    pub fn route(&self, from: impl LandmarkRef, to: impl LandmarkRef) -> Result<Route, PlanError> {
        match &self.overlay {
            Some(overlay) => self.route_by(&**overlay, from, to),
            None => self.route_by(&AStar, from, to),
        }
    }

    /// [`Roads::route`] between many pairs, on all threads.
    ///
    /// # Errors
    /// Those of the first pair that has some.
    pub fn route_of_each<L: LandmarkRef + Sync>(&self, pairs: &[[L; 2]]) -> Result<Vec<Route>, PlanError> {
        each(pairs, |[from, to]| self.route(from, to))
    }

    /// The way that a search of your own finds.
    ///
    /// # Errors
    /// Those of [`Roads::route`]; [`PlanError::Astray`] when the search comes back with other ends,
    /// [`PlanError::NoSuchRoad`] when it does with a leg that is no road.
    pub fn route_by(
        &self,
        search: &impl RouteSearch<Self>,
        from: impl LandmarkRef,
        to: impl LandmarkRef,
    ) -> Result<Route, PlanError> {
        let [from, to] = [self.index.id(from)?, self.index.id(to)?];
        self.index.check_together(from, to)?;
        match search.search(self, from, to) {
            Some(way) => {
                let whole = way.first() == Some(&from) && way.last() == Some(&to);
                if whole && way.iter().all(|id| id.index() < self.index.map().len()) {
                    return self.along(way);
                }
                let [from, to] = [from, to].map(|id| self.index.name(id).to_owned());
                Err(PlanError::Astray { from, to })
            }
            None => {
                let [from, to] = [from, to].map(|id| self.index.name(id).to_owned());
                Err(PlanError::NoRoute { from, to, min_steps: self.params.min_steps })
            }
        }
    }

    fn along(&self, landmarks: Vec<LandmarkId>) -> Result<Route, PlanError> {
        let map = self.index.map();
        let mut route = Route { landmarks, waypoints: Vec::new(), length: 0.0, cost: 0.0 };
        for leg in route.landmarks.windows(2) {
            let (from, to) = (leg[0], leg[1]);
            let (road, cost) = self.lines(from).find(|(line, _)| line.to == to).ok_or_else(|| {
                let [from, to] = [from, to].map(|id| self.index.name(id).to_owned());
                PlanError::NoSuchRoad { from, to }
            })?;
            let [a, b] = [from, to].map(|id| self.index.placed(id).position);
            route.length += length(map, from, to);
            route.cost += cost;
            route.waypoints.push(Waypoint {
                position: [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])],
                in_sight: [from, to],
                steps: road.steps,
                cost: route.cost,
            });
        }
        Ok(route)
    }

    /// The lines of sight from a landmark that are roads, with their costs.
    fn lines(&self, from: LandmarkId) -> impl Iterator<Item = (&SightLine, f64)> {
        let lines = self.index.map().sight_lines();
        let cost = move |(line, place): (&SightLine, usize)| match self.params.objective {
            Objective::Shortest => self.bound.at_least(from, line.to),
            Objective::Safest => self.costs[place],
        };
        let priced =
            lines.of(from).iter().zip(lines.row(from)).filter(|road| road.0.steps >= self.params.min_steps);
        priced.map(move |road| (road.0, cost(road)))
    }
}

impl SearchGraph for Roads<'_> {
    fn landmarks(&self) -> usize {
        self.index.map().len()
    }

    fn roads_from(&self, from: LandmarkId) -> impl Iterator<Item = (LandmarkId, f64)> {
        self.lines(from).map(|(line, cost)| (line.to, cost))
    }

    fn at_least(&self, from: LandmarkId, to: LandmarkId) -> f64 {
        self.bound.at_least(from, to)
    }
}

#[cfg(test)]
mod tests;
