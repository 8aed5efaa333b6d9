//! The pipeline: a log in, a [`GlobalMap`] out.

use covimap_embed::{EmbedError, Point};

use crate::aliases;
use crate::assembly;
use crate::classical;
use crate::component::{Basis, ComponentMap, Evidence, map_component, put_in_frame};
use crate::distances::{ComponentSteps, Membership};
use crate::places::SeenSets;
use crate::ranges;
use crate::sensing;
use crate::settle::{Start, in_map_units, settle};
use crate::shape::Shape;
use crate::surveyor::Surveyor;
use crate::{
    CoVisibility, GlobalMap, HonestLinks, HonestyReport, LandmarkId, LinkGraph, MapError, MapperParams,
    Method, Observer, Sensing, SightLines, SightingLog,
};

/// Builds maps with one set of checked parameters.
#[derive(Debug, Clone, PartialEq)]
pub struct Mapper {
    params: MapperParams,
}

impl Mapper {
    /// Checks the parameters.
    ///
    /// # Errors
    /// [`MapError::BadParameter`] for the first one out of its range.
    pub fn new(params: MapperParams) -> Result<Self, MapError> {
        params.classical.check()?;
        params.auto.check()?;
        Ok(Self { params })
    }

    /// Maps a log. The same log and parameters give the same map for any number of threads.
    ///
    /// # Errors
    /// [`MapError::NothingTogether`] if no step shows two landmarks; [`MapError::NoInformation`] if
    /// all landmarks are always seen together; [`MapError::TooLargeForClassical`];
    /// [`MapError::Interrupted`] if the observer asks for it.
    pub fn build(&self, log: &SightingLog, observer: &dyn Observer) -> Result<GlobalMap, MapError> {
        let counts = CoVisibility::count(log, observer)?;
        Ok(self.build_known(log, counts, observer)?.map)
    }

    /// Maps a log that is counted already.
    pub(crate) fn build_known(
        &self,
        log: &SightingLog,
        counts: CoVisibility,
        observer: &dyn Observer,
    ) -> Result<Built, MapError> {
        let aliases = match self.params.method {
            Method::Auto => aliases::find(&counts),
            Method::Classical => Vec::new(),
        };
        if aliases.is_empty() {
            return self.build_counted(log, counts, None, observer);
        }
        let split = self.params.auto.split_aliases;
        let mut built = if split {
            let log = aliases::split(log, &aliases)?;
            let split = CoVisibility::count(&log, observer)?;
            Built { counts, ..self.build_counted(&log, split, None, observer)? }
        } else {
            self.build_counted(log, counts, None, observer)?
        };
        built.map.report.warnings.insert(0, aliases::warning(log, &aliases, split));
        Ok(built)
    }

    /// Polishes and refines from given positions, without regions and local maps: what the same minimisation
    /// makes of a start of one's own, such as surveyed positions.
    ///
    /// `start` has a position for every landmark of the log, each component in any frame and unit. The stages
    /// are those of [`Method::Auto`], whatever the method of the parameters; every ID is taken for one landmark.
    ///
    /// # Errors
    /// As [`Mapper::build`]; [`MapError::Embed`] for a start of another length or with all landmarks of a
    /// component in one place, [`MapError::NotFinite`] for a
    /// position that is nowhere.
    pub fn build_from(
        &self,
        log: &SightingLog,
        start: &[Point],
        observer: &dyn Observer,
    ) -> Result<GlobalMap, MapError> {
        let wanted = log.names().len();
        if start.len() != wanted {
            let what = "one position for each landmark is needed";
            return Err(EmbedError::BadStart { what, found: start.len(), wanted }.into());
        }
        if let Some(index) = start.iter().position(|point| !point.iter().all(|v| v.is_finite())) {
            return Err(MapError::NotFinite { index, position: start[index] });
        }
        let params = MapperParams { method: Method::Auto, ..self.params.clone() };
        let counts = CoVisibility::count(log, observer)?;
        Ok(Self { params }.build_counted(log, counts, Some(start), observer)?.map)
    }

    /// Maps a log in which every ID is one landmark.
    fn build_counted(
        &self,
        log: &SightingLog,
        counts: CoVisibility,
        start: Option<&[Point]>,
        observer: &dyn Observer,
    ) -> Result<Built, MapError> {
        check_information(&counts)?;
        let (graph, honesty) = match self.params.method {
            Method::Auto => honest_links(&counts),
            Method::Classical => (LinkGraph::from_counts(&counts), HonestyReport::default()),
        };
        let components = graph.components();
        let sets = SeenSets::by_component(log, &components);
        let mut maps: Vec<ComponentMap> = match self.params.method {
            Method::Auto => {
                let known =
                    Known { log, counts: &counts, graph: &graph, components: &components, sets: &sets };
                self.auto_components(&known, start, observer)?
            }
            Method::Classical => components
                .iter()
                .map(|members| {
                    classical::map_component(&counts, &graph, members, &self.params.classical, observer)
                })
                .collect::<Result<_, MapError>>()?,
        };
        if self.params.method == Method::Auto {
            let mut own: Vec<&mut Vec<Point>> = maps.iter_mut().map(|map| &mut map.points).collect();
            let ranged = ranges::fit(log, &counts, &components, &mut own, observer)?;
            maps.iter_mut().zip(ranged).for_each(|(map, ranged)| map.ranges = ranged);
        }
        let charts: Vec<&[Point]> = maps.iter().map(|map| map.points.as_slice()).collect();
        let sensing = sensing::learn(&counts, &graph, &components, &charts, &sets, observer)?;
        let bases = maps.iter_mut().map(|map| std::mem::take(&mut map.basis)).collect();
        let known = Known { log, counts: &counts, graph: &graph, components: &components, sets: &sets };
        let map = self.assemble(&known, honesty, maps, sensing)?;
        Ok(Built { map, counts, bases })
    }

    /// The product, from the maps of all components.
    pub(crate) fn assemble(
        &self,
        known: &Known,
        honesty: HonestyReport,
        maps: Vec<ComponentMap>,
        sensing: Option<Sensing>,
    ) -> Result<GlobalMap, MapError> {
        let Known { log, counts, graph, components, .. } = *known;
        let landmarks = assembly::place(counts, graph, components, &maps);
        let report = assembly::report(counts, graph, honesty, components, maps, &landmarks, log);
        let sight_lines = SightLines::find(&landmarks, counts, graph, components);
        let map = GlobalMap::from_parts(log.names().clone(), landmarks, self.params.clone(), report)?
            .with_sight_lines(sight_lines)?;
        let map = match sensing {
            Some(sensing) => map.with_sensing(sensing)?,
            None => map,
        };
        ranges::in_metres(map)
    }

    pub(crate) fn auto_components(
        &self,
        known: &Known,
        start: Option<&[Point]>,
        observer: &dyn Observer,
    ) -> Result<Vec<ComponentMap>, MapError> {
        let Known { log, counts, graph, components, sets } = *known;
        let MapperParams { auto, seed, .. } = &self.params;
        let membership = Membership::new(graph.landmarks(), components);
        let steps = ComponentSteps::of_all(log, &membership, components.len());
        let map_one = |graph: &LinkGraph, evidence: &Evidence| match start {
            None => map_component(graph, evidence, auto, *seed, observer),
            Some(all) => {
                let own: Vec<Point> = evidence.members.iter().map(|&member| all[member as usize]).collect();
                let fixed = graph.to_pairs();
                let distances = evidence.distances(graph, &fixed, *seed);
                let surveyor =
                    Surveyor { graph, distances: distances.as_ref(), params: auto, seed: *seed, observer };
                let start = Start { points: in_map_units(graph, own)?, shape: Shape::FREE, untwisted: false };
                settle(&surveyor, &fixed, evidence, start)
            }
        };
        let map = |((members, sets), steps): ((&Vec<u32>, &SeenSets), ComponentSteps)| {
            let evidence = Evidence { counts, members, steps: &steps, sets };
            let mut map = if members.len() == graph.landmarks() {
                map_one(graph, &evidence)?
            } else {
                map_one(&graph.restricted_to(members), &evidence)?
            };
            put_in_frame(&mut map.points, &mut map.basis.polished);
            Ok(map)
        };
        components.iter().zip(sets).zip(steps).map(map).collect()
    }
}

/// A map, and what it was made of.
pub(crate) struct Built {
    pub map: GlobalMap,
    /// Of the log as it was given, whatever became of its aliases.
    pub counts: CoVisibility,
    /// One a component of the map.
    pub bases: Vec<Basis>,
}

/// A log with what was counted of it.
#[derive(Clone, Copy)]
pub(crate) struct Known<'a> {
    pub log: &'a SightingLog,
    pub counts: &'a CoVisibility,
    pub graph: &'a LinkGraph,
    /// Components to map.
    pub components: &'a [Vec<u32>],
    pub sets: &'a [SeenSets],
}

fn check_information(counts: &CoVisibility) -> Result<(), MapError> {
    if counts.pair_count() == 0 {
        return Err(MapError::NothingTogether { steps: counts.steps(), landmarks: counts.landmarks() });
    }
    let n = counts.landmarks();
    let complete = counts.pair_count() == n * (n - 1) / 2;
    let same = |i: usize| {
        let (_, together) = counts.row(LandmarkId(i as u32));
        together.iter().all(|&both| both == counts.sightings()[i])
    };
    // Two landmarks make a map of one distance, whatever it is.
    if n > 2 && complete && (0..n).all(same) {
        return Err(MapError::NoInformation { landmarks: n, steps: counts.sightings()[0] });
    }
    Ok(())
}

pub(crate) fn honest_links(counts: &CoVisibility) -> (LinkGraph, HonestyReport) {
    let honest = HonestLinks::judge(counts);
    (LinkGraph::from_honest(counts, &honest), honest.report())
}

#[cfg(test)]
mod tests;
