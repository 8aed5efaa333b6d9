//! Which links are kept.
//!
//! A link of the [`Backbone`] is. Of the others, what speaks for a link is how unlikely its
//! count is by chance, `p_ij = P(X >= n_ij)` for a Poisson variable X of mean
//!
//! `lambda_ij = (n_i f_j + n_j f_i) / T`,  (2)
//!
//! and how many backbone partners the two landmarks share: the support. It is *distant* if they share
//! none, but a partner of one is a neighbour of a partner of the other. Chance links come from
//! anywhere, so that most of them have no support; true ones seldom do without. Links are therefore judged
//! apart for each support c. Among the `A_c` pairs with that support, linked or not, chance makes about
//! `A_c p` links whose count is as unlikely as p. The cut is the largest p at which those are at most
//! a given share of the links there are (Benjamini and Hochberg, 1995).
//!
//! `f_i` is the number of false sightings of landmark i: the mean over all landmarks, or what its own
//! unsupported links show if that is more beyond doubt.

use rayon::prelude::*;

use super::backbone::Backbone;
use super::poisson::ln_tail;
use crate::{CoVisibility, LandmarkId};

/// Share of chance links allowed among those kept: without support, with a distant one, and with common
/// partners. The nearer its ends are to each other, the less harm a false link does, and
/// the more is lost with a true one.
const FALSE_SHARES: [f64; 3] = [0.01, 0.1, 0.3];
/// Supports told apart: none, distant, 1, 2, ... common partners, and this less 1 or more.
const MOST_SUPPORT: usize = 8;
const SUPPORTS: usize = MOST_SUPPORT + 1;
/// Stands for the support of a link of the backbone.
const BACKBONE: u8 = u8::MAX;
/// Buckets of `-ln p`, and their number a unit.
const BUCKETS: usize = 512;
const PER_UNIT: f64 = 4.0;
/// Landmarks whose pairs are counted by support, evenly spread.
const SAMPLE: usize = 2048;

/// For every landmark, which links of its row are kept.
pub(super) type Kept = Vec<Box<[bool]>>;

/// Judges all links; `x` is the error rate of [`super::error_rate`], `> 0`.
///
/// `O(m k)` for `m` links and steps of `k` landmarks, in parallel by rows; a byte for each end of a
/// link.
pub(super) fn judge(counts: &CoVisibility, backbone: &Backbone, x: f64) -> Kept {
    let supports = supports(counts, backbone);
    let judge = Judge { counts, false_sightings: false_sightings(counts, &supports, x) };
    let cuts = judge.cuts(&supports, pairs_by_support(backbone, counts.landmarks()));
    let rows = supports.par_iter().enumerate();
    rows.map(|(i, supports)| {
        let kept = |(&support, bucket): (&u8, usize)| support == BACKBONE || bucket >= cuts[support as usize];
        supports.iter().zip(judge.buckets(i as u32)).map(kept).collect()
    })
    .collect()
}

/// Landmarks around one landmark of the backbone.
struct Around {
    /// Bits of every landmark; zero between landmarks.
    marks: Vec<u8>,
    marked: Vec<u32>,
}

/// A partner.
const PARTNER: u8 = 1;
/// A neighbour: a partner, or one whose partner it is.
const NEIGHBOUR: u8 = 2;
/// A neighbour of a partner.
const SECOND: u8 = 4;

impl Around {
    fn new(landmarks: usize) -> Self {
        Self { marks: vec![0; landmarks], marked: Vec::new() }
    }

    fn mark(&mut self, landmark: u32, bit: u8) {
        let marks = &mut self.marks[landmark as usize];
        if *marks == 0 {
            self.marked.push(landmark);
        }
        *marks |= bit;
    }

    fn centre_on(&mut self, backbone: &Backbone, i: u32) {
        for landmark in self.marked.drain(..) {
            self.marks[landmark as usize] = 0;
        }
        for &k in backbone.partners.of(i) {
            self.mark(k, PARTNER);
            backbone.neighbours(k).for_each(|second| self.mark(second, SECOND));
        }
        backbone.neighbours(i).for_each(|k| self.mark(k, NEIGHBOUR));
    }

    /// Support of a link of the centre with landmark j.
    fn support(&self, backbone: &Backbone, j: u32) -> u8 {
        if self.marks[j as usize] & NEIGHBOUR != 0 {
            return BACKBONE;
        }
        let (mut common, mut distant) = (0, 0);
        for &k in backbone.partners.of(j) {
            let marks = self.marks[k as usize];
            common += usize::from(marks & PARTNER != 0);
            distant |= usize::from(marks & SECOND != 0);
        }
        if common > 0 { MOST_SUPPORT.min(common + 1) as u8 } else { distant as u8 }
    }
}

/// Support of every link, by rows.
fn supports(counts: &CoVisibility, backbone: &Backbone) -> Vec<Box<[u8]>> {
    let n = counts.landmarks();
    let row = |around: &mut Around, i: u32| {
        around.centre_on(backbone, i);
        counts.row(LandmarkId(i)).0.iter().map(|&j| around.support(backbone, j)).collect()
    };
    (0..n as u32).into_par_iter().map_init(|| Around::new(n), row).collect()
}

/// `f_i` of every landmark.
///
/// The unsupported links of landmark i count `C_i = f_i S / T + n_i F / T` in the mean. Its own rate
/// counts if it lies two standard deviations above the mean one.
fn false_sightings(counts: &CoVisibility, supports: &[Box<[u8]>], x: f64) -> Vec<f64> {
    let steps = counts.steps() as f64;
    let all: f64 = counts.sightings().iter().map(|&n| f64::from(n)).sum();
    let mean = x * steps;
    let of_all = mean * counts.landmarks() as f64;
    let rows = supports.par_iter().enumerate();
    rows.map(|(i, supports)| {
        let (_, together) = counts.row(LandmarkId(i as u32));
        let unsupported = supports.iter().zip(together).filter(|(support, _)| **support == 0);
        let unsupported: u64 = unsupported.map(|(_, &both)| u64::from(both)).sum();
        let own = (steps * unsupported as f64 - f64::from(counts.sightings()[i]) * of_all) / all;
        mean.max(own - 2.0 * own.max(0.0).sqrt())
    })
    .collect()
}

/// `A_c` where there is support, and all pairs where there is none: nearly all of them have none.
fn pairs_by_support(backbone: &Backbone, landmarks: usize) -> [f64; SUPPORTS] {
    let rows: Vec<u32> = (0..landmarks as u32).step_by(landmarks.div_ceil(SAMPLE)).collect();
    let sampled = rows.len() as f64;
    let count = |(around, candidates): &mut (Around, Vec<u32>), i: u32| {
        around.centre_on(backbone, i);
        let near = around.marked.iter().filter(|&&k| around.marks[k as usize] & (PARTNER | SECOND) != 0);
        candidates.clear();
        candidates.extend(near.flat_map(|&k| backbone.partner_of.of(k)).filter(|&&j| j != i));
        candidates.sort_unstable();
        candidates.dedup();
        let mut pairs = [0u64; SUPPORTS];
        for &j in candidates.iter() {
            let support = around.support(backbone, j);
            if support != BACKBONE {
                pairs[support as usize] += 1;
            }
        }
        pairs
    };
    let seen_from_both = rows
        .into_par_iter()
        .map_init(|| (Around::new(landmarks), Vec::new()), count)
        .reduce(Default::default, |a, b| std::array::from_fn(|c| a[c] + b[c]));
    let n = landmarks as f64;
    let mut pairs = seen_from_both.map(|pairs| 0.5 * pairs as f64 * n / sampled);
    pairs[0] = 0.5 * n * (n - 1.0);
    pairs
}

struct Judge<'a> {
    counts: &'a CoVisibility,
    /// `f_i`.
    false_sightings: Vec<f64>,
}

impl Judge<'_> {
    /// Bucket of `-ln p` of every link of a row.
    fn buckets(&self, i: u32) -> impl Iterator<Item = usize> {
        let (partners, together) = self.counts.row(LandmarkId(i));
        let sightings = self.counts.sightings();
        let steps = self.counts.steps() as f64;
        partners.iter().zip(together).map(move |(&j, &both)| {
            let [i, j] = [i, j].map(|landmark| landmark as usize);
            let here = f64::from(sightings[i]) * self.false_sightings[j];
            let there = f64::from(sightings[j]) * self.false_sightings[i];
            let surprise = -ln_tail(both, (here + there) / steps);
            ((PER_UNIT * surprise) as usize).min(BUCKETS - 1)
        })
    }

    /// The first bucket that is kept, for each support.
    fn cuts(&self, supports: &[Box<[u8]>], pairs: [f64; SUPPORTS]) -> [usize; SUPPORTS] {
        type Histogram = Vec<[u64; BUCKETS]>;
        let none = || vec![[0; BUCKETS]; SUPPORTS];
        let add = |mut a: Histogram, b: Histogram| {
            a.iter_mut().flatten().zip(b.iter().flatten()).for_each(|(sum, more)| *sum += more);
            a
        };
        let rows = supports.par_iter().enumerate();
        let counted = rows.fold(none, |mut histogram, (i, supports)| {
            for (&support, bucket) in supports.iter().zip(self.buckets(i as u32)) {
                if support != BACKBONE {
                    histogram[support as usize][bucket] += 1;
                }
            }
            histogram
        });
        let histogram = counted.reduce(none, add);
        // Every link was counted from both its ends.
        let links = |support: usize| histogram[support].map(|links| 0.5 * links as f64);
        std::array::from_fn(|c| cut(&links(c), pairs[c], FALSE_SHARES[c.min(2)]))
    }
}

/// The lowest bucket from which on chance makes at most its share of the links.
fn cut(links: &[f64; BUCKETS], pairs: f64, share: f64) -> usize {
    let mut kept = 0.0;
    let mut cut = BUCKETS - 1;
    for bucket in (0..BUCKETS).rev() {
        kept += links[bucket];
        let p = (-(bucket as f64) / PER_UNIT).exp();
        if pairs * p <= share * kept {
            cut = bucket;
        }
    }
    cut
}

#[cfg(test)]
mod tests;
