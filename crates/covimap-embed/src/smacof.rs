//! SMACOF: scaling by majorising a convex function, for weighted sparse pair lists.
//!
//! Minimises the raw stress `sigma(X) = sum w_ij (|x_i - x_j| - d_ij)^2`. By Cauchy and Schwarz,
//! `sigma` lies below a quadratic in `X` that touches it at the present configuration `Z`; the
//! minimum of that quadratic is the Guttman transform
//!
//! `X+ = V^+ B(Z) Z`, with `V = sum w_ij A_ij`, `B(Z) = sum w_ij d_ij / |z_i - z_j| A_ij`,
//! `A_ij = (e_i - e_j)(e_i - e_j)'`,
//!
//! so the stress never rises. The relaxed step `2 X+ - Z` has the same guarantee and about half
//! the steps (de Leeuw and Heiser, 1980).
//!
//! # Complexity
//! One sparse Cholesky factorisation of `V`, then per step one pass over the pairs and one
//! solve for two right-hand sides.
//!
//! # Determinism
//! Sums run in fixed order and solves on one thread: the same bits for any thread count.
//!
//! # References
//! J. de Leeuw, "Applications of convex analysis to multidimensional scaling" (1977);
//! J. de Leeuw and P. Mair, "Multidimensional scaling using majorization: SMACOF in R",
//! J. Stat. Software 31(3), 2009.

use rayon::prelude::*;

use crate::laplacian::Laplacian;
use crate::solve::{check_start, negligible_stress};
use crate::stress::{Incidence, pulls, raw_stress};
use crate::{EmbedError, Embedding, PairDistances, Point, StopRule, Termination};

/// Minimises the stress of `pairs` from `start`.
///
/// The last step is a plain Guttman step, which removes the alternation that relaxed steps leave.
/// It centres every connected component at the origin.
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
    check_start(pairs, start)?;
    let edges: Vec<_> = pairs.pairs().iter().map(|pair| (pair.i, pair.j, pair.weight)).collect();
    let laplacian = Laplacian::new(pairs.objects(), &edges)?;
    let incidence = Incidence::new(pairs);
    let mut pull = vec![0.0; pairs.pairs().len()];
    let mut points = start.to_vec();
    let mut stress = pulls(pairs, &points, &mut pull);
    let negligible = negligible_stress(pairs);
    let mut termination = Termination::IterationLimit;
    let mut iterations = 0;
    while iterations < stop.max_iterations {
        let guttman = laplacian.solve(&weighted_differences(&incidence, &points, &pull));
        iterations += 1;
        let relaxed: Vec<Point> = guttman
            .iter()
            .zip(&points)
            .map(|(new, old)| [2.0 * new[0] - old[0], 2.0 * new[1] - old[1]])
            .collect();
        let before = stress;
        stress = pulls(pairs, &relaxed, &mut pull);
        let done = before - stress <= stop.tolerance * before || stress <= negligible;
        if done || iterations == stop.max_iterations {
            points = guttman;
            stress = raw_stress(pairs, &points);
            if done {
                termination = Termination::Converged;
            }
            break;
        }
        points = relaxed;
    }
    Ok(Embedding::new(pairs, points, stress, iterations, termination))
}

/// `B(X) X`: row i is the sum of `pull_ij (x_i - x_j)` over the pairs of i.
fn weighted_differences(incidence: &Incidence, points: &[Point], pull: &[f64]) -> Vec<Point> {
    (0..points.len())
        .into_par_iter()
        .with_min_len(256)
        .map(|i| {
            let mut sum = [0.0; 2];
            for &(j, pair) in incidence.of(i) {
                let pull = pull[pair as usize];
                sum[0] += pull * (points[i][0] - points[j as usize][0]);
                sum[1] += pull * (points[i][1] - points[j as usize][1]);
            }
            sum
        })
        .collect()
}

#[cfg(test)]
mod tests;
