//! Folds: places that were laid over themselves are turned round again.
//!
//! A descent of the stress goes to the nearest minimum. Where a few objects were laid down as
//! their mirror image - a start whose parts did not agree, a doorway crossed the wrong way - that
//! minimum is a fold: the distances across its edge are wrong, and no small move mends them. Folds
//! are small, and far above the usual in stress: so they can be found, and taken one by one.
//!
//! # Algorithm
//! 1. The *strain* of an object is the share of `sum w d^2` that is left as stress,
//!    `sum w (r - d)^2 / sum w d^2`, over the pairs of the object and of its neighbours. Where it is above
//!    [`UNUSUAL`] times the median, the object is a seed, those of greatest strain first.
//! 2. The seed and its neighbours, and again the nearer half of them, are mirrored about each of a few lines through
//!    their centre, and with all objects within two pairs of the seed moved to their nearest minimum while
//!    the rest is held. The pairs of these objects are all that changes.
//! 3. The best of these minima is taken if its stress is less than before by [`WORTHWHILE`].
//!
//! Seeds whose surroundings are apart are tried at the same time. Seeds next to what changed are tried
//! again, as a large fold is undone piece by piece.
//!
//! The objects move by majorisation, one after the other, each `1.6` times as far as its transform:
//!
//! `x_i <- x_i + 1.6 (sum_j w_ij (x_j + d_ij (x_i - x_j) / r_ij) / sum_j w_ij - x_i)`.  (1)
//!
//! The majorant is a circular bowl, so that no step below twice as far raises the stress.
//!
//! # Complexity
//! Two passes over the pairs to find the seeds; per seed some hundred sweeps over its surroundings. A map without
//! folds has few seeds.
//!
//! # Determinism
//! What a trial sees does not depend on trials that run at the same time: the same bits for any number of threads.

use rayon::prelude::*;

use crate::solve::check_start;
use crate::stress::{Incidence, distance};
use crate::{EmbedError, PairDistances, Point};

mod patch;

use patch::Patch;

/// Strain, over the median, from which on an object is a seed.
const UNUSUAL: f64 = 1.8;
/// Strain below which no place is looked at: distances are off by a thousandth.
const NEGLIGIBLE: f64 = 1e-6;
/// Share of the stress of its surroundings that a mirrored place must save. Distances that are a little wrong make
/// some mirror images look better by less.
const WORTHWHILE: f64 = 1e-2;
/// Lines about which is mirrored, evenly turned.
const LINES: usize = 4;
/// Times that the surroundings of what changed are looked at again.
const ROUNDS: usize = 3;

/// A map after [`unfold`].
#[derive(Debug, Clone, PartialEq)]
pub struct Unfolded {
    /// Where the objects are.
    pub points: Vec<Point>,
    /// Places where a mirrored neighbourhood was tried.
    pub tried: usize,
    /// Places where it was kept.
    pub mended: usize,
}

/// Mirrors small neighbourhoods of unusual stress, and keeps what lowers the stress of `pairs`.
///
/// `points` should be a minimum, as of [`newton`](crate::newton()): what is far from one is all unusual. The
/// stress of the result is not above that of `points`, and where nothing is mended the result equals
/// `points`. Around mended places it is near a minimum only: minimise once more.
///
/// # Errors
/// [`EmbedError::BadStart`] for points that do not fit the pairs.
pub fn unfold(pairs: &PairDistances, points: &[Point]) -> Result<Unfolded, EmbedError> {
    check_start(pairs, points)?;
    let incidence = Incidence::new(pairs);
    let mut unfolded = Unfolded { points: points.to_vec(), tried: 0, mended: 0 };
    let mut strains = strains(pairs, &incidence, points);
    let unusual = (UNUSUAL * median(&strains)).max(NEGLIGIBLE);
    let mut looked_at = vec![true; points.len()];
    for _ in 0..ROUNDS {
        let mut seeds: Vec<u32> = (0..points.len() as u32)
            .filter(|&object| looked_at[object as usize] && strains[object as usize] > unusual)
            .collect();
        seeds.sort_by(|&a, &b| strains[b as usize].total_cmp(&strains[a as usize]).then(a.cmp(&b)));
        looked_at.fill(false);
        if !pass(pairs, &incidence, &mut unfolded, seeds, &mut looked_at) {
            break;
        }
        strains = self::strains(pairs, &incidence, &unfolded.points);
    }
    Ok(unfolded)
}

/// Tries all seeds, marks what was moved, and tells whether anything was.
fn pass(
    pairs: &PairDistances,
    incidence: &Incidence,
    unfolded: &mut Unfolded,
    seeds: Vec<u32>,
    moved: &mut [bool],
) -> bool {
    let mended_before = unfolded.mended;
    let mut covered = vec![false; unfolded.points.len()];
    let mut claimed = vec![0; unfolded.points.len()];
    let mut batch = 0;
    let mut waiting: Vec<Patch> =
        seeds.par_iter().filter_map(|&seed| Patch::around(seed, incidence)).collect();
    while !waiting.is_empty() {
        batch += 1;
        // Patches that have an object in common wait for each other.
        let mut patches = Vec::new();
        let mut later = Vec::new();
        for patch in waiting {
            if covered[patch.seed() as usize] {
                continue;
            }
            let free = patch.objects().all(|object| claimed[object as usize] != batch);
            // Nothing of lesser strain may go before it either.
            patch.objects().for_each(|object| claimed[object as usize] = batch);
            if free {
                patch.core().for_each(|object| covered[object as usize] = true);
                patches.push(patch);
            } else {
                later.push(patch);
            }
        }
        waiting = later;
        unfolded.tried += patches.len();
        let points = &unfolded.points;
        let mended: Vec<Option<Vec<Point>>> =
            patches.par_iter().map(|patch| patch.mend(pairs, incidence, points)).collect();
        for (patch, places) in patches.iter().zip(mended) {
            let Some(places) = places else { continue };
            unfolded.mended += 1;
            for (object, place) in patch.free().zip(places) {
                unfolded.points[object as usize] = place;
                moved[object as usize] = true;
            }
        }
    }
    unfolded.mended > mended_before
}

/// The strain of every object; 0 where no pair is longer than 0.
fn strains(pairs: &PairDistances, incidence: &Incidence, points: &[Point]) -> Vec<f64> {
    let own = |object: usize| {
        incidence.of(object).iter().fold([0.0; 2], |[left, all], &(other, pair)| {
            let pair = pairs.pairs()[pair as usize];
            let miss = distance(points[object], points[other as usize]) - pair.distance;
            [left + pair.weight * miss * miss, all + pair.weight * pair.distance * pair.distance]
        })
    };
    let own: Vec<[f64; 2]> = (0..points.len()).into_par_iter().map(own).collect();
    let around = |object: usize| {
        let neighbours = incidence.of(object).iter().map(|&(other, _)| own[other as usize]);
        let [left, all] = neighbours.fold(own[object], |sum, own| [sum[0] + own[0], sum[1] + own[1]]);
        if all > 0.0 { left / all } else { 0.0 }
    };
    (0..points.len()).into_par_iter().map(around).collect()
}

/// The median; 0 of nothing.
fn median(values: &[f64]) -> f64 {
    let mut values = values.to_vec();
    let half = values.len() / 2;
    if values.is_empty() { 0.0 } else { *values.select_nth_unstable_by(half, f64::total_cmp).1 }
}

#[cfg(test)]
mod tests;
