//! How often landmarks are misread, told by pairs that are too far apart to be seen together.
//!
//! Let F of the S sightings of a log of T steps be false, each of a random one of N landmarks.
//! A landmark that shows in a step in which another one is misread gains a chance link. Two landmarks are
//! seen together by chance
//!
//! `lambda_ij = x (n_i + n_j)` times in the mean, with `x = F / (N T)`,  (1)
//!
//! wherever they stand. Landmarks a few steps apart on the [`Backbone`] are never seen together but
//! by chance, and most pairs of a large map are. Summed over them, `n_ij / (n_i + n_j)` is x.
//!
//! How many steps are too far shows in the log: the rate falls from shell to shell as long as
//! true links reach, and stays where only chance is left.

use rayon::prelude::*;

use super::backbone::Backbone;
use crate::{CoVisibility, LandmarkId};

/// Steps on the backbone within which pairs may be truly seen together: at least, and at most.
const NEAREST: usize = 3;
const FARTHEST: usize = 9;
/// The rate of a shell may be so many times that of all beyond it, or true links reach there.
const LEVEL: f64 = 2.0;
/// Landmarks whose far pairs are looked at, evenly spread.
const SAMPLE: usize = 2048;
/// Fewer false sightings than this (each shows in both its landmarks) are no rate.
const FEWEST_FALSE: f64 = 10.0;
/// A part of the backbone of fewer landmarks says nothing of what is far.
const SMALLEST_PART: u64 = 20;

/// Highest `x` of eq. (1) that the log allows: so many pairs would be linked by chance alone as are
/// linked at all. The share of unlinked pairs is the mean of `exp(-x n_i) exp(-x n_j)`.
pub(super) fn upper_bound(counts: &CoVisibility) -> f64 {
    let n = counts.landmarks() as f64;
    let unlinked = n * (n - 1.0) / 2.0 - counts.pair_count() as f64;
    let mut sightings = counts.sightings().to_vec();
    sightings.sort_unstable();
    let different: Vec<(f64, f64)> =
        sightings.chunk_by(|a, b| a == b).map(|equal| (f64::from(equal[0]), equal.len() as f64)).collect();
    let expected = |x: f64| {
        let [once, squared] = different.iter().fold([0.0; 2], |[once, squared], &(n_i, times)| {
            let e = (-x * n_i).exp();
            [once + times * e, squared + times * e * e]
        });
        0.5 * (once * once - squared)
    };
    // More than one false sighting a landmark and step is no error rate.
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        // Half a pair more, or a log without unlinked pairs would allow anything.
        if expected(middle) >= unlinked + 0.5 { low = middle } else { high = middle }
    }
    low
}

/// Pairs at the same number of steps on the backbone.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Shell {
    /// Sum of their `n_ij`.
    together: u64,
    /// Sum of their `n_i + n_j`.
    exposure: u64,
}

impl Shell {
    fn add(&mut self, together: u64, exposure: u64) {
        self.together += together;
        self.exposure += exposure;
    }

    fn plus(mut self, other: Self) -> Self {
        self.add(other.together, other.exposure);
        self
    }

    fn rate(self) -> f64 {
        self.together as f64 / self.exposure as f64
    }
}

/// Entry h: pairs h steps apart; the last one: all beyond.
type Shells = [Shell; FARTHEST + 2];

/// `x` of eq. (1); `None` where the log is too small or too thin to tell.
pub(super) fn estimate(counts: &CoVisibility, backbone: &Backbone) -> Option<f64> {
    let n = counts.landmarks();
    let in_large_part =
        |i: u32| backbone.parts[backbone.part[i as usize] as usize].landmarks >= SMALLEST_PART;
    if 2 * (0..n as u32).filter(|&i| in_large_part(i)).count() < n {
        return None;
    }
    let rows: Vec<u32> = (0..n as u32).step_by(n.div_ceil(SAMPLE)).filter(|&i| in_large_part(i)).collect();
    let shells = rows
        .into_par_iter()
        .map_init(|| Walk::new(n), |walk, i| walk.shells(counts, backbone, i))
        .reduce(Shells::default, |a, b| std::array::from_fn(|h| a[h].plus(b[h])));
    let far = far_pairs(&shells)?;
    let partners: u64 = (0..n as u32).flat_map(|i| counts.row(LandmarkId(i)).1).map(|&n| u64::from(n)).sum();
    let sightings: u64 = counts.sightings().iter().map(|&n| u64::from(n)).sum();
    let false_sightings = far.together as f64 * sightings as f64 / partners as f64;
    Some(if false_sightings < FEWEST_FALSE { 0.0 } else { far.rate() })
}

/// The pairs too far apart to be seen together; `None` if there are none with others beyond.
fn far_pairs(shells: &Shells) -> Option<Shell> {
    for nearest in NEAREST + 1..shells.len() - 1 {
        let beyond = shells[nearest + 1..].iter().fold(Shell::default(), |sum, &shell| sum.plus(shell));
        if beyond.exposure == 0 {
            return None;
        }
        if shells[nearest].rate() <= LEVEL * beyond.rate() {
            return Some(shells[nearest].plus(beyond));
        }
    }
    shells.last().copied().filter(|beyond| beyond.exposure > 0)
}

/// Breadth-first search over the backbone, from one landmark after another.
struct Walk {
    /// Steps from the start, plus 1; 0 is not reached.
    steps: Vec<u8>,
    reached: Vec<u32>,
}

impl Walk {
    fn new(landmarks: usize) -> Self {
        Self { steps: vec![0; landmarks], reached: Vec::new() }
    }

    fn reach(&mut self, backbone: &Backbone, start: u32) {
        for landmark in self.reached.drain(..) {
            self.steps[landmark as usize] = 0;
        }
        self.reached.push(start);
        self.steps[start as usize] = 1;
        let mut next = 0;
        while let Some(&landmark) = self.reached.get(next) {
            let step = self.steps[landmark as usize];
            if step as usize > FARTHEST {
                break;
            }
            for to in backbone.neighbours(landmark) {
                if self.steps[to as usize] == 0 {
                    self.steps[to as usize] = step + 1;
                    self.reached.push(to);
                }
            }
            next += 1;
        }
    }

    /// The pairs of one landmark with all others in its part.
    fn shells(&mut self, counts: &CoVisibility, backbone: &Backbone, start: u32) -> Shells {
        self.reach(backbone, start);
        let sightings = |i: u32| u64::from(counts.sightings()[i as usize]);
        let part = backbone.part[start as usize];
        let whole = backbone.parts[part as usize];
        let mut shells = Shells::default();
        let mut beyond = whole.landmarks * sightings(start) + whole.sightings;
        for &landmark in &self.reached {
            let exposure = sightings(start) + sightings(landmark);
            shells[self.steps[landmark as usize] as usize - 1].add(0, exposure);
            beyond -= exposure;
        }
        shells[FARTHEST + 1].add(0, beyond);
        let (partners, together) = counts.row(LandmarkId(start));
        for (&partner, &both) in partners.iter().zip(together) {
            if backbone.part[partner as usize] == part {
                let shell = match self.steps[partner as usize] {
                    0 => FARTHEST + 1,
                    steps => steps as usize - 1,
                };
                shells[shell].add(u64::from(both), 0);
            }
        }
        shells
    }
}

#[cfg(test)]
mod tests;
