//! IDs that several landmarks bear.
//!
//! Two doors with the same number, or two shelves with the same label, look like one landmark that is in two
//! places. What is seen together with it then falls into bundles that have nothing to do with each other: no
//! member of the one is ever seen with a member of the other, and the way from one to the other over
//! sightings, without the ID in question, is long. A landmark in one place has its company around it, and the
//! company knows each other.
//!
//! Misread IDs do not look like that: they are scattered, and no company of theirs comes up again and again.
//! Nor do two parts of a log that nothing but one ID joins: there nothing says that they lie apart.
//!
//! Where the caller asks for it, every bundle becomes a landmark of its own, `A#1`, `A#2` and so on, the one with most sightings first;
//! every sighting goes to the bundle of which its step shows most.
//!
//! # Complexity
//! `O(n k^2)` for `n` landmarks with `k` partners each.

use rayon::prelude::*;
use rustc_hash::{FxHashMap, FxHashSet};

use crate::report::aliases_warning;
use crate::{CoVisibility, LandmarkId, MapError, Range, SightingLog, Warning};

/// Steps that must show two landmarks together: what is seen less often may be chance.
const FEWEST_STEPS: u32 = 3;
/// Members of a bundle, at least.
const FEWEST_MEMBERS: usize = 3;
/// Share of an ID's co-sightings that a bundle must have.
const SHARE: f64 = 0.1;
/// Sightings that lead from one bundle to the other, at least. The company of one landmark that a wall parts has
/// common neighbours round the end of the wall: two sightings. Places nearer than eight ranges pass unnoticed.
const APART: usize = 3;

/// An ID in several places.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Alias {
    pub landmark: LandmarkId,
    /// The company of each copy, ascending; the copy with most co-sightings first.
    pub bundles: Vec<Vec<u32>>,
}

/// All IDs that are in several places, in order.
pub(crate) fn find(counts: &CoVisibility) -> Vec<Alias> {
    let sightings = Sightings { counts, suspects: &[] };
    let is_suspect = |i: &u32| sightings.bundles(LandmarkId(*i)).len() > 1;
    let suspects: Vec<u32> = (0..counts.landmarks() as u32).into_par_iter().filter(is_suspect).collect();
    // An ID in two places would join the company of others.
    let sightings = Sightings { counts, suspects: &suspects };
    suspects.par_iter().filter_map(|&i| sightings.alias(LandmarkId(i))).collect()
}

/// Who was seen with whom often enough, without those under suspicion.
struct Sightings<'a> {
    counts: &'a CoVisibility,
    suspects: &'a [u32],
}

impl Sightings<'_> {
    fn alias(&self, landmark: LandmarkId) -> Option<Alias> {
        let bundles = self.bundles(landmark);
        let apart = |k: usize| self.are_apart(landmark, &bundles[k], &bundles[..k]);
        let is_alias = bundles.len() > 1 && (1..bundles.len()).all(apart);
        is_alias.then_some(Alias { landmark, bundles })
    }

    fn partners(&self, landmark: LandmarkId) -> impl Iterator<Item = u32> {
        let (partners, together) = self.counts.row(landmark);
        let often = partners.iter().zip(together).filter(|(_, both)| **both >= FEWEST_STEPS);
        often.map(|(partner, _)| *partner).filter(|partner| self.suspects.binary_search(partner).is_err())
    }

    /// The connected parts of a landmark's company that are large enough, the largest first.
    fn bundles(&self, landmark: LandmarkId) -> Vec<Vec<u32>> {
        let together = |&j: &u32| u64::from(self.counts.together(landmark, LandmarkId(j)));
        let co_sightings = |bundle: &[u32]| bundle.iter().map(together).sum::<u64>();
        let company: Vec<u32> = self.partners(landmark).collect();
        let all = co_sightings(&company) as f64;
        let mut bundles = self.parts(company);
        bundles.retain(|bundle| bundle.len() >= FEWEST_MEMBERS && co_sightings(bundle) as f64 >= SHARE * all);
        bundles.sort_by_key(|bundle| (std::cmp::Reverse(co_sightings(bundle)), bundle[0]));
        bundles
    }

    /// The parts into which landmarks fall by the sightings among themselves.
    fn parts(&self, mut left: Vec<u32>) -> Vec<Vec<u32>> {
        let mut parts = Vec::new();
        while let Some(first) = left.pop() {
            let mut part = vec![first];
            let mut next = 0;
            while next < part.len() && !left.is_empty() {
                for partner in self.partners(LandmarkId(part[next])) {
                    if let Ok(place) = left.binary_search(&partner) {
                        part.push(left.remove(place));
                    }
                }
                next += 1;
            }
            part.sort_unstable();
            parts.push(part);
        }
        parts
    }

    /// Whether a bundle can be reached from the others without the landmark, but only by a long way. The search goes
    /// from both ends, so that where there is no way the smaller side tells.
    fn are_apart(&self, without: LandmarkId, bundle: &[u32], others: &[Vec<u32>]) -> bool {
        let mut ends = [
            Reached::from(bundle.iter().copied(), without),
            Reached::from(others.iter().flatten().copied(), without),
        ];
        let mut steps = 0;
        while ends.iter().all(|end| !end.front.is_empty()) {
            let nearer = usize::from(ends[1].front.len() < ends[0].front.len());
            ends[nearer].step(|member| self.partners(member));
            steps += 1;
            let [a, b] = &ends;
            let (stepped, other) = if nearer == 0 { (a, b) } else { (b, a) };
            if stepped.front.iter().any(|member| other.known.contains(member)) {
                return steps >= APART;
            }
        }
        false
    }
}

/// What a search has reached.
struct Reached {
    known: FxHashSet<u32>,
    /// What the last step has reached.
    front: Vec<u32>,
}

impl Reached {
    fn from(start: impl Iterator<Item = u32>, without: LandmarkId) -> Self {
        let front: Vec<u32> = start.collect();
        Self { known: front.iter().copied().chain([without.0]).collect(), front }
    }

    fn step<P: Iterator<Item = u32>>(&mut self, partners: impl Fn(LandmarkId) -> P) {
        let next = self.front.iter().flat_map(|&member| partners(LandmarkId(member)));
        self.front = next.filter(|&member| self.known.insert(member)).collect();
    }
}

/// Says what was found.
pub(crate) fn warning(log: &SightingLog, aliases: &[Alias], split: bool) -> Warning {
    aliases_warning(aliases.iter().map(|alias| log.names().name(alias.landmark)), split)
}

/// The log with a name of its own for every copy.
pub(crate) fn split(log: &SightingLog, aliases: &[Alias]) -> Result<SightingLog, MapError> {
    let taken: FxHashSet<&str> = log.names().iter().collect();
    let names: Vec<Vec<String>> = aliases.iter().map(|alias| copies(log, alias, &taken)).collect();
    let step = |number: usize| {
        let seen = log.step(number);
        let name = |&i: &u32| match aliases.binary_search_by_key(&i, |alias| alias.landmark.0) {
            Ok(k) => names[k][aliases[k].copy_in(seen)].as_str(),
            Err(_) => log.names().name(LandmarkId(i)),
        };
        seen.iter().map(name).collect::<Vec<_>>()
    };
    let renamed = SightingLog::from_steps((0..log.steps()).map(step));
    if log.ranges().is_empty() {
        return Ok(renamed);
    }
    let numbers: FxHashMap<&str, u32> = renamed.names().iter().zip(0..).collect();
    let range = |range: &Range| {
        let seen = log.step(range.step);
        let place = seen.binary_search(&range.landmark).expect("a range is to what is seen (bug in covimap)");
        Range { landmark: numbers[step(range.step)[place]], ..*range }
    };
    let ranges = log.ranges().iter().map(range).collect();
    renamed.with_ranges(ranges)
}

impl Alias {
    /// The copy of whose company a step shows most, the first of equals.
    fn copy_in(&self, seen: &[u32]) -> usize {
        let shown = |k: usize| seen.iter().filter(|i| self.bundles[k].binary_search(i).is_ok()).count();
        (0..self.bundles.len()).rev().max_by_key(|&k| shown(k)).expect("two at least (bug in covimap)")
    }
}

/// `A#1`, `A#2` and so on, with more hashes if the log has such names already.
fn copies(log: &SightingLog, alias: &Alias, taken: &FxHashSet<&str>) -> Vec<String> {
    let name = log.names().name(alias.landmark);
    let with = |mark: &str| (1..=alias.bundles.len()).map(|k| format!("{name}{mark}{k}")).collect::<Vec<_>>();
    let mut mark = "#".to_owned();
    while with(&mark).iter().any(|copy| taken.contains(copy.as_str())) {
        mark.push('#');
    }
    with(&mark)
}

#[cfg(test)]
mod tests;
