//! Least stress of some objects among others that are held where they are.
//!
//! When little has changed in a large configuration, little has to move. The stress is minimised over the
//! objects that are free; those that are held take part with their distances only. Few objects move by little,
//! so that no matrix is factored: the direction is that of the limited-memory BFGS recursion over the
//! Gauss-Newton blocks of the single objects,
//!
//! `M_ii = sum_j w_ij [u u' + max(0, 1 - d/r) (I - u u')]`, `u = (x_i - x_j) / r`.  (1)
//!
//! # Complexity
//! `O(m)` a step for `m` pairs. The number of steps grows with the width of the free part, in links.

use crate::descent::{Descent, Objective, Reached};
use crate::forces::{Forces, PairLayout};
use crate::solve::{check_start, negligible_stress};
use crate::{EmbedError, Embedding, PairDistances, Point, StopRule};

/// Share of its trace that is added to a block: a pair alone says nothing of the direction across it.
const DAMPING: f64 = 1e-3;

/// Minimises the stress of `pairs` from `start` over the objects that are not `held`, and asks before every
/// step whether to go on; if not, the result is what was reached, with
/// [`Termination::Interrupted`](crate::Termination::Interrupted).
///
/// Objects that are held keep their places to the last bit. Converged is a configuration from which a step
/// along the plain blocks of eq. (1), and the next one, gain less than the tolerance.
///
/// # Errors
/// [`EmbedError::BadStart`] for a start, or a list of those held, that does not fit.
pub fn anchored_while(
    pairs: &PairDistances,
    start: &[Point],
    held: &[bool],
    stop: StopRule,
    go_on: impl FnMut() -> bool,
) -> Result<Embedding, EmbedError> {
    check_start(pairs, start)?;
    if held.len() != start.len() {
        let what = "it must be known of each object whether it is held";
        return Err(EmbedError::BadStart { what, found: held.len(), wanted: start.len() });
    }
    let distances = pairs.pairs().iter().map(|pair| pair.distance).collect();
    let mut free = Free { pairs, held, layout: PairLayout::new(pairs), distances, blocks: Vec::new() };
    let start = start.as_flattened().to_vec();
    let Reached { x, iterations, termination } =
        Descent::new().run(&mut free, start, stop, negligible_stress(pairs), go_on)?;
    Ok(Embedding::of_distances(pairs, x.as_chunks().0.to_vec(), iterations, termination))
}

/// The stress as a function of the objects that are free, unknowns in the order `x_1 y_1 x_2 y_2 ..`.
struct Free<'a> {
    pairs: &'a PairDistances,
    held: &'a [bool],
    layout: PairLayout<'a>,
    distances: Vec<f64>,
    /// Blocks of eq. (1), inverted: xx, xy, yy. Zero for objects that are held or have no pair.
    blocks: Vec<[f64; 3]>,
}

impl Objective for Free<'_> {
    const LIFETIME: usize = 30;

    fn at(&self, x: &[f64]) -> (f64, Vec<f64>) {
        let Forces { stress, mut forces } = self.layout.forces(x.as_chunks().0, &self.distances);
        forces.iter_mut().zip(self.held).filter(|(_, held)| **held).for_each(|(force, _)| *force = [0.0; 2]);
        (stress, forces.into_flattened())
    }

    fn renew(&mut self, x: &[f64]) -> Result<(), EmbedError> {
        let points: &[Point] = x.as_chunks().0;
        let mut blocks = vec![[0.0; 3]; points.len()];
        for pair in self.pairs.pairs() {
            let (i, j) = (pair.i as usize, pair.j as usize);
            let d = [points[i][0] - points[j][0], points[i][1] - points[j][1]];
            let r = d[0].hypot(d[1]);
            if r > 0.0 {
                let u = [d[0] / r, d[1] / r];
                let across = (1.0 - pair.distance / r).max(0.0);
                let along = 1.0 - across;
                for block in [i, j] {
                    blocks[block][0] += pair.weight * (along * u[0] * u[0] + across);
                    blocks[block][1] += pair.weight * along * u[0] * u[1];
                    blocks[block][2] += pair.weight * (along * u[1] * u[1] + across);
                }
            }
        }
        for (block, &held) in blocks.iter_mut().zip(self.held) {
            *block = if held { [0.0; 3] } else { inverse(*block) };
        }
        self.blocks = blocks;
        Ok(())
    }

    fn precondition(&self, v: &mut [f64]) {
        for ([xx, xy, yy], v) in self.blocks.iter().zip(v.chunks_exact_mut(2)) {
            let [x, y] = [v[0], v[1]];
            v[0] = xx * x + xy * y;
            v[1] = xy * x + yy * y;
        }
    }
}

/// Inverse of a damped symmetric block xx, xy, yy; zero for one without a pair.
fn inverse([xx, xy, yy]: [f64; 3]) -> [f64; 3] {
    let damping = DAMPING * (xx + yy);
    let (xx, yy) = (xx + damping, yy + damping);
    let determinant = xx * yy - xy * xy;
    if determinant > 0.0 { [yy, -xy, xx].map(|entry| entry / determinant) } else { [0.0; 3] }
}

#[cfg(test)]
mod tests;
