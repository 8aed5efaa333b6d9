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
//!
//! # References
//! J. Nocedal, S. J. Wright, Numerical Optimization, 2nd ed., 2006, algorithms 7.4 and 3.1.

use crate::forces::{Forces, PairLayout};
use crate::limited_memory::{Memory, dot};
use crate::solve::{check_start, negligible_stress};
use crate::{EmbedError, Embedding, PairDistances, Point, StopRule, Termination};

/// Steps that the blocks of eq. (1) serve.
const LIFETIME: usize = 30;
/// Share of the decrease promised by the slope that a step must keep (Armijo's condition).
const KEPT: f64 = 1e-4;
/// Shortenings of a step before it is given up: by then it is below rounding.
const SHORTENINGS: usize = 20;
/// Share of its trace that is added to a block: a pair alone says nothing of the direction across it.
const DAMPING: f64 = 1e-3;

/// Minimises the stress of `pairs` from `start` over the objects that are not `held`, and asks before every
/// step whether to go on; if not, the result is what was reached, with [`Termination::Interrupted`].
///
/// Objects that are held keep their places to the last bit. Converged is a configuration from which a step
/// along the plain blocks of eq. (1) gains less than the tolerance.
///
/// # Errors
/// [`EmbedError::BadStart`] for a start, or a list of those held, that does not fit.
pub fn anchored_while(
    pairs: &PairDistances,
    start: &[Point],
    held: &[bool],
    stop: StopRule,
    mut go_on: impl FnMut() -> bool,
) -> Result<Embedding, EmbedError> {
    check_start(pairs, start)?;
    if held.len() != start.len() {
        let what = "it must be known of each object whether it is held";
        return Err(EmbedError::BadStart { what, found: held.len(), wanted: start.len() });
    }
    let problem = Problem::new(pairs, held);
    let negligible = negligible_stress(pairs);
    let mut here = problem.at(start.to_vec());
    let (mut memory, mut blocks, mut age) = (Memory::default(), Vec::new(), LIFETIME);
    let mut iterations = 0;
    let termination = loop {
        if here.stress <= negligible {
            break Termination::Converged;
        }
        if iterations == stop.max_iterations {
            break Termination::IterationLimit;
        }
        if !go_on() {
            break Termination::Interrupted;
        }
        iterations += 1;
        if age >= LIFETIME {
            blocks = problem.blocks(&here.points);
            memory.clear();
            age = 0;
        }
        let downhill = here.gradient.iter().map(|g| -g).collect();
        let direction = memory.apply(downhill, |v, _| solve_blocks(&blocks, v));
        let mut gained = 0.0;
        if let Some((next, step)) = problem.descend(&here, &direction) {
            gained = here.stress - next.stress;
            let change = next.gradient.iter().zip(&here.gradient).map(|(a, b)| a - b).collect();
            memory.remember(step, change);
            here = next;
        }
        age += 1;
        // That aged blocks gain nothing may be the fault of the blocks.
        if gained <= stop.tolerance * here.stress {
            if age <= 1 {
                break Termination::Converged;
            }
            age = LIFETIME;
        }
    };
    Ok(Embedding::of_distances(pairs, here.points, iterations, termination))
}

struct Problem<'a> {
    pairs: &'a PairDistances,
    held: &'a [bool],
    layout: PairLayout<'a>,
    distances: Vec<f64>,
}

/// A configuration with its stress and the gradient of half of it, zero where objects are held.
struct Configuration {
    points: Vec<Point>,
    stress: f64,
    gradient: Vec<f64>,
}

impl<'a> Problem<'a> {
    fn new(pairs: &'a PairDistances, held: &'a [bool]) -> Self {
        let distances = pairs.pairs().iter().map(|pair| pair.distance).collect();
        Self { pairs, held, layout: PairLayout::new(pairs), distances }
    }

    fn at(&self, points: Vec<Point>) -> Configuration {
        let Forces { stress, mut forces } = self.layout.forces(&points, &self.distances);
        forces.iter_mut().zip(self.held).filter(|(_, held)| **held).for_each(|(force, _)| *force = [0.0; 2]);
        Configuration { points, stress, gradient: forces.into_flattened() }
    }

    /// Blocks of eq. (1), inverted: xx, xy, yy. Zero for objects that are held or have no pair.
    fn blocks(&self, points: &[Point]) -> Vec<[f64; 3]> {
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
        blocks
    }

    /// Goes along a direction as far as the stress falls enough, the whole step if it can. `None` if even a
    /// step at the edge of rounding does not lower the stress.
    fn descend(&self, here: &Configuration, direction: &[f64]) -> Option<(Configuration, Vec<f64>)> {
        // The stress is twice the function whose gradient is held.
        let slope = 2.0 * dot(direction, &here.gradient);
        let mut length = 1.0;
        for _ in 0..SHORTENINGS {
            let step: Vec<f64> = direction.iter().map(|s| length * s).collect();
            let moved = |(point, step): (&Point, &[f64])| [point[0] + step[0], point[1] + step[1]];
            let next = self.at(here.points.iter().zip(step.chunks_exact(2)).map(moved).collect());
            if next.stress <= here.stress + KEPT * length * slope {
                return Some((next, step));
            }
            // The lowest point of the parabola through what is known.
            let lowest = -slope * length / (2.0 * (next.stress - here.stress - slope * length));
            length *= if lowest.is_nan() { 0.1 } else { lowest.clamp(0.1, 0.5) };
        }
        None
    }
}

/// Inverse of a damped symmetric block xx, xy, yy; zero for one without a pair.
fn inverse([xx, xy, yy]: [f64; 3]) -> [f64; 3] {
    let damping = DAMPING * (xx + yy);
    let (xx, yy) = (xx + damping, yy + damping);
    let determinant = xx * yy - xy * xy;
    if determinant > 0.0 { [yy, -xy, xx].map(|entry| entry / determinant) } else { [0.0; 3] }
}

fn solve_blocks(blocks: &[[f64; 3]], v: &mut [f64]) {
    for ([xx, xy, yy], v) in blocks.iter().zip(v.chunks_exact_mut(2)) {
        let [x, y] = [v[0], v[1]];
        v[0] = xx * x + xy * y;
        v[1] = xy * x + yy * y;
    }
}

#[cfg(test)]
mod tests;
