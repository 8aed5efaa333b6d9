//! The pipeline: a log in, a [`GlobalMap`] out.

use covimap_embed::{EmbedError, PairDistances, Point, stress1};

use crate::aliases;
use crate::classical;
use crate::component::{Basis, ComponentMap, Evidence, map_component, put_in_frame, settle};
use crate::distances::{ComponentSteps, Membership};
use crate::places::SeenSets;
use crate::ranges;
use crate::report::warnings;
use crate::sensing;
use crate::shape::Shape;
use crate::state::without_ranges;
use crate::stitch::flatness;
use crate::{
    BuildReport, ClassicalParams, CoVisibility, ComponentReport, GlobalMap, HonestLinks, HonestyReport,
    LandmarkId, LinkGraph, MapError, MapState, MapperParams, Method, Observer, PlacedLandmark, SeamsReport,
    Sensing, SightLines, SightingLog, Stage,
};

/// Least over greatest spread of the partners of a landmark below which they lie on a line.
const ON_A_LINE: f64 = 0.1;

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

    /// As [`Mapper::build`], and keeps what is needed to go on when there are more steps: see [`MapState`].
    ///
    /// # Errors
    /// As [`Mapper::build`], and [`MapError::RangesInState`] for a log with ranges.
    pub fn build_with_state(&self, log: SightingLog, observer: &dyn Observer) -> Result<MapState, MapError> {
        without_ranges(&log)?;
        let counts = CoVisibility::count(&log, observer)?;
        let built = self.build_known(&log, counts, observer)?;
        Ok(MapState::new(log, built))
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
                    classical_component(&counts, &graph, members, &self.params.classical, observer)
                })
                .collect::<Result<_, MapError>>()?,
        };
        if self.params.method == Method::Auto {
            let mut own: Vec<&mut Vec<Point>> = maps.iter_mut().map(|map| &mut map.points).collect();
            let ranged = ranges::fit(log, &components, &mut own);
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
        let landmarks = place(counts, graph, components, &maps);
        let report = report(counts, graph, honesty, components, maps, &landmarks, log);
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
                settle(graph, evidence, in_map_units(graph, own)?, Shape::FREE, auto, *seed, observer)
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

/// The points in the scale `sum w d r / sum w r^2` that fits the distances of the links best.
///
/// # Errors
/// [`EmbedError::CoincidingPoints`] where all links have length 0.
fn in_map_units(graph: &LinkGraph, points: Vec<Point>) -> Result<Vec<Point>, EmbedError> {
    let (mut across, mut square) = (0.0, 0.0);
    for (i, here) in points.iter().enumerate() {
        for link in graph.of(i as u32) {
            let there = points[link.to as usize];
            let length = (there[0] - here[0]).hypot(there[1] - here[1]);
            across += link.weight * link.distance * length;
            square += link.weight * length * length;
        }
    }
    if graph.link_count() > 0 && square <= 0.0 {
        return Err(EmbedError::CoincidingPoints { pairs: graph.link_count() });
    }
    let scale = if square > 0.0 { across / square } else { 1.0 };
    Ok(points.into_iter().map(|point| point.map(|coordinate| scale * coordinate)).collect())
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

fn classical_component(
    counts: &CoVisibility,
    graph: &LinkGraph,
    members: &[u32],
    params: &ClassicalParams,
    observer: &dyn Observer,
) -> Result<ComponentMap, MapError> {
    observer.started(Stage::Classical, None);
    if observer.interrupted() {
        return Err(MapError::Interrupted);
    }
    let mut points = classical::solve(counts, members, params)?.points;
    put_in_frame(&mut points, &mut []);
    observer.finished(Stage::Classical);
    let pairs = paper_pairs(counts, graph, members, params);
    Ok(ComponentMap {
        stress1: stress1(&pairs, &points),
        region: vec![0; members.len()],
        basis: Basis { polished: points.clone(), law: None, sensor: None },
        points,
        regions: 1,
        branch_of: vec![0],
        seams: SeamsReport::default(),
        path_pull: 0.0,
        iterations: 0,
        converged: true,
        distances: None,
        ranges: None,
    })
}

/// The co-seen pairs with the paper's distances, all of weight 1.
fn paper_pairs(
    counts: &CoVisibility,
    graph: &LinkGraph,
    members: &[u32],
    params: &ClassicalParams,
) -> PairDistances {
    graph.restricted_to(members).to_pairs_with(|i, j| {
        let f = counts.frequency(LandmarkId(members[i as usize]), LandmarkId(members[j as usize]));
        (params.squared_distance(f).sqrt(), 1.0)
    })
}

fn place(
    counts: &CoVisibility,
    graph: &LinkGraph,
    components: &[Vec<u32>],
    maps: &[ComponentMap],
) -> Vec<PlacedLandmark> {
    let mut landmarks = vec![PlacedLandmark::default(); graph.landmarks()];
    let mut first_region = 0;
    for (component, (members, map)) in components.iter().zip(maps).enumerate() {
        for (place, &landmark) in members.iter().enumerate() {
            let position: Point = map.points[place];
            landmarks[landmark as usize] = PlacedLandmark {
                position,
                component: component as u32,
                region: first_region + map.region[place],
                sightings: counts.sightings()[landmark as usize],
                partners: graph.of(landmark).len() as u32,
                branch: map.branch_of[map.region[place] as usize],
                loose: false,
            };
        }
        first_region += map.regions as u32;
    }
    let loose: Vec<bool> = (0..landmarks.len() as u32).map(|i| is_loose(graph, &landmarks, i)).collect();
    landmarks.iter_mut().zip(loose).for_each(|(landmark, loose)| landmark.loose = loose);
    landmarks
}

/// Whether the links of a landmark leave it a choice of places.
fn is_loose(graph: &LinkGraph, landmarks: &[PlacedLandmark], landmark: u32) -> bool {
    let links = graph.of(landmark);
    links.len() < 3 || flatness(links.iter().map(|link| landmarks[link.to as usize].position)) < ON_A_LINE
}

fn report(
    counts: &CoVisibility,
    graph: &LinkGraph,
    honesty: HonestyReport,
    components: &[Vec<u32>],
    maps: Vec<ComponentMap>,
    landmarks: &[PlacedLandmark],
    log: &SightingLog,
) -> BuildReport {
    let mut first_region = 0;
    let component = |(members, map): (&Vec<u32>, ComponentMap)| {
        let seams = map.seams.numbered_from(first_region);
        first_region += map.regions as u32;
        ComponentReport {
            landmarks: members.len() as u64,
            regions: map.regions as u64,
            pairs: members.iter().map(|&member| graph.of(member).len() as u64).sum::<u64>() / 2,
            stress1: map.stress1,
            iterations: map.iterations as u64,
            converged: map.converged,
            distances: map.distances,
            path_pull: map.path_pull,
            ranges: map.ranges,
            seams,
        }
    };
    let components: Vec<ComponentReport> = components.iter().zip(maps).map(component).collect();
    let pairs: u64 = components.iter().map(|component| component.pairs).sum();
    let squares: f64 = components.iter().map(|c| c.stress1 * c.stress1 * c.pairs as f64).sum();
    BuildReport {
        steps: counts.steps(),
        sightings: counts.sightings().iter().map(|&n| u64::from(n)).sum(),
        landmarks: counts.landmarks() as u64,
        pairs,
        regions: components.iter().map(|component| component.regions).sum(),
        stress1: (squares / pairs.max(1) as f64).sqrt(),
        honesty,
        update: None,
        warnings: warnings(counts, graph, honesty, landmarks, &components, log.names()),
        components,
    }
}

#[cfg(test)]
mod tests;
