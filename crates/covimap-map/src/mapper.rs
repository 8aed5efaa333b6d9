//! The pipeline: a log in, a [`GlobalMap`] out.

use covimap_embed::{PairDistances, Point, stress1};

use crate::classical;
use crate::component::{ComponentMap, Evidence, map_component, put_in_frame};
use crate::distances::{ComponentSteps, Membership};
use crate::places::SeenSets;
use crate::report::warnings;
use crate::{
    BuildReport, ClassicalParams, CoVisibility, ComponentReport, GlobalMap, LandmarkId, LinkGraph, MapError,
    MapperParams, Method, Observer, PlacedLandmark, SightingLog, Stage,
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
        check_information(&counts)?;
        let graph = LinkGraph::from_counts(&counts);
        let components = graph.components();
        let maps: Vec<ComponentMap> = match self.params.method {
            Method::Auto => self.auto_components(log, &counts, &graph, &components, observer)?,
            Method::Classical => components
                .iter()
                .map(|members| {
                    classical_component(&counts, &graph, members, &self.params.classical, observer)
                })
                .collect::<Result<_, MapError>>()?,
        };
        let report = report(&counts, &graph, &components, &maps, log);
        let landmarks = place(&counts, &graph, &components, &maps);
        GlobalMap::from_parts(log.names().clone(), landmarks, self.params.clone(), report)
    }

    fn auto_components(
        &self,
        log: &SightingLog,
        counts: &CoVisibility,
        graph: &LinkGraph,
        components: &[Vec<u32>],
        observer: &dyn Observer,
    ) -> Result<Vec<ComponentMap>, MapError> {
        let sets = SeenSets::by_component(log, components);
        let membership = Membership::new(graph.landmarks(), components);
        let steps = ComponentSteps::of_all(log, &membership, components.len());
        let map = |((members, sets), steps): ((&Vec<u32>, SeenSets), ComponentSteps)| {
            let evidence = Evidence { counts, members, steps: &steps, sets: &sets };
            let MapperParams { auto, seed, .. } = &self.params;
            let mut map = if members.len() == graph.landmarks() {
                map_component(graph, &evidence, auto, *seed, observer)?
            } else {
                map_component(&graph.restricted_to(members), &evidence, auto, *seed, observer)?
            };
            put_in_frame(&mut map.points);
            Ok(map)
        };
        components.iter().zip(sets).zip(steps).map(map).collect()
    }
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
    put_in_frame(&mut points);
    observer.finished(Stage::Classical);
    let pairs = paper_pairs(counts, graph, members, params);
    Ok(ComponentMap {
        stress1: stress1(&pairs, &points),
        region: vec![0; members.len()],
        points,
        regions: 1,
        iterations: 0,
        converged: true,
        distances: None,
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
    let nowhere = PlacedLandmark { position: [0.0; 2], component: 0, region: 0, sightings: 0, partners: 0 };
    let mut landmarks = vec![nowhere; graph.landmarks()];
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
            };
        }
        first_region += map.regions as u32;
    }
    landmarks
}

fn report(
    counts: &CoVisibility,
    graph: &LinkGraph,
    components: &[Vec<u32>],
    maps: &[ComponentMap],
    log: &SightingLog,
) -> BuildReport {
    let components: Vec<ComponentReport> = components
        .iter()
        .zip(maps)
        .map(|(members, map)| ComponentReport {
            landmarks: members.len() as u64,
            regions: map.regions as u64,
            pairs: members.iter().map(|&member| graph.of(member).len() as u64).sum::<u64>() / 2,
            stress1: map.stress1,
            iterations: map.iterations as u64,
            converged: map.converged,
            distances: map.distances.clone(),
        })
        .collect();
    let pairs: u64 = components.iter().map(|component| component.pairs).sum();
    let squares: f64 = components.iter().map(|c| c.stress1 * c.stress1 * c.pairs as f64).sum();
    BuildReport {
        steps: counts.steps(),
        sightings: counts.sightings().iter().map(|&n| u64::from(n)).sum(),
        landmarks: counts.landmarks() as u64,
        pairs,
        regions: components.iter().map(|component| component.regions).sum(),
        stress1: (squares / pairs.max(1) as f64).sqrt(),
        warnings: warnings(counts, graph, &components, log.names()),
        components,
    }
}

#[cfg(test)]
mod tests;
