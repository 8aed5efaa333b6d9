//! The distance function of a log: learnt from the map that it makes.
//!
//! Regions, stitching and the first polish need distances before anything is known of the sensor,
//! and take the paper's logarithm. Their map shows how frequencies really fall with distance. So
//! a curve is fitted to it, the map is polished with the distances of that curve, and again:
//! alternating least squares, as in non-metric scaling, with a curve that is fitted to counts.
//!
//! # Algorithm
//! A few rounds of
//! 1. every family ([`covimap_embed::DistanceFamily`]) is fitted to the counts of either half of the
//!    time - alternate blocks of steps - at the distances of the present map, and judged by the
//!    likelihood of the counts of the other half ([`choice`]). Not by stress: a curve that
//!    collapses has none;
//! 2. the best one turns frequencies into distances, scaled so that their size stays;
//! 3. weights are the inverse variance of these distances, less where a wall seems to be between
//!    the two landmarks ([`weights`]);
//! 4. the polish, from the present map.
//!
//! # Complexity
//! One pass over the log to count 40 000 sampled links, `O(links)` a round, and the polish.
//!
//! # Failure
//! A component with fewer than three links a landmark has no report and keeps the logarithm. So does one
//! whose landmarks are not seen together in both halves of the time, or all equally often; its report
//! says that nothing was learnt.
//!
//! # References
//! F. W. Young, "Quantitative analysis of qualitative data", Psychometrika 46, 1981.

mod choice;
mod counts;
mod shepard;
mod steps;
mod weights;

use covimap_embed::{
    DistanceCurve, DistanceFamily, DistanceFunction, Embedding, Pair, PairDistances, Point,
    StretchedExponential, unfold,
};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::links::ALPHA;
use crate::params::DistanceChoice;
use crate::{CoVisibility, LinkGraph, MapError};
pub use choice::FamilyScore;
use choice::choose;
use counts::{PairCount, Sample};
pub use shepard::ShepardRow;
pub(crate) use steps::{ComponentSteps, Membership};
use weights::Trust;

/// Rounds of fitting and polishing: more move the map by less than the noise of the counts.
const ROUNDS: usize = 3;
/// Links a landmark that a fit asks for: half as many again as coordinates.
const LINKS_A_LANDMARK: usize = 3;
/// A pair that keeps less of its weight is doubted.
const HALF: f64 = 0.5;

/// What a component's map says of frequency and distance.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct DistanceReport {
    /// Whether the curve was learnt from the log; otherwise it is the paper's logarithm.
    pub learnt: bool,
    /// The curve, in map units; a learnt one is fitted to the finished map.
    pub curve: DistanceCurve,
    /// How well every family that was tried foretells counts held out.
    pub scores: Vec<FamilyScore>,
    /// Number of pairs that all this was learnt from.
    pub sample: u64,
    /// How many steps tell as much as one independent look.
    pub repetition: f64,
    /// How far a pair is from the curve, counts apart, map units; 0 for a curve that was not learnt.
    pub misfit: f64,
    /// Share of the pairs that keep less than half of their weight, because they look farther apart
    /// than they can be: walls.
    pub doubted: f64,
    /// Frequency against distance, the highest frequencies first.
    pub shepard: Vec<ShepardRow>,
}

/// What a log tells of the links of one component.
pub(crate) struct Distances<'a> {
    graph: &'a LinkGraph,
    counts: Vec<PairCount>,
    sample: Sample,
    repetition: f64,
}

/// A curve in use.
struct Fit {
    curve: DistanceCurve,
    scores: Vec<FamilyScore>,
    misfit: f64,
    doubted: f64,
}

/// A polished map, the problem it solves, and the curve that made its distances.
pub(crate) struct Alternated {
    pub embedding: Embedding,
    pub pairs: PairDistances,
    fit: Option<Fit>,
}

impl<'a> Distances<'a> {
    /// Counts the links of a component; `members[k]` is what the counts call landmark `k` of its graph.
    /// `None` if there are too few of them to learn from.
    pub fn new(
        graph: &'a LinkGraph,
        counts: &CoVisibility,
        members: &[u32],
        steps: &ComponentSteps,
        seed: u64,
    ) -> Option<Self> {
        if graph.link_count() < LINKS_A_LANDMARK * graph.landmarks() {
            return None;
        }
        let sample = Sample::draw(graph, steps, seed);
        let repetition = sample.repetition();
        Some(Self { graph, counts: counts::of_links(graph, counts, members), sample, repetition })
    }

    /// Alternates fit and polish, starting from the map of the fixed logarithm. Folds that learnt distances show
    /// are undone before the last polish, which is told that it is the last.
    pub fn alternate(
        &self,
        start: Alternated,
        choice: DistanceChoice,
        mut polish: impl FnMut(&PairDistances, &[Point], bool) -> Result<Embedding, MapError>,
    ) -> Result<Alternated, MapError> {
        let families = match choice {
            DistanceChoice::FixedLog => return Ok(start),
            DistanceChoice::Auto => DistanceFamily::ALL.to_vec(),
            DistanceChoice::Family(family) => vec![family],
        };
        let mut state = start;
        for round in 1..=ROUNDS {
            if round == ROUNDS {
                state.embedding.points = unfold(&state.pairs, &state.embedding.points)?.points;
            }
            let points = &state.embedding.points;
            let chosen = choose(&families, &self.sample, &self.sampled_lengths(points), self.repetition);
            let Some((curve, scores)) = chosen.filter(|(curve, _)| self.has_extent(curve)) else { break };
            let (pairs, fit) = self.measure(curve, scores, &state);
            let embedding = polish(&pairs, points, round == ROUNDS)?;
            state = Alternated { embedding, pairs, fit: Some(fit) };
        }
        Ok(state)
    }

    /// Distances and weights under a curve, in the place of those of the present map.
    fn measure(
        &self,
        curve: DistanceCurve,
        scores: Vec<FamilyScore>,
        present: &Alternated,
    ) -> (PairDistances, Fit) {
        let points = &present.embedding.points;
        let trust = Trust::learn(&curve, self.repetition, &self.sampled(points));
        let stretch = self.stretch(&curve);
        let measure = |(pair, count): (&Pair, &PairCount)| {
            let (weight, kept) = trust.weight(&curve, *count, length(points, [pair.i, pair.j]));
            let distance = stretch * curve.distance(count.frequency());
            (Pair { distance, weight: weight * kept, ..*pair }, kept < HALF)
        };
        let (pairs, doubted): (Vec<Pair>, Vec<bool>) =
            present.pairs.pairs().par_iter().zip(&self.counts).map(measure).unzip();
        let doubted = doubted.iter().filter(|doubted| **doubted).count() as f64 / pairs.len() as f64;
        let pairs = PairDistances::new(self.graph.landmarks(), pairs)
            .expect("distances of counts are finite and weights positive (bug in covimap)");
        (pairs, Fit { curve: curve.scaled(stretch), scores, misfit: stretch * trust.misfit, doubted })
    }

    /// Whether most links have a length under a curve. They have none where all frequencies are about equal.
    fn has_extent(&self, curve: &DistanceCurve) -> bool {
        let lengths = self.sample.links.iter().map(|&link| curve.distance(self.counts[link].frequency()));
        2 * lengths.filter(|length| *length > 0.0).count() > self.sample.len()
    }

    /// Factor that gives the distances of a curve the size of those of the fixed logarithm.
    fn stretch(&self, curve: &DistanceCurve) -> f64 {
        let fixed = fixed_log();
        let (mut wanted, mut found) = (0.0, 0.0);
        for count in self.sample.links.iter().map(|&link| self.counts[link]) {
            let weight = f64::from(count.together).sqrt();
            wanted += weight * fixed.distance(count.frequency()).powi(2);
            found += weight * curve.distance(count.frequency()).powi(2);
        }
        (wanted / found).sqrt()
    }

    /// The report on the finished map.
    pub fn report(&self, alternated: &Alternated, points: &[Point]) -> DistanceReport {
        let (curve, fit) = match &alternated.fit {
            Some(fit) => {
                let lengths = self.sampled_lengths(points);
                let again = choose(&[fit.curve.family()], &self.sample, &lengths, self.repetition);
                (again.map_or_else(|| fit.curve.clone(), |(curve, _)| curve), Some(fit))
            }
            None => (fixed_log(), None),
        };
        DistanceReport {
            learnt: fit.is_some(),
            scores: fit.map_or_else(Vec::new, |fit| fit.scores.clone()),
            sample: self.sample.len() as u64,
            repetition: self.repetition,
            misfit: fit.map_or(0.0, |fit| fit.misfit),
            doubted: fit.map_or(0.0, |fit| fit.doubted),
            shepard: shepard::diagram(&curve, &self.sampled(points)),
            curve,
        }
    }

    /// Counts and distances in the map of the sampled pairs.
    fn sampled(&self, points: &[Point]) -> Vec<(PairCount, f64)> {
        let counts = self.sample.links.iter().map(|&link| self.counts[link]);
        counts.zip(self.sampled_lengths(points)).collect()
    }

    fn sampled_lengths(&self, points: &[Point]) -> Vec<f64> {
        self.sample.ends.iter().map(|&ends| length(points, ends)).collect()
    }
}

impl Alternated {
    /// The map of the fixed logarithm.
    pub fn fixed(embedding: Embedding, pairs: PairDistances) -> Self {
        Self { embedding, pairs, fit: None }
    }
}

/// The paper's logarithm, by which links get their first distances.
fn fixed_log() -> DistanceCurve {
    DistanceCurve::Log(StretchedExponential { nearest: 1.0, length: ALPHA.sqrt(), exponent: 2.0 })
}

fn length(points: &[Point], [i, j]: [u32; 2]) -> f64 {
    let (a, b) = (points[i as usize], points[j as usize]);
    (a[0] - b[0]).hypot(a[1] - b[1])
}

#[cfg(test)]
mod tests;
