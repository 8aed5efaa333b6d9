//! New steps for a finished map: only what they change is solved again.
//!
//! # Algorithm
//! 1. Counts are added. Honesty, links and components follow from them as in a build.
//! 2. New landmarks get a place among those they are linked to, and charts that new links join come into one
//!    frame ([`seat`]).
//! 3. Landmarks with a tenth more evidence than they were last solved with are free, and so are those whose place
//!    is new. They are brought to least stress among all others, which are held; whom that pushes by half of its
//!    standard deviation is free from then on, too ([`relax`]).
//! 4. What is free is refined by the steps that tell of it ([`refine`]), from where the old map had it, moved as
//!    the polish has moved it.
//!
//! Distance function and sensor stay as they are; they are properties of the robot, not of a few steps. When
//! half of the landmarks would be free, or a twelfth of the evidence is newer than the last whole solution, everything
//! is solved again and the result laid onto the old map ([`whole`]).
//!
//! # Complexity
//! Reading, adding, judging and writing go with the size of the map, the rest with what has changed.

mod draft;
mod finish;
mod fit;
mod refine;
mod relax;
mod seat;
mod whole;

use crate::mapper::honest_links;
use crate::state::{Ground, members};
use crate::{
    CoVisibility, GlobalMap, HonestyReport, LinkGraph, MapError, MapState, Mapper, MapperParams, Method,
    Observer, SightingLog, UpdateReport, aliases,
};
use draft::Draft;

/// Share of the evidence that may be new before a landmark is solved again: a place moves by about the root of
/// this share, in standard deviations.
const FRESH: f64 = 0.1;
/// Share of the evidence that may be newer than the last whole solution: what bends the map as a whole cannot be
/// mended where only some landmarks move.
const MOST_FRESH: f64 = 1.0 / 12.0;
/// Share of the landmarks that may be solved again among the others.
const MOST_FREE: f64 = 0.5;

/// The joined log and what follows from it.
struct Joined<'a> {
    old: &'a MapState,
    log: SightingLog,
    counts: CoVisibility,
    graph: LinkGraph,
    honesty: HonestyReport,
    components: Vec<Vec<u32>>,
    component_of: Vec<u32>,
    /// Landmarks of the old map by its components.
    charts: Vec<Vec<u32>>,
}

impl MapState {
    /// Adds the steps of a log that continues this one, and brings the map up to date; the settings are those of
    /// the build.
    ///
    /// Only landmarks of which there is new evidence, and those that they push, are solved again; the others keep
    /// their places to the last bit, and the map keeps its frame. See `docs/maths/updating.md`. Where too much has
    /// changed, everything is solved again and the result laid onto the old map; [`UpdateReport::whole`] says why.
    /// The same log, cut at the same places, gives the same map for any number of threads.
    ///
    /// # Errors
    /// As [`crate::Mapper::build`] for the joined log, and [`MapError::TooManySteps`]. The state is then as it was.
    pub fn update(&mut self, later: &SightingLog, observer: &dyn Observer) -> Result<UpdateReport, MapError> {
        let (next, report) = after(self, later, observer)?;
        *self = next;
        Ok(report)
    }
}

/// The state after more steps, and what that took.
fn after(
    old: &MapState,
    later: &SightingLog,
    observer: &dyn Observer,
) -> Result<(MapState, UpdateReport), MapError> {
    let later = old.log.renumber(later);
    let counts = old.counts.joined(&CoVisibility::count(&later, observer)?)?;
    let log = old.log.followed_by(&later);
    let mut report = UpdateReport {
        steps: later.steps() as u64,
        landmarks: (later.names().len() - old.log.names().len()) as u64,
        ..UpdateReport::default()
    };
    let found = match reason(old, &log, &counts) {
        Some(reason) => Err((reason, log, counts)),
        None => {
            let joined = Joined::new(old, log, counts);
            let solved = joined.solve(&mut report, observer)?;
            let Joined { log, counts, .. } = joined;
            match solved {
                Ok((map, ground)) => Ok(MapState { log, counts, map, ground }),
                Err(reason) => Err((reason, log, counts)),
            }
        }
    };
    let mut state = match found {
        Ok(state) => state,
        Err((reason, log, counts)) => {
            let state = whole::solve(old, log, counts, observer)?;
            report.solved = state.map.len() as u64;
            report.whole = Some(reason.to_owned());
            state
        }
    };
    state.map.report.update = Some(report.clone());
    Ok((state, report))
}

/// Why everything is to be solved again, as far as that can be told beforehand.
fn reason(old: &MapState, log: &SightingLog, counts: &CoVisibility) -> Option<&'static str> {
    let MapperParams { method, auto, .. } = old.map.params();
    let by_paths = old.map.report().components.iter().any(|component| component.path_pull > 0.0);
    let fresh = log.sightings() as f64 - old.ground.whole as f64;
    if *method == Method::Classical {
        Some("the classical method is dense and solves everything at once")
    } else if auto.split_aliases && !aliases::find(counts).is_empty() {
        Some("IDs that several landmarks bear are split anew when there are more steps")
    } else if old.map.names() != old.log.names() {
        Some("IDs that several landmarks seemed to bear do so no more")
    } else if !log.ranges().is_empty() {
        Some("ranges hold everything to everything, in metres")
    } else if by_paths {
        Some("the lengths of paths along links hold the map open, and they change as a whole")
    } else if fresh >= MOST_FRESH * log.sightings() as f64 {
        Some("a twelfth of the evidence is newer than the last whole solution")
    } else {
        None
    }
}

impl<'a> Joined<'a> {
    fn new(old: &'a MapState, log: SightingLog, counts: CoVisibility) -> Self {
        let (graph, honesty) = honest_links(&counts);
        let components = graph.components();
        let mut component_of = vec![0; graph.landmarks()];
        for (number, members) in (0..).zip(&components) {
            members.iter().for_each(|&member| component_of[member as usize] = number);
        }
        let charts = members(&old.map);
        Self { old, log, counts, graph, honesty, components, component_of, charts }
    }

    /// Solves what has changed, or says why that will not do.
    fn solve(
        &self,
        report: &mut UpdateReport,
        observer: &dyn Observer,
    ) -> Result<Result<(GlobalMap, Ground), &'static str>, MapError> {
        let mut draft = Draft::new(self);
        seat::seat(self, &mut draft, observer)?;
        if !relax::relax(self, &mut draft, observer)? {
            return Ok(Err("half of the landmarks or more would have to move"));
        }
        refine::refine(self, &mut draft, observer)?;
        report.solved =
            (0..self.landmarks() as u32).filter(|&landmark| draft.is_solved(landmark)).count() as u64;
        report.carried = draft.carried.len() as u64;
        draft.finish(observer).map(Ok)
    }

    fn mapper(&self) -> Mapper {
        Mapper::new(self.params().clone()).expect("settings of a map were checked (bug in covimap)")
    }

    fn params(&self) -> &MapperParams {
        self.old.map.params()
    }

    fn old_map(&self) -> &GlobalMap {
        &self.old.map
    }

    /// Number of landmarks of the joined log.
    fn landmarks(&self) -> usize {
        self.graph.landmarks()
    }

    /// Whether there is so much new evidence of a landmark that its place may have changed.
    fn is_touched(&self, landmark: u32) -> bool {
        let Some(settled) = self.old.ground.settled.get(landmark as usize) else { return true };
        let fresh = |now: usize, then: u32| now.abs_diff(then as usize) as f64 > FRESH * now as f64;
        let sightings = self.counts.sightings()[landmark as usize] as usize;
        fresh(sightings, settled.sightings) || fresh(self.graph.of(landmark).len(), settled.partners)
    }
}

#[cfg(test)]
mod tests;
