//! Steering by the map and by what is seen: wander, and be sent where little has been seen.
//!
//! A robot that wanders straight on until something is in its way covers the floor quickly, and looks from everywhere, from along the walls
//! too. What it lacks is that it never notices what it has missed. So it is left to wander, but for errands: as soon as
//! the map has a landmark that was seen in less than three tenths of the steps of the median, the robot goes there over
//! lines of sight, from landmark to landmark, and wanders on from there. Of several the greatest
//!
//! `(0.3 n_median / n_j) / (1 + d_j / 2 R)`  (3)
//!
//! is chosen, `d_j` being its distance from the middle of what is in sight. There is no errand before the median
//! landmark was seen in eight steps, nor as long as the robot keeps coming upon landmarks that the map lacks: until
//! then wandering on brings more.
//!
//! The robot need not know where it is: it must be able to turn towards a landmark that it sees, no more.
//! What was tried before, and why even counts are no goal by themselves, is told in `docs/maths/exploration.md`.

use std::sync::Arc;

use covimap_embed::Point;
use covimap_map::LandmarkId;

use crate::{MapIndex, PlanError, RoadParams, Roads};

/// A landmark seen in less than this share of the steps that show the median landmark is worth an errand.
const SELDOM: f64 = 0.3;
/// Steps that must have shown the median landmark before the first errand.
const ENOUGH: u32 = 8;
/// An errand is done when so many looks have shown its goal.
const LOOKS: u32 = 5;
/// Looks between two errands.
const REST: u32 = 10;
/// Looks without an errand after one that shows a landmark which the map lacks.
const NEWS: u32 = 30;
/// An errand is given up after so many looks, and so many more for every range of the way.
const PATIENCE: (f64, f64) = (12.0, 7.0);

/// On its way to a landmark.
#[derive(Debug, Clone)]
struct Errand {
    /// The way, the goal first.
    way: Vec<LandmarkId>,
    /// Looks that may still show the goal.
    looks: u32,
    /// Looks until it is given up.
    patience: u32,
}

/// Sends a wandering robot where little has been seen.
#[derive(Debug, Clone)]
pub struct Explorer {
    index: Arc<MapIndex>,
    /// Steps that show each landmark, those since the map was made included.
    sightings: Vec<u32>,
    errand: Option<Errand>,
    /// Looks to come without an errand.
    rest: u32,
}

impl Explorer {
    /// Begins with a map of all looks so far.
    ///
    /// # Errors
    /// [`PlanError::NoSensor`] for a map that does not know its sensor.
    pub fn new(index: Arc<MapIndex>) -> Result<Self, PlanError> {
        let map = index.map();
        map.sensing().ok_or(PlanError::NoSensor { landmarks: map.len() })?;
        let sightings = map.landmarks().iter().map(|placed| placed.sightings).collect();
        Ok(Self { index, sightings, errand: None, rest: 0 })
    }

    /// Goes on with a newer map, of all looks so far again. An errand goes on if the new map has all landmarks of its way.
    ///
    /// # Errors
    /// Those of [`Explorer::new`]; then everything is as it was.
    pub fn adopt(&mut self, index: Arc<MapIndex>) -> Result<(), PlanError> {
        let new = Self::new(index)?;
        let renamed = |errand: Errand| {
            let way = errand.way.iter().map(|&id| new.index.lookup(self.index.name(id)));
            Some(Errand { way: way.collect::<Option<_>>()?, ..errand })
        };
        let errand = self.errand.take().and_then(renamed);
        *self = Self { errand, rest: self.rest, ..new };
        Ok(())
    }

    /// Takes in a look: the landmark of it towards which to go, or `None` to wander on. IDs that the map lacks are news.
    /// `O(n)`, and when an errand begins the time of a route.
    pub fn next<'a>(&mut self, seen: impl IntoIterator<Item = &'a str>) -> Option<LandmarkId> {
        let found: Vec<Option<LandmarkId>> = seen.into_iter().map(|id| self.index.lookup(id)).collect();
        if found.contains(&None) {
            self.rest = self.rest.max(NEWS);
        }
        let mut seen: Vec<LandmarkId> = found.into_iter().flatten().collect();
        seen.sort_unstable();
        seen.dedup();
        seen.iter().for_each(|id| self.sightings[id.index()] += 1);
        match &mut self.errand {
            Some(errand) => {
                errand.looks -= u32::from(seen.binary_search(&errand.way[0]).is_ok());
                errand.patience -= 1;
                if errand.looks == 0 || errand.patience == 0 {
                    (self.errand, self.rest) = (None, REST);
                }
            }
            None => self.rest = self.rest.saturating_sub(1),
        }
        if self.errand.is_none() && self.rest == 0 {
            self.errand = self.begin(&seen);
        }
        let way = &self.errand.as_ref()?.way;
        let next = way.iter().copied().find(|id| seen.binary_search(id).is_ok());
        if next.is_none() {
            // Out of sight of the whole way.
            (self.errand, self.rest) = (None, REST);
        }
        next
    }

    /// The errand that is worth most, if there is any.
    fn begin(&self, seen: &[LandmarkId]) -> Option<Errand> {
        let component = self.index.placed(*seen.first()?).component;
        let members = self.index.component(component).expect("a landmark of it was seen (bug in covimap)");
        let sightings = |id: LandmarkId| self.sightings[id.index()];
        let mut sorted: Vec<u32> = members.iter().map(|&id| sightings(id)).collect();
        let middle = sorted.len() / 2;
        let median = *sorted.select_nth_unstable(middle).1;
        if median < ENOUGH {
            return None;
        }
        let few = SELDOM * f64::from(median);
        let place = |id: LandmarkId| self.index.placed(id).position;
        let near: Vec<LandmarkId> =
            seen.iter().copied().filter(|&id| self.index.placed(id).component == component).collect();
        let here = [0, 1].map(|axis| near.iter().map(|&id| place(id)[axis]).sum::<f64>() / near.len() as f64);
        let range =
            self.index.map().sensing().expect("checked when made (bug in covimap)").sensor(component).range;
        // Eq. (3).
        let worth = |id: LandmarkId| {
            few / f64::from(sightings(id)) / (1.0 + distance(here, place(id)) / (2.0 * range))
        };
        let goals = members.iter().copied().filter(|&id| f64::from(sightings(id)) < few);
        let goal = goals.max_by(|&a, &b| worth(a).total_cmp(&worth(b)).then(b.cmp(&a)))?;
        let start = near.into_iter().min_by(|&a, &b| {
            let to_goal = |id: LandmarkId| distance(place(id), place(goal));
            to_goal(a).total_cmp(&to_goal(b))
        })?;
        let route = Roads::new(&self.index, RoadParams::default()).ok()?.route(start, goal).ok()?;
        let patience = PATIENCE.0 + PATIENCE.1 * route.length / range;
        let way = route.landmarks.into_iter().rev().collect();
        Some(Errand { way, looks: LOOKS, patience: patience as u32 })
    }
}

fn distance(a: Point, b: Point) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}
