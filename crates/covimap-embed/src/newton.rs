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
//! found once. A step is a solve and a few passes over the pairs.

mod normal_equations;

use crate::descent::{Descent, Objective, Reached};
use crate::forces::{Forces, PairLayout};
use crate::solve::{check_start, negligible_stress};
use crate::{EmbedError, Embedding, PairDistances, Point, StopRule};
pub(crate) use normal_equations::NormalEquations;

/// Damping of the first factor; each later one has a tenth of the last.
const FIRST_DAMPING: f64 = 1e-2;
/// Least damping: landmarks that their pairs hold in one direction only must not fly off.
const LEAST_DAMPING: f64 = 1e-4;

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
    curvature: Curvature,
    descent: Descent,
}

/// Eq. (1), and its factor.
struct Curvature {
    system: NormalEquations,
    /// Damping of the next factor.
    damping: f64,
}

impl Newton {
    /// Nothing is known as yet but which pairs there are. The ordering of the unknowns is found at the first step.
    #[must_use]
    pub fn new(pairs: &PairDistances) -> Self {
        let curvature = Curvature { system: NormalEquations::new(pairs), damping: FIRST_DAMPING };
        Self { curvature, descent: Descent::new() }
    }

    /// As [`newton`], but asks before every step whether to go on; if not, the result is what was
    /// reached, with [`Termination::Interrupted`](crate::Termination::Interrupted).
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
        go_on: impl FnMut() -> bool,
    ) -> Result<Embedding, EmbedError> {
        check_start(pairs, start)?;
        let distances = pairs.pairs().iter().map(|pair| pair.distance).collect();
        let curvature = &mut self.curvature;
        let mut stress = Stress { pairs, layout: PairLayout::new(pairs), distances, curvature };
        let start = start.as_flattened().to_vec();
        let Reached { x, iterations, termination } =
            self.descent.run(&mut stress, start, stop, negligible_stress(pairs), go_on)?;
        Ok(Embedding::of_distances(pairs, x.as_chunks().0.to_vec(), iterations, termination))
    }
}

/// The stress of a pair list, unknowns in the order `x_1 y_1 x_2 y_2 ..`.
struct Stress<'a> {
    pairs: &'a PairDistances,
    layout: PairLayout<'a>,
    distances: Vec<f64>,
    curvature: &'a mut Curvature,
}

impl Objective for Stress<'_> {
    const LIFETIME: usize = 20;

    fn at(&self, x: &[f64]) -> (f64, Vec<f64>) {
        let Forces { stress, forces } = self.layout.forces(x.as_chunks().0, &self.distances);
        (stress, forces.into_flattened())
    }

    fn renew(&mut self, x: &[f64]) -> Result<(), EmbedError> {
        let Curvature { system, damping } = &mut *self.curvature;
        system.factor(self.pairs, x.as_chunks().0, *damping)?;
        *damping = (*damping / 10.0).max(LEAST_DAMPING);
        Ok(())
    }

    fn precondition(&self, v: &mut [f64]) {
        self.curvature.system.solve(v.as_chunks_mut::<1>().0);
    }
}

#[cfg(test)]
mod tests;
