//! What the iterative solvers share: when they stop, and what they hand back.

use serde::{Deserialize, Serialize};

use crate::stress::FitSums;
use crate::{EmbedError, PairDistances, Point};

/// When an iterative solver stops.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StopRule {
    /// Most steps, `>= 0`.
    pub max_iterations: usize,
    /// Converged when a step lowers the stress by less than this share of it, `>= 0`, or leaves
    /// nothing of it but rounding.
    pub tolerance: f64,
}

/// Why a solver stopped.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Termination {
    /// The tolerance was met.
    Converged,
    /// The limit of steps was reached first.
    IterationLimit,
    /// The caller asked to stop.
    Interrupted,
}

/// A configuration and how it was reached.
#[derive(Debug, Clone, PartialEq)]
pub struct Embedding {
    /// One point an object.
    pub points: Vec<Point>,
    /// Raw stress of `points`.
    pub stress: f64,
    /// Raw stress over `sum w d^2`, in `[0, 1]` at a minimum. Its root is what R's smacof, isoMDS
    /// and monoMDS call stress.
    pub normalised_stress: f64,
    /// Stress-1 of `points`.
    pub stress1: f64,
    /// Steps taken.
    pub iterations: usize,
    /// Why the solver stopped.
    pub termination: Termination,
}

impl Embedding {
    /// With the stresses that `sums` of `points` make.
    pub(crate) fn new(
        points: Vec<Point>,
        sums: FitSums,
        iterations: usize,
        termination: Termination,
    ) -> Self {
        Self {
            points,
            stress: sums.residual,
            normalised_stress: sums.normalised(),
            stress1: sums.stress1(),
            iterations,
            termination,
        }
    }

    /// Against the listed distances.
    pub(crate) fn of_distances(
        pairs: &PairDistances,
        points: Vec<Point>,
        iterations: usize,
        termination: Termination,
    ) -> Self {
        let sums = FitSums::new(pairs, |k| pairs.pairs()[k].distance, &points);
        Self::new(points, sums, iterations, termination)
    }
}

/// Stress that rounding alone makes: `1e-26 sum w d^2`, that is, distances right to 13 digits.
pub(crate) fn negligible_stress(pairs: &PairDistances) -> f64 {
    1e-26 * pairs.pairs().iter().map(|pair| pair.weight * pair.distance * pair.distance).sum::<f64>()
}

/// Refuses a start that is not one finite point an object.
pub(crate) fn check_start(pairs: &PairDistances, start: &[Point]) -> Result<(), EmbedError> {
    let bad = |what| EmbedError::BadStart { what, found: start.len(), wanted: pairs.objects() };
    if start.len() != pairs.objects() {
        return Err(bad("wrong number of points"));
    }
    if start.iter().flatten().any(|coordinate| !coordinate.is_finite()) {
        return Err(bad("a coordinate is not finite"));
    }
    Ok(())
}

#[cfg(test)]
pub(crate) mod tests;
