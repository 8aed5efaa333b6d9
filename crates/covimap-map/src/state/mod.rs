//! What is needed to go on from a map when there are more steps.
//!
//! A finished map does not tell all that it was made of. A [`MapState`] does: the log, its counts, and of every
//! component the positions of least stress before the refinement, the distance function and the sensor that were
//! learnt. [`MapState::update`] adds steps; [`MapState::save`] and [`MapState::load`] keep it between runs.

mod file;

pub(crate) use file::is_state;

use covimap_embed::Point;
use serde::{Deserialize, Serialize};

use crate::component::Basis;
use crate::distances::Law;
use crate::mapper::Built;
use crate::places::Sensor;
use crate::{CoVisibility, GlobalMap, MapError, Mapper, Observer, SightingLog};

/// A map with what is needed to go on from it.
///
/// ```
/// use covimap_map::{MapState, Mapper, MapperParams, Silent, SightingLog};
///
/// let steps = [["A", "B", "C"], ["B", "C", "D"], ["A", "B", "D"], ["A", "C", "D"]];
/// let log = SightingLog::from_steps([&steps[..], &steps[..]].concat());
/// let mut state: MapState = Mapper::new(MapperParams::default())?.build_with_state(log, &Silent)?;
/// let report = state.update(&SightingLog::from_steps([["C", "D", "E"], ["B", "D", "E"]]), &Silent)?;
/// assert_eq!((report.steps, report.landmarks), (2, 1));
/// assert_eq!(state.map().len(), 5);
/// # Ok::<(), covimap_map::MapError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct MapState {
    pub(crate) log: SightingLog,
    pub(crate) counts: CoVisibility,
    pub(crate) map: GlobalMap,
    pub(crate) ground: Ground,
}

/// What a map does not tell of how it was made.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Ground {
    /// Position of least stress of every landmark of the map, before the refinement.
    pub polished: Vec<Point>,
    /// What every landmark of the map was last solved with.
    pub settled: Vec<Settled>,
    /// By component of the map.
    pub rules: Vec<Rules>,
    /// Sightings of the log when all of it was last solved at once.
    pub whole: u64,
}

/// Evidence that a landmark was solved with.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct Settled {
    pub sightings: u32,
    /// Number of its links.
    pub partners: u32,
}

/// What was learnt for a component as a whole.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(crate) struct Rules {
    /// What turned counts into distances; `None` for the fixed logarithm.
    pub law: Option<Law>,
    /// The sensor of the refinement; `None` where nothing was refined.
    pub sensor: Option<Sensor>,
}

impl Mapper {
    /// As [`Mapper::build`], and keeps what is needed to go on when there are more steps: see [`MapState`].
    ///
    /// # Errors
    /// As [`Mapper::build`].
    pub fn build_with_state(&self, log: SightingLog, observer: &dyn Observer) -> Result<MapState, MapError> {
        let counts = CoVisibility::count(&log, observer)?;
        let built = self.build_known(&log, counts, observer)?;
        Ok(MapState::new(log, built))
    }
}

impl MapState {
    /// Of a map for which everything was solved.
    pub(crate) fn new(log: SightingLog, built: Built) -> Self {
        let Built { map, counts, bases } = built;
        let mut polished = vec![[0.0; 2]; map.len()];
        for (members, basis) in members(&map).iter().zip(&bases) {
            for (&member, &point) in members.iter().zip(&basis.polished) {
                polished[member as usize] = point;
            }
        }
        let of_map = |placed: &crate::PlacedLandmark| Settled {
            sightings: placed.sightings,
            partners: placed.partners,
        };
        let settled = map.landmarks().iter().map(of_map).collect();
        let rules = bases.into_iter().map(|Basis { law, sensor, .. }| Rules { law, sensor }).collect();
        let whole = log.sightings() as u64;
        Self { log, counts, map, ground: Ground { polished, settled, rules, whole } }
    }

    /// The map.
    #[must_use]
    pub fn map(&self) -> &GlobalMap {
        &self.map
    }

    /// The log so far. Its text is gone: it has no lines and no duplicates.
    #[must_use]
    pub fn log(&self) -> &SightingLog {
        &self.log
    }

    /// Counts of the log so far.
    #[must_use]
    pub fn counts(&self) -> &CoVisibility {
        &self.counts
    }
}

/// The landmarks of every component of a map, ascending.
pub(crate) fn members(map: &GlobalMap) -> Vec<Vec<u32>> {
    let components = map.landmarks().iter().map(|placed| placed.component as usize + 1).max().unwrap_or(0);
    let mut members = vec![Vec::new(); components];
    for (landmark, placed) in (0..).zip(map.landmarks()) {
        members[placed.component as usize].push(landmark);
    }
    members
}

#[cfg(test)]
mod tests;
