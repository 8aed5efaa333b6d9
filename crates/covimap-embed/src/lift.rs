//! Lifting: a map that lies twisted gets two more dimensions, untwists in them, and is pressed flat again.
//!
//! Where a street lies twisted, what is beyond it is a mirror image of what it should be. In the plane no small move
//! mends that: everything beyond would have to pass through itself. With more dimensions it turns round, at no cost.
//! What makes it turn are pairs that a twist has laid over each other. Some of these have distances that are too long;
//! of most nothing is listed, but if two objects are never found together although each is looked at often, they are
//! probably some way apart.
//!
//! # Algorithm
//! Objects are points `x` of four dimensions: the two of the map, and two in which they start at random. Minimised is
//!
//! `sum w_ij (r_ij - d_ij)^2 + sum_unlisted v_ij max(0, b_ij - r_ij)^2 + mu sum w_i |z_i|^2`,  (1)
//!
//! `r_ij = |x_i - x_j|`, `b_ij` how far apart two objects at least seem to be that no pair lists, `w_i = sum_j w_ij`,
//! and `z_i` the two coordinates that are to go. The press `mu` is small at first, and rises by the same factor from
//! level to level until it leaves nothing of them. At each level, unlisted pairs that are near each other are looked
//! for anew, and some steps of [descent](crate::descent) are taken.
//!
//! # Preconditioner
//! `V + mu_0 diag(w_i)`, `V` the Laplacian of the weights and `mu_0` the least press, serves all coordinates and all
//! levels: one factor. What it takes from steps along the map is what bends the whole, which would hide the twists; the
//! steps of least stress that follow are for that. Only where the press outweighs the stiffness of all but near
//! neighbours is it the diagonal `(1 + mu) diag(w_i)` for the coordinates that are to go.
//!
//! The result is near a minimum of (1) and not of the stress: minimise that next.
//!
//! # Complexity
//! A sparse Cholesky factor of order `n`, and some hundred steps, each with a solve and one pass over the pairs.
//!
//! # Determinism
//! Every object sums over its own pairs, in fixed order: the same bits for any number of threads.
//!
//! # References
//! G. M. Crippen, "Conformational analysis by energy embedding", J. Comput. Chem. 3(4), 1982, for minimising in more
//! dimensions and pressing flat.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;

use crate::cholesky::SparseCholesky;
use crate::descent::{Descent, Objective, Reached};
use crate::laplacian::{components, tied_laplacian};
use crate::solve::check_start;
use crate::wide::wide;
use crate::{EmbedError, PairDistances, Point, StopRule, Termination};

mod near;
mod springs;

use near::too_near;
use springs::{Spring, Springs};

/// Most steps that [`lift`] takes.
pub const LIFT_STEPS: usize = LEVELS * AT_A_LEVEL.max_iterations;

/// Levels of the press.
const LEVELS: usize = 8;
/// How many of them, the first ones, have the least.
const FREE: usize = 3;
/// The least press, with which folds of any size cost next to nothing, and the most, under which nothing stays up.
const PRESS: [f64; 2] = [1e-3, 3.0];
/// The greatest press under which objects near each other move together in the dimensions that are to go.
const SOFT: f64 = 6e-3;
/// Steps at each level.
const AT_A_LEVEL: StopRule = StopRule { max_iterations: 20, tolerance: 1e-5 };
/// Greatest coordinate of the start in the dimensions that are to go, in mean distances.
const HEIGHT: f64 = 3.0;
/// Share of its weight that a bound has in eq. (1): walls keep near objects from being found together.
const BELIEVED: f64 = 0.3;

/// Objects of one parallel task.
const OBJECTS: usize = 256;

/// A point of the map, and its place in the dimensions that are to go.
type Lifted = [f64; 4];

/// What is believed of pairs that a list does not name.
pub trait Apart: Sync {
    /// How far apart two objects at least seem to be.
    fn bound(&self, i: u32, j: u32) -> Bound;

    /// A length that no bound exceeds.
    fn longest(&self) -> f64;
}

/// A lower bound of a distance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bound {
    /// `b_ij` of eq. (1), `>= 0`, in units of the map.
    pub distance: f64,
    /// Its weight as a distance, `> 0`; it counts with a share of that.
    pub weight: f64,
}

/// Untwists a map in four dimensions, and presses it flat again; the module says how.
///
/// Distances and weights are taken in single precision. `start` is a map that is right in the small, as one put together from local maps. `seed` decides which way up its
/// objects go at first. `go_on` is asked before every step, of which there are at most [`LIFT_STEPS`]; if it says no,
/// what was reached is pressed flat at once.
///
/// # Errors
/// [`EmbedError::BadStart`] for a start that does not fit; [`EmbedError::Singular`] and
/// [`EmbedError::OutOfMemory`] as from [`newton`](crate::newton()).
pub fn lift(
    pairs: &PairDistances,
    start: &[Point],
    apart: &impl Apart,
    seed: u64,
    mut go_on: impl FnMut() -> bool,
) -> Result<Vec<Point>, EmbedError> {
    check_start(pairs, start)?;
    if pairs.pairs().is_empty() {
        return Ok(start.to_vec());
    }
    let mut folded = Unfolding::of(pairs)?;
    let mut x = raised(pairs, start, seed);
    let rise = (PRESS[1] / PRESS[0]).powf(1.0 / (LEVELS - FREE) as f64);
    for level in 1..=LEVELS {
        folded.press = PRESS[0] * rise.powi(level.saturating_sub(FREE) as i32);
        folded.bounds = too_near(x.as_chunks().0, &folded.links, apart);
        let Reached { x: lower, termination, .. } =
            Descent::new().run(&mut folded, x, AT_A_LEVEL, 0.0, &mut go_on)?;
        x = lower;
        if termination == Termination::Interrupted {
            break;
        }
    }
    Ok(x.as_chunks().0.iter().map(|&[x, y, _, _]: &Lifted| [x, y]).collect())
}

/// The start with random coordinates in the other two dimensions.
fn raised(pairs: &PairDistances, start: &[Point], seed: u64) -> Vec<f64> {
    let mean = pairs.pairs().iter().map(|pair| pair.distance).sum::<f64>() / pairs.pairs().len() as f64;
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut up = || HEIGHT * mean * (2.0 * rng.random::<f64>() - 1.0);
    start.iter().flat_map(|&[x, y]| [x, y, up(), up()]).collect()
}

/// Eq. (1).
struct Unfolding {
    links: Springs,
    /// Of the unlisted pairs that are, or may soon be, nearer than they should be.
    bounds: Springs,
    /// `mu`.
    press: f64,
    /// `w_i`.
    weights: Vec<f64>,
    /// Of `V + mu_0 diag(w_i)`.
    factored: SparseCholesky<1>,
}

impl Unfolding {
    /// Of a list, without bounds and under the least press.
    fn of(pairs: &PairDistances) -> Result<Self, EmbedError> {
        let n = pairs.objects();
        let edges: Vec<_> = pairs.pairs().iter().map(|pair| (pair.i, pair.j, pair.weight)).collect();
        let mut weights = vec![0.0; n];
        for &(i, j, weight) in &edges {
            weights[i as usize] += weight;
            weights[j as usize] += weight;
        }
        let (component, _) = components(n, edges.iter().map(|&(i, j, _)| (i, j)));
        let mut matrix = tied_laplacian(n, &edges, &component);
        for (&diagonal, weight) in matrix.starts.iter().zip(&weights) {
            matrix.blocks[diagonal as usize][0][0] += PRESS[0] * weight;
        }
        Ok(Self {
            links: Springs::of_pairs(pairs),
            bounds: Springs::none(n),
            press: PRESS[0],
            weights,
            factored: SparseCholesky::new(&matrix)?,
        })
    }

    /// The share of one object in the value, and in half of the gradient.
    #[inline(always)]
    fn share(&self, x: &[Lifted], own: usize) -> (f64, Lifted) {
        let here = x[own];
        let [_, _, u, v] = here;
        let press = self.press * self.weights[own];
        let (mut value, mut force) = (press * (u * u + v * v), [0.0, 0.0, press * u, press * v]);
        let mut pull = |there: Lifted, r: f64, spring: &Spring| {
            let (length, weight) = (f64::from(spring.length), f64::from(spring.weight));
            let miss = r - length;
            value += 0.5 * weight * miss * miss;
            if r > 0.0 {
                let pull = weight * miss / r;
                force = std::array::from_fn(|k| force[k] + pull * (here[k] - there[k]));
            }
        };
        for spring in self.links.of(own) {
            let there = x[spring.to as usize];
            pull(there, length(here, there), spring);
        }
        for spring in self.bounds.of(own) {
            let there = x[spring.to as usize];
            let r = length(here, there);
            if r < f64::from(spring.length) {
                pull(there, r, spring);
            }
        }
        (value, force)
    }
}

impl Objective for Unfolding {
    // The weights stay.
    const LIFETIME: usize = usize::MAX;

    fn at(&self, x: &[f64]) -> (f64, Vec<f64>) {
        let x: &[Lifted] = x.as_chunks().0;
        let mut gradient = vec![[0.0; 4]; x.len()];
        let shares = |(first, forces): (usize, &mut [Lifted])| {
            wide(
                #[inline(always)]
                || {
                    let mut sum = 0.0;
                    for (own, force) in (first * OBJECTS..).zip(forces) {
                        let value;
                        (value, *force) = self.share(x, own);
                        sum += value;
                    }
                    sum
                },
            )
        };
        let values: Vec<f64> = gradient.par_chunks_mut(OBJECTS).enumerate().map(shares).collect();
        (values.iter().sum(), gradient.into_flattened())
    }

    fn renew(&mut self, _: &[f64]) -> Result<(), EmbedError> {
        Ok(())
    }

    fn precondition(&self, v: &mut [f64]) {
        let v: &mut [Lifted] = v.as_chunks_mut().0;
        if self.press <= SOFT {
            return self.factored.solve(v);
        }
        let mut flat: Vec<Point> = v.par_iter().with_min_len(OBJECTS).map(|&[x, y, ..]| [x, y]).collect();
        self.factored.solve(&mut flat);
        let stiff = 1.0 + self.press;
        v.par_iter_mut().zip(flat).zip(&self.weights).with_min_len(OBJECTS).for_each(
            |((v, [x, y]), weight)| {
                // An object without pairs rests.
                let up = if *weight > 0.0 { 1.0 / (stiff * weight) } else { 0.0 };
                *v = [x, y, up * v[2], up * v[3]];
            },
        );
    }
}

#[inline(always)]
fn length(a: Lifted, b: Lifted) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests;
