//! The maps of all components become landmarks and a report: where each is, and what holds it there.

use covimap_embed::Point;

use crate::component::ComponentMap;
use crate::report::warnings;
use crate::stitch::flatness;
use crate::{
    BuildReport, CoVisibility, ComponentReport, HonestyReport, LinkGraph, PlacedLandmark, SightingLog,
};

/// Least over greatest spread of the partners of a landmark below which they lie on a line.
const ON_A_LINE: f64 = 0.1;

/// The landmarks with their places; `members[k]` of a component is what the log calls its landmark `k`.
pub(crate) fn place(
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

/// What a build says about its map.
pub(crate) fn report(
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
            network: map.network,
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
