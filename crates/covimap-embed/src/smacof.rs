//! SMACOF: scaling by majorising a convex function.
//!
//! Minimises the raw stress `sigma(X) = sum w_ij (|x_i - x_j| - d_ij)^2` over the listed pairs. By
//! Cauchy and Schwarz, `sigma` lies below a quadratic in `X` that touches it at the present
//! configuration `Z`; the minimum of that quadratic is the Guttman transform
//!
//! `X+ = V^+ B(Z) Z`, with `V = sum w_ij A_ij`, `B(Z) = sum w_ij d_ij / |z_i - z_j| A_ij`,
//! `A_ij = (e_i - e_j)(e_i - e_j)'`,
//!
//! so the stress never rises. What the distances are compared with may be fitted as well, see
//! [`Transformation`]; such a step does not raise the stress either.
//!
//! # Complexity
//! One Cholesky factorisation of `V` for all starts and steps (none for a complete list with equal
//! weights), then per step one pass over the pairs and one solve for two right-hand sides.
//!
//! # Determinism
//! Sums run in fixed order and solves on one thread: the same bits for any thread count.
//!
//! # References
//! J. de Leeuw, "Applications of convex analysis to multidimensional scaling" (1977);
//! J. de Leeuw and P. Mair, "Multidimensional scaling using majorization: SMACOF in R",
//! J. Stat. Software 31(3), 2009; P. Mair, P. J. F. Groenen, J. de Leeuw, "More on
//! multidimensional scaling and unfolding in R: smacof version 2", J. Stat. Software 102(10), 2022.

use rayon::prelude::*;

use crate::majorise::{Majorised, Majoriser};
use crate::relocate::{Alternative, alternatives};
use crate::stress::FitSums;
use crate::{EmbedError, Embedding, PairDistances, Point, StopRule, Transformation};

/// A relocation is taken if it lowers the stress by more than this share.
const WORTHWHILE: f64 = 1e-6;

/// Minimises the stress of `pairs` from `start`: [`Smacof`] as it is by default.
///
/// Every connected component of the result is centred at the origin.
///
/// Objects that coincide at the start rest on each other until other pairs pull them apart; a
/// start with all objects in one place is a stationary point and stays.
///
/// # Errors
/// [`EmbedError::BadStart`] for a start that does not fit; [`EmbedError::Singular`] where the
/// weights are too different in size for the Laplacian to be factored.
///
/// # Example
/// ```
/// use covimap_embed::{smacof, Pair, PairDistances, StopRule};
/// // A right-angled triangle with legs 3 and 4.
/// let pair = |i, j, distance| Pair { i, j, distance, weight: 1.0 };
/// let triangle = PairDistances::new(3, vec![pair(0, 1, 3.0), pair(0, 2, 4.0), pair(1, 2, 5.0)])?;
/// let start = [[0.0, 0.0], [1.0, 0.1], [0.2, 1.0]];
/// let solved = smacof(&triangle, &start, StopRule { max_iterations: 500, tolerance: 1e-12 })?;
/// assert!(solved.stress < 1e-9);
/// # Ok::<(), covimap_embed::EmbedError>(())
/// ```
pub fn smacof(pairs: &PairDistances, start: &[Point], stop: StopRule) -> Result<Embedding, EmbedError> {
    let plain = Smacof { stop, ..Smacof::default() };
    Ok(plain.from_start(pairs, start)?.embedding)
}

/// How SMACOF is run.
#[derive(Debug, Clone, PartialEq)]
pub struct Smacof {
    /// What the distances are compared with (default: [`Transformation::Ratio`]).
    pub transformation: Transformation,
    /// How far the steps go (default: [`Steps::QuasiNewton`]).
    pub steps: Steps,
    /// Whether starts are maps under this transformation already, as from a run before, so that
    /// their own disparities are fitted at once (default: no). Otherwise the first steps compare
    /// distances with the dissimilarities themselves, which leads from a start that knows nothing
    /// of them to one that does.
    pub warm: bool,
    /// How many objects, those that promise most, are tried in other places when the loop has
    /// converged (default: none). Where a map with one of them elsewhere ends lower, it is taken
    /// and the search begins anew. Each trial is a run of its own: with a few dozen, poor local
    /// minima become rare, at that many times the cost.
    pub relocations: usize,
    /// When to stop (default: after 1000 steps, or when one gains less than 1e-9 of the stress).
    pub stop: StopRule,
}

impl Default for Smacof {
    fn default() -> Self {
        let stop = StopRule { max_iterations: 1000, tolerance: 1e-9 };
        let (transformation, steps) = (Transformation::default(), Steps::default());
        Self { transformation, steps, warm: false, relocations: 0, stop }
    }
}

/// How far a step goes. None raises the stress, and all take one solve with `V`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Steps {
    /// To the Guttman transform `X+`, as in scikit-learn and R's smacof.
    Plain,
    /// About twice as far, which about halves the number of steps.
    Relaxed,
    /// Along the direction, and as far, as the last steps suggest; to `X+` where that fails. A
    /// fifth of the plain steps is usual, far fewer where a map bends easily.
    #[default]
    QuasiNewton,
}

/// A map with what its distances were compared with.
#[derive(Debug, Clone, PartialEq)]
pub struct Scaling {
    /// The map; its stresses are those against `disparities`.
    pub embedding: Embedding,
    /// One a pair, in the order of the list: what best fits the map.
    pub disparities: Vec<f64>,
    /// Raw stress of the start, after each step, and after each relocation that was taken. It
    /// never rises.
    pub trace: Vec<f64>,
}

/// The outcomes of several starts.
#[derive(Debug, Clone, PartialEq)]
pub struct ComparedStarts {
    /// The map of least stress.
    pub best: Scaling,
    /// Which start led to it, the first of equal ones.
    pub best_start: usize,
    /// Raw stress that each start led to. Many starts that end near the least one say that it is
    /// hardly the stress of a poor local minimum.
    pub stresses: Vec<f64>,
}

impl Smacof {
    /// Minimises the stress from one start.
    ///
    /// # Errors
    /// [`EmbedError::BadStart`] for a start that does not fit; [`EmbedError::Singular`] where the
    /// weights are too different in size for the Laplacian to be factored;
    /// [`EmbedError::BadDegree`] for a spline of degree 0; [`EmbedError::Lengths`] if there is not
    /// a bound for each pair.
    ///
    /// # Examples
    /// ```
    /// use covimap_embed::{Pair, PairDistances, Smacof, Ties, Transformation, torgerson_start};
    ///
    /// // The corners of a 1 x 2 rectangle, of which only the order of the distances is known.
    /// let pair = |i, j, rank| Pair { i, j, distance: rank, weight: 1.0 };
    /// let ranks = [pair(0, 1, 1.0), pair(0, 2, 3.0), pair(0, 3, 2.0)];
    /// let more = [pair(1, 2, 2.0), pair(1, 3, 3.0), pair(2, 3, 1.0)];
    /// let pairs = PairDistances::new(4, [ranks, more].concat())?;
    /// let nonmetric =
    ///     Smacof { transformation: Transformation::Ordinal(Ties::Secondary), ..Smacof::default() };
    /// let solved = nonmetric.from_start(&pairs, &torgerson_start(&pairs)?)?;
    /// assert!(solved.embedding.stress1 < 1e-6);
    /// # Ok::<(), covimap_embed::EmbedError>(())
    /// ```
    pub fn from_start(&self, pairs: &PairDistances, start: &[Point]) -> Result<Scaling, EmbedError> {
        // All of it on one thread of the pool: to hand over single steps would cost more than small
        // ones take.
        rayon::scope(|_| self.solve(&Majoriser::new(pairs, self)?, pairs, start))
    }

    /// Minimises the stress from each start and keeps the best.
    ///
    /// # Errors
    /// As [`from_start`](Self::from_start); [`EmbedError::BadStart`] also if there is no start.
    pub fn from_starts(
        &self,
        pairs: &PairDistances,
        starts: &[Vec<Point>],
    ) -> Result<ComparedStarts, EmbedError> {
        let problem = Majoriser::new(pairs, self)?;
        let run = |start: &Vec<Point>| self.solve(&problem, pairs, start);
        let mut solved = starts.par_iter().map(run).collect::<Result<Vec<Scaling>, EmbedError>>()?;
        let stresses: Vec<f64> = solved.iter().map(|scaling| scaling.embedding.stress).collect();
        let least = (0..stresses.len()).min_by(|&a, &b| stresses[a].total_cmp(&stresses[b]));
        let Some(best_start) = least else {
            return Err(EmbedError::BadStart { what: "none is given", found: 0, wanted: pairs.objects() });
        };
        Ok(ComparedStarts { best: solved.swap_remove(best_start), best_start, stresses })
    }

    fn solve(
        &self,
        problem: &Majoriser,
        pairs: &PairDistances,
        start: &[Point],
    ) -> Result<Scaling, EmbedError> {
        let mut best = Scaling::new(pairs, problem.run(start, self)?);
        if self.relocations > 0 {
            let warm = Self { warm: true, ..self.clone() };
            while let Some(better) = warm.relocate(problem, pairs, &best)? {
                best = better;
            }
        }
        Ok(best)
    }

    /// The first of the trials that ends below `best`, if one does.
    fn relocate(
        &self,
        problem: &Majoriser,
        pairs: &PairDistances,
        best: &Scaling,
    ) -> Result<Option<Scaling>, EmbedError> {
        let points = &best.embedding.points;
        let mut alternatives = alternatives(pairs, points, &best.disparities);
        alternatives.truncate(self.relocations);
        let below = (1.0 - WORTHWHILE) * best.embedding.stress;
        let trial = |alternative: &Alternative| {
            let mut start = points.clone();
            start[alternative.object] = alternative.place;
            let solved = problem.run(&start, self).map(|solved| Scaling::new(pairs, solved));
            match solved {
                Ok(solved) if solved.embedding.stress >= below => None,
                decided => Some(decided),
            }
        };
        let Some(better) = alternatives.par_iter().find_map_first(trial).transpose()? else {
            return Ok(None);
        };
        let mut trace = best.trace.clone();
        trace.push(better.embedding.stress);
        let iterations = best.embedding.iterations + better.embedding.iterations;
        Ok(Some(Scaling { trace, embedding: Embedding { iterations, ..better.embedding }, ..better }))
    }
}

impl Scaling {
    fn new(pairs: &PairDistances, solved: Majorised) -> Self {
        let Majorised { points, disparities, mut trace, termination } = solved;
        let sums = FitSums::new(pairs, |k| disparities[k], &points);
        let iterations = trace.len() - 1;
        trace[iterations] = sums.residual;
        let embedding = Embedding::new(points, sums, iterations, termination);
        Self { embedding, disparities, trace }
    }
}

#[cfg(test)]
mod tests;
