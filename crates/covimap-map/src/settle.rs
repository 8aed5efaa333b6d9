//! From a layout to the map of a component: least stress, and then the places where the log is most likely.
//!
//! The stress has more minima than one, and the one next to the layout may not be the least. A layout that went wrong
//! leaves much stress; sensors of a sharp range that went right leave less than .1. Where there
//! is more, the minimisation begins again, from the layout of a [`Network`], which does not fold. That second minimum
//! is taken if its stress is less, or if it [tells](crate::likelihood) clearly more of the log: in a crumpled map links may be
//! as long as they should while landmarks that were never seen together lie side by side. If even the better one is poor,
//! links may be no distances in a plane, and the layout of the network itself is the map if it tells more.

use covimap_embed::{
    EmbedError, Embedding, Newton, PairDistances, Point, StopRule, Termination, stress1, unfold,
};

use crate::component::{Basis, ComponentMap, Evidence};
use crate::distances::{self, Law, Measured};
use crate::likelihood::log_likelihood;
use crate::network::{self, Network};
use crate::places::refine;
use crate::progress::begin;
use crate::shape::Shape;
use crate::surveyor::Surveyor;
use crate::{LinkGraph, MapError, Observer, SeamsReport, Stage};

/// The polish before anything is learnt of the distances: the first law moves landmarks by more.
const ROUGH: StopRule = StopRule { max_iterations: 20, tolerance: 1e-3 };
/// The polish from one law to the next.
const A_FEW_STEPS: StopRule = StopRule { max_iterations: 6, tolerance: 1e-4 };
/// The polish of a network.
const OF_A_NETWORK: StopRule = StopRule { max_iterations: 200, tolerance: 1e-6 };
/// Stress-1 under a learnt law above which there may be a better minimum: Kruskal's "fair".
const FAIR: f64 = 0.1;
/// Stress-1 under a learnt law above which links may be no distances in a plane: Kruskal's "poor".
const POOR: f64 = 0.2;
/// Share of the log-likelihood by which a map tells more of the log than another.
const TELLING: f64 = 0.05;

/// Where a component is to be polished from.
pub(crate) struct Start {
    /// Positions in map units.
    pub points: Vec<Point>,
    pub shape: Shape,
    /// Whether folds were taken out under a learnt law.
    pub untwisted: bool,
}

/// Polishes and refines a connected component; it counts as one region.
pub(crate) fn settle(
    surveyor: &Surveyor,
    fixed: &PairDistances,
    evidence: &Evidence,
    start: Start,
) -> Result<ComponentMap, MapError> {
    let Surveyor { graph, distances, params, observer, .. } = *surveyor;
    let mut minimum = minimise(surveyor, fixed, start)?;
    if minimum.law.is_some() && minimum.stress1 > FAIR && network::pivots(graph.landmarks()) > 0 {
        minimum = reconsidered(surveyor, fixed, evidence, minimum)?;
    }
    let Minimum { points: least, law, measured, path_pull, network, iterations, converged, .. } = minimum;
    let (points, sensor) = if network || params.refine_iterations == 0 || graph.landmarks() < 3 {
        (least.clone(), None)
    } else {
        begin(Stage::Refine, Some(params.refine_iterations as u64), observer)?;
        let refined = refine(graph, evidence.sets, least.clone(), params.refine_iterations, observer)?;
        observer.finished(Stage::Refine);
        (refined.points, Some(refined.sensor))
    };
    let doubted = measured.as_ref().map_or(0.0, |measured| measured.doubted);
    Ok(ComponentMap {
        ranges: None,
        stress1: stress1(measured.as_ref().map_or(fixed, |measured| &measured.pairs), &points),
        iterations,
        converged,
        distances: distances.map(|distances| distances.report(law.as_ref(), doubted, &points)),
        region: vec![0; points.len()],
        regions: 1,
        branch_of: vec![0],
        seams: SeamsReport::default(),
        path_pull,
        network,
        points,
        basis: Basis { polished: least, law, sensor },
    })
}

/// Where a minimisation of the stress ended.
struct Minimum {
    points: Vec<Point>,
    /// Stress-1 of the links.
    stress1: f64,
    /// What the distances of the links were learnt to be; `None` for the fixed logarithm.
    law: Option<Law>,
    /// The links by that law.
    measured: Option<Measured>,
    path_pull: f64,
    network: bool,
    iterations: usize,
    converged: bool,
}

/// Rounds of learning, and the polish.
///
/// The distance function is learnt where links alone make the map: path lengths hold with the fixed one.
fn minimise(surveyor: &Surveyor, fixed: &PairDistances, start: Start) -> Result<Minimum, MapError> {
    let Surveyor { distances, params, observer, .. } = *surveyor;
    let Start { points, shape, untwisted } = start;
    let families = if shape.pull == 0.0 { params.distance.families() } else { Vec::new() };
    let (rough, rounds) =
        if untwisted { (0, distances::UNFOLDED_ROUNDS) } else { (ROUGH.max_iterations, distances::ROUNDS) };
    let steps = rough + rounds * A_FEW_STEPS.max_iterations;
    begin(Stage::Distances, (!families.is_empty()).then_some(steps as u64), observer)?;
    let mut start = shape.start(fixed, points)?;
    let terms = shape.terms(fixed)?;
    let mut newton = Newton::new(&terms);
    let learning = distances.filter(|_| !families.is_empty());
    let mut law = None;
    if let Some(distances) = learning {
        if !untwisted {
            start = polish(&mut newton, fixed, &start, ROUGH, observer)?.points;
            start = unfold(fixed, &start)?.points;
        }
        let polish = |pairs: &_, start: &_| polish(&mut newton, pairs, start, A_FEW_STEPS, observer);
        (law, start) = distances.learn(start, &families, rounds, polish)?;
    }
    let measured = distances.zip(law.as_ref()).map(|(distances, law)| distances.measure(law, Some(&start)));
    observer.finished(Stage::Distances);

    begin(Stage::Polish, Some(params.polish_stop.max_iterations as u64), observer)?;
    let pairs = measured.as_ref().map_or(&*terms, |measured| &measured.pairs);
    let polished = polish(&mut newton, pairs, &start, params.polish_stop.rule(), observer)?;
    observer.finished(Stage::Polish);
    Ok(Minimum {
        stress1: stress1(measured.as_ref().map_or(fixed, |measured| &measured.pairs), &polished.points),
        points: polished.points,
        law,
        measured,
        path_pull: shape.pull,
        network: false,
        iterations: polished.iterations,
        converged: polished.termination == Termination::Converged,
    })
}

/// The better of a minimum and of the one next to the layout of the network, or that layout where it tells more.
fn reconsidered(
    surveyor: &Surveyor,
    fixed: &PairDistances,
    evidence: &Evidence,
    first: Minimum,
) -> Result<Minimum, MapError> {
    let Surveyor { graph, observer, .. } = *surveyor;
    begin(Stage::Polish, Some(OF_A_NETWORK.max_iterations as u64), observer)?;
    let Network { terms, pull, start } = Network::new(fixed)?;
    let polished = polish(&mut Newton::new(&terms), &terms, &start, OF_A_NETWORK, observer)?;
    observer.finished(Stage::Polish);
    let points = in_map_units(graph, polished.points)?;
    let again = Start { points: points.clone(), shape: Shape::FREE, untwisted: false };
    let second = minimise(surveyor, fixed, again)?;
    let paths = Minimum {
        stress1: stress1(fixed, &points),
        points,
        law: None,
        measured: None,
        path_pull: pull,
        network: true,
        iterations: polished.iterations,
        converged: polished.termination == Termination::Converged,
    };
    let tells = |a: &Minimum, b: &Minimum| {
        let [a, b] = [a, b].map(|it| log_likelihood(evidence.counts, evidence.members, &it.points));
        a > (1.0 - TELLING) * b
    };
    let better = if second.stress1 < first.stress1 || tells(&second, &first) { second } else { first };
    Ok(if better.stress1 > POOR && tells(&paths, &better) { paths } else { better })
}

/// The points in the scale `sum w d r / sum w r^2` that fits the distances of the links best.
///
/// # Errors
/// [`EmbedError::CoincidingPoints`] where all links have length 0.
pub(crate) fn in_map_units(graph: &LinkGraph, points: Vec<Point>) -> Result<Vec<Point>, EmbedError> {
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

/// Least stress over all terms, from a start.
fn polish(
    newton: &mut Newton,
    pairs: &PairDistances,
    start: &[Point],
    stop: StopRule,
    observer: &dyn Observer,
) -> Result<Embedding, MapError> {
    let polished = newton.minimise(pairs, start, stop, || {
        observer.advanced(1);
        !observer.interrupted()
    })?;
    if polished.termination == Termination::Interrupted { Err(MapError::Interrupted) } else { Ok(polished) }
}
