//! Newton-like descent of the stress, for configurations that are right but for a smooth bend.
//!
//! Majorisation measures a step by `V`, in which turning one half of a long corridor against the
//! other is expensive although it changes no known distance; it needs a number of steps that
//! grows with the square of the length. The second derivative knows which distances a move really
//! changes. Per pair, with `u = (x_i - x_j) / r`, it is `w [u u' + (1 - d/r) (I - u u')]`; the
//! second term is negative for pairs that are too short and is dropped there, which keeps the sum
//! positive semidefinite. Damping adds `mu V (x) I`:
//!
//! `M = H + mu V (x) I`. (1)
//!
//! With noisy distances the dropped terms nearly cancel those kept, so that `M` is too stiff for
//! just the slow bends that are to be taken out: a step falls short by a factor of five or more.
//! Steps along `-M^-1 g` are therefore only the first approximation. What the last few steps did
//! to the gradient corrects it (the limited-memory BFGS recursion over `M^-1`), and
//! `M` itself is factored anew only when the configuration has moved far or the steps gain
//! nothing any more: a factor serves some twenty steps, each of which costs one solve.
//!
//! # Complexity
//! A sparse Cholesky factorisation of order `2 n` for every twenty steps or so; the ordering is
//! found once. A step is a solve and a few looks at the stress.
//!
//! # References
//! J. Nocedal, S. J. Wright, Numerical Optimization, 2nd ed., 2006, algorithms 7.4 and 3.1.

mod normal_equations;

use crate::limited_memory::{Memory, dot};
use crate::solve::{check_start, negligible_stress};
use crate::stress::raw_stress;
use crate::{EmbedError, Embedding, PairDistances, Point, StopRule, Termination};
pub(crate) use normal_equations::NormalEquations;

/// Damping of the first factor; each later one has a tenth of the last.
const FIRST_DAMPING: f64 = 1e-2;
/// Least damping: landmarks that their pairs hold in one direction only must not fly off.
const LEAST_DAMPING: f64 = 1e-4;
/// Steps that a factor serves.
const LIFETIME: usize = 20;
/// Share of the stress that a step must take away for the configuration to have moved far.
const FAR: f64 = 0.1;
/// Share of the decrease promised by the slope that a step must keep (Armijo's condition).
const KEPT: f64 = 1e-4;
/// Shortenings of a step before it is given up: by then it is below rounding.
const SHORTENINGS: usize = 20;

/// Minimises the stress of `pairs` from `start`.
///
/// Every connected component stays about where its start was. Objects that coincide at the start
/// rest on each other as in [`smacof`](crate::smacof()).
///
/// # Errors
/// [`EmbedError::BadStart`] for a start that does not fit; [`EmbedError::Singular`] where the
/// weights are too different in size for the matrix to be factored; [`EmbedError::OutOfMemory`]
/// where the factor does not fit into memory.
pub fn newton(pairs: &PairDistances, start: &[Point], stop: StopRule) -> Result<Embedding, EmbedError> {
    Newton::new(pairs).minimise(pairs, start, stop, || true)
}

/// What a descent knows of the curvature, kept for another one over the same pairs: distances and weights
/// may change from one to the next, as long as they change little.
pub struct Newton {
    system: NormalEquations,
    memory: Memory,
    /// Damping of the next factor.
    damping: f64,
    /// Steps taken with the present factor; from [`LIFETIME`] on it is to be renewed.
    age: usize,
}

impl Newton {
    /// Nothing is known as yet but which pairs there are. The ordering of the unknowns is found at the first step.
    #[must_use]
    pub fn new(pairs: &PairDistances) -> Self {
        let system = NormalEquations::new(pairs);
        Self { system, memory: Memory::default(), damping: FIRST_DAMPING, age: LIFETIME }
    }

    /// As [`newton`], but asks before every step whether to go on; if not, the result is what was
    /// reached, with [`Termination::Interrupted`].
    ///
    /// # Errors
    /// As [`newton`].
    ///
    /// # Panics
    /// If `pairs` are not as many as those given to [`Newton::new`].
    pub fn minimise(
        &mut self,
        pairs: &PairDistances,
        start: &[Point],
        stop: StopRule,
        mut go_on: impl FnMut() -> bool,
    ) -> Result<Embedding, EmbedError> {
        check_start(pairs, start)?;
        self.memory.clear();
        let negligible = negligible_stress(pairs);
        let mut here = Configuration::new(pairs, start.to_vec());
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
            self.refresh(pairs, &here)?;
            let gained = match descend(pairs, &here, &self.direction(&here)) {
                Some((next, step)) => {
                    let gained = here.stress - next.stress;
                    self.learn(step, &here, &next);
                    here = next;
                    gained
                }
                None => 0.0,
            };
            // That an aged model gains nothing may be the fault of the model.
            if gained <= stop.tolerance * here.stress {
                if self.age <= 1 {
                    break Termination::Converged;
                }
                self.expire();
            } else if gained > FAR * here.stress {
                self.expire();
            }
        };
        Ok(Embedding::of_distances(pairs, here.points, iterations, termination))
    }

    /// Renews the factor if its time is over.
    fn refresh(&mut self, pairs: &PairDistances, here: &Configuration) -> Result<(), EmbedError> {
        if self.age >= LIFETIME {
            self.system.factor(pairs, &here.points, self.damping)?;
            self.damping = (self.damping / 10.0).max(LEAST_DAMPING);
            self.memory.clear();
            self.age = 0;
        }
        Ok(())
    }

    fn expire(&mut self) {
        self.age = LIFETIME;
    }

    fn direction(&self, here: &Configuration) -> Vec<f64> {
        let downhill = here.gradient.iter().map(|g| -g).collect();
        self.memory.apply(downhill, |v, _| self.system.solve(v))
    }

    fn learn(&mut self, step: Vec<f64>, before: &Configuration, after: &Configuration) {
        let change = after.gradient.iter().zip(&before.gradient).map(|(a, b)| a - b).collect();
        self.memory.remember(step, change);
        self.age += 1;
    }
}

/// A configuration with its stress and the gradient of half of it.
struct Configuration {
    points: Vec<Point>,
    stress: f64,
    gradient: Vec<f64>,
}

impl Configuration {
    fn new(pairs: &PairDistances, points: Vec<Point>) -> Self {
        Self { stress: raw_stress(pairs, &points), gradient: half_gradient(pairs, &points), points }
    }
}

/// Goes along a direction as far as the stress falls enough, the whole step if it can: where that
/// leads, and the step taken. `None` if even a step at the edge of rounding does not lower the stress.
fn descend(
    pairs: &PairDistances,
    here: &Configuration,
    direction: &[f64],
) -> Option<(Configuration, Vec<f64>)> {
    // The stress is twice the function whose gradient is held.
    let slope = 2.0 * dot(direction, &here.gradient);
    let mut length = 1.0;
    for _ in 0..SHORTENINGS {
        let step: Vec<f64> = direction.iter().map(|s| length * s).collect();
        let points: Vec<Point> = here
            .points
            .iter()
            .zip(step.chunks_exact(2))
            .map(|(point, step)| [point[0] + step[0], point[1] + step[1]])
            .collect();
        let stress = raw_stress(pairs, &points);
        if stress <= here.stress + KEPT * length * slope {
            let gradient = half_gradient(pairs, &points);
            return Some((Configuration { points, stress, gradient }, step));
        }
        // The lowest point of the parabola through what is known.
        let lowest = -slope * length * length / (2.0 * (stress - here.stress - slope * length));
        let share = lowest / length;
        length *= if share.is_nan() { 0.1 } else { share.clamp(0.1, 0.5) };
    }
    None
}

/// Gradient of half the stress, unknowns in the order `x_1 y_1 x_2 y_2 ..`:
/// `sum_j w_ij (1 - d_ij / r_ij) (x_i - x_j)`.
fn half_gradient(pairs: &PairDistances, points: &[Point]) -> Vec<f64> {
    let mut gradient = vec![0.0; 2 * points.len()];
    for pair in pairs.pairs() {
        let (i, j) = (pair.i as usize, pair.j as usize);
        let offset = [points[i][0] - points[j][0], points[i][1] - points[j][1]];
        let r = (offset[0] * offset[0] + offset[1] * offset[1]).sqrt();
        if r > 0.0 {
            let pull = pair.weight * (1.0 - pair.distance / r);
            for (axis, along) in offset.into_iter().enumerate() {
                gradient[2 * i + axis] += pull * along;
                gradient[2 * j + axis] -= pull * along;
            }
        }
    }
    gradient
}

#[cfg(test)]
mod tests;
