//! The distance function of a log: learnt from the map that it makes.
//!
//! Regions need distances before anything is known of the sensor, and take the paper's logarithm. A first curve is
//! fitted to their local maps, which are stitched; a rough polish takes the logarithm again. That map shows how
//! frequencies really fall with distance. So a curve is fitted to it, the map is polished with the distances of that
//! curve, and again: alternating least squares, as in non-metric scaling, with a curve that is fitted to counts.
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
//! 4. a few steps of the polish, from the present map.
//!
//! What made a part of the map a fold or a mirror image is a distance too long for the map around it. Its weight
//! falls from round to round, until the others can open the fold: rounds are worth more than a full polish in each.
//!
//! # Complexity
//! One pass over the log to count 40 000 sampled links, `O(links)` a round, and the steps.
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

use std::borrow::Cow;
use std::sync::Arc;

use covimap_embed::{
    Apart, Bound, DistanceCurve, DistanceFamily, DistanceFunction, Embedding, Pair, PairDistances, Point,
    StretchedExponential,
};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

use crate::links::ALPHA;
use crate::local_map::{self, LocalMap};
use crate::{CoVisibility, LinkGraph, MapError, RegionCover};
pub use choice::FamilyScore;
use choice::choose;
pub(crate) use counts::PairCount;
use counts::Sample;
pub use shepard::ShepardRow;
pub(crate) use steps::{ComponentSteps, Membership};
use weights::Trust;

/// Rounds of fitting and a few steps of the polish for a map that may be folded: with two, folds stay; more than five
/// change little.
pub(crate) const ROUNDS: usize = 5;
/// Rounds for a map without folds, which has no distances that are much too long.
pub(crate) const UNFOLDED_ROUNDS: usize = 3;
/// Links a landmark that a fit asks for: half as many again as coordinates.
const LINKS_A_LANDMARK: usize = 3;
/// Percentage of the links that no bound of unlinked landmarks exceeds.
const NEARLY_ALL: usize = 95;
/// Bounds of unlinked landmarks that are tabulated: those of landmarks of so many steps, together.
const TABULATED: u32 = 1 << 12;
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
    /// The links with the distances of the fixed logarithm.
    pairs: &'a PairDistances,
    /// Where the pairs of each landmark with later ones start, and at last their number.
    starts: Vec<usize>,
    counts: Vec<PairCount>,
    /// Steps that show each landmark.
    sightings: Vec<u32>,
    sample: Sample,
    repetition: f64,
}

/// How the distances of links follow from their counts.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub(crate) struct Law {
    curve: DistanceCurve,
    /// Factor that gives the distances of the curve the size of those of the fixed logarithm.
    stretch: f64,
    trust: Trust,
    scores: Vec<FamilyScore>,
}

/// The links of a component, measured.
pub(crate) struct Measured {
    pub pairs: PairDistances,
    /// Share of the pairs that keep less than half of their weight.
    pub doubted: f64,
}

/// What a law makes of landmarks that were never seen together: they are at least as far apart as if they had been seen
/// together half a time.
pub(crate) struct Unseen<'a> {
    law: &'a Law,
    sightings: Cow<'a, [u32]>,
    /// By the number of steps that show either landmark, as far as it goes.
    bounds: Arc<[Bound]>,
    longest: f64,
}

impl Unseen<'_> {
    /// The same of some landmarks, numbered by their places in the list.
    pub fn among(&self, members: &[u32]) -> Self {
        let sightings = members.iter().map(|&member| self.sightings[member as usize]).collect();
        Self { sightings, bounds: Arc::clone(&self.bounds), ..*self }
    }
}

/// The bound that a law sets to landmarks of which `either` steps show one and none shows both.
fn apart(law: &Law, either: u32, longest: f64) -> Bound {
    let (distance, weight, _) = law.measure(PairCount { together: 0, either }, f64::INFINITY);
    Bound { distance: distance.min(longest), weight }
}

impl Apart for Unseen<'_> {
    fn bound(&self, i: u32, j: u32) -> Bound {
        let either = self.sightings[i as usize] + self.sightings[j as usize];
        let known = self.bounds.get(either as usize).copied();
        known.unwrap_or_else(|| apart(self.law, either, self.longest))
    }

    fn longest(&self) -> f64 {
        self.longest
    }
}

impl Law {
    /// Distance and weight of a pair that lies `in_map` apart on the present map, and the share of the weight that
    /// doubts about walls have left.
    pub fn measure(&self, count: PairCount, in_map: f64) -> (f64, f64, f64) {
        let (weight, kept) = self.trust.weight(&self.curve, count, in_map);
        (self.stretch * self.curve.distance(count.frequency()), weight * kept, kept)
    }
}

impl<'a> Distances<'a> {
    /// Counts the links of a component, `pairs` being those of `graph`; `members[k]` is what the counts call
    /// landmark `k` of the graph. `None` if there are too few of them to learn from.
    pub fn new(
        graph: &LinkGraph,
        pairs: &'a PairDistances,
        counts: &CoVisibility,
        members: &[u32],
        steps: &ComponentSteps,
        seed: u64,
    ) -> Option<Self> {
        if graph.link_count() < LINKS_A_LANDMARK * graph.landmarks() {
            return None;
        }
        let sample = Sample::draw(pairs, steps, seed);
        let repetition = sample.repetition();
        let sightings = members.iter().map(|&member| counts.sightings()[member as usize]).collect();
        let mut starts = vec![0; graph.landmarks() + 1];
        pairs.pairs().iter().for_each(|pair| starts[pair.i as usize + 1] += 1);
        for i in 0..graph.landmarks() {
            starts[i + 1] += starts[i];
        }
        let counts = counts::of_links(graph, counts, members);
        Some(Self { pairs, starts, counts, sightings, sample, repetition })
    }

    /// The law that local maps ask for: in them no wrong turn of the whole makes distances wrong.
    pub fn learn_locally(
        &self,
        families: &[DistanceFamily],
        cover: &RegionCover,
        maps: &[LocalMap],
    ) -> Option<Law> {
        let lengths: Vec<Option<f64>> =
            self.sample.ends.iter().map(|&ends| local_map::length(cover, maps, ends)).collect();
        let (sample, lengths) = self.sample.told(&lengths);
        self.fit(families, &sample, &lengths)
    }

    /// Alternates fit and polish: the law, if there is one, and the positions that the rounds lead to.
    pub fn learn(
        &self,
        mut points: Vec<Point>,
        families: &[DistanceFamily],
        rounds: usize,
        mut polish: impl FnMut(&PairDistances, &[Point]) -> Result<Embedding, MapError>,
    ) -> Result<(Option<Law>, Vec<Point>), MapError> {
        let mut law = self.fit_to(families, &points);
        for _ in 0..rounds {
            let Some(present) = &law else { break };
            points = polish(&self.measure(present, Some(&points)).pairs, &points)?.points;
            law = self.fit_to(families, &points).or(law);
        }
        Ok((law, points))
    }

    /// The law that the map asks for.
    fn fit_to(&self, families: &[DistanceFamily], points: &[Point]) -> Option<Law> {
        self.fit(families, &self.sample, &self.sampled_lengths(points))
    }

    /// The law of a sample at known lengths. `None` where no family can be fitted or most links would have no
    /// length.
    fn fit(&self, families: &[DistanceFamily], sample: &Sample, lengths: &[f64]) -> Option<Law> {
        let (curve, scores) = choose(families, sample, lengths, self.repetition)?;
        let counts = sample.links.iter().map(|&link| self.counts[link]);
        let pairs: Vec<(PairCount, f64)> = counts.zip(lengths.iter().copied()).collect();
        let trust = Trust::learn(&curve, self.repetition, &pairs);
        let stretch = self.stretch(&curve);
        self.has_extent(&curve).then_some(Law { curve, stretch, trust, scores })
    }

    /// Distances and weights under a law of the links of `graph` among `members`, numbered by their places in that
    /// list; with a map of the members, what is too long for it is doubted.
    pub fn inside(
        &self,
        law: &Law,
        graph: &LinkGraph,
        members: &[u32],
        map: Option<&[Point]>,
    ) -> PairDistances {
        graph.restricted_to(members).to_pairs_with(|i, j| {
            let [own, other] = [i, j].map(|place| members[place as usize]);
            let first = self.starts[own as usize];
            let of_own = &self.pairs.pairs()[first..self.starts[own as usize + 1]];
            let place = of_own.binary_search_by_key(&other, |pair| pair.j);
            let link = first + place.expect("links of regions are links of the graph (bug in covimap)");
            let in_map = map.map_or(f64::INFINITY, |points| length(points, [i, j]));
            let (distance, weight, _) = law.measure(self.counts[link], in_map);
            (distance, weight)
        })
    }

    /// What a law makes of landmarks that were never seen together. They are taken to be no farther apart than nearly
    /// all of those that were.
    pub fn unseen<'b>(&'b self, law: &'b Law) -> Unseen<'b> {
        let sampled = self.sample.links.iter().map(|&link| self.counts[link]);
        let mut lengths: Vec<f64> =
            sampled.map(|count| law.stretch * law.curve.distance(count.frequency())).collect();
        lengths.sort_unstable_by(f64::total_cmp);
        let longest = lengths[(lengths.len() - 1) * NEARLY_ALL / 100];
        let bounds = (0..TABULATED).map(|either| apart(law, either, longest)).collect();
        Unseen { law, sightings: Cow::Borrowed(&self.sightings), bounds, longest }
    }

    /// Distances and weights of the links under a law; with a map, seen from that.
    pub fn measure(&self, law: &Law, points: Option<&[Point]>) -> Measured {
        let measure = |(pair, count): (&Pair, &PairCount)| {
            let in_map = points.map_or(f64::INFINITY, |points| length(points, [pair.i, pair.j]));
            let (distance, weight, kept) = law.measure(*count, in_map);
            (Pair { distance, weight, ..*pair }, kept < HALF)
        };
        let (pairs, doubted): (Vec<Pair>, Vec<bool>) =
            self.pairs.pairs().par_iter().zip(&self.counts).map(measure).unzip();
        let doubted = doubted.iter().filter(|doubted| **doubted).count() as f64 / pairs.len() as f64;
        let pairs = PairDistances::new(self.pairs.objects(), pairs)
            .expect("distances of counts are finite and weights positive (bug in covimap)");
        Measured { pairs, doubted }
    }

    /// Whether most links have a length under a curve. They have none where all frequencies are about equal.
    fn has_extent(&self, curve: &DistanceCurve) -> bool {
        let lengths = self.sample.links.iter().map(|&link| curve.distance(self.counts[link].frequency()));
        2 * lengths.filter(|length| *length > 0.0).count() > self.sample.len()
    }

    /// [`Law::stretch`] of a curve.
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

    /// The report on the finished map of a law, with the share of the pairs that were doubted under it.
    pub fn report(&self, law: Option<&Law>, doubted: f64, points: &[Point]) -> DistanceReport {
        let curve = law.map_or_else(fixed_log, |law| {
            let lengths = self.sampled_lengths(points);
            let again = choose(&[law.curve.family()], &self.sample, &lengths, self.repetition);
            again.map_or_else(|| law.curve.clone().scaled(law.stretch), |(curve, _)| curve)
        });
        DistanceReport {
            learnt: law.is_some(),
            scores: law.map_or_else(Vec::new, |law| law.scores.clone()),
            sample: self.sample.len() as u64,
            repetition: self.repetition,
            misfit: law.map_or(0.0, |law| law.stretch * law.trust.misfit),
            doubted,
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
