//! Least squares with coefficients that must not be negative.

use nalgebra::{DMatrix, DVector};

/// Share of the mean diagonal entry that is added to the diagonal, so that columns which depend
/// on each other do no harm.
const RIDGE: f64 = 1e-12;
/// A gradient below this share of its scale is zero.
const FLAT: f64 = 1e-12;

/// Rounds for each coefficient before the solution stands as it is; one is the rule.
const MAX_ROUNDS: usize = 3;

/// Minimises `b' G b - 2 c' b` over `b >= 0`, for the Gram matrix `G = A' W A` and `c = A' W y`.
///
/// Lawson and Hanson's active-set method: the coefficient with the steepest descent is set free,
/// the free ones are solved for, and those that would turn negative are held at zero again.
/// `O(p^4)` for `p` coefficients.
///
/// C. L. Lawson, R. J. Hanson, "Solving Least Squares Problems", Prentice-Hall 1974, ch. 23.
pub(crate) fn non_negative_least_squares(gram: &DMatrix<f64>, c: &DVector<f64>) -> DVector<f64> {
    let p = c.len();
    let ridge = RIDGE * gram.trace() / p.max(1) as f64;
    let gram = gram + DMatrix::from_diagonal_element(p, p, ridge);
    let mut b = DVector::zeros(p);
    let mut free: Vec<usize> = Vec::new();
    for _ in 0..MAX_ROUNDS * p {
        let descent = c - &gram * &b;
        let held = (0..p).filter(|k| !free.contains(k) && descent[*k] > FLAT * c.amax());
        let Some(steepest) = held.max_by(|&j, &k| descent[j].total_cmp(&descent[k])) else { break };
        free.push(steepest);
        move_to_minimum(&gram, c, &mut b, &mut free);
    }
    b
}

/// Moves the free coefficients to their minimum; those that reach zero on the way are held there.
fn move_to_minimum(gram: &DMatrix<f64>, c: &DVector<f64>, b: &mut DVector<f64>, free: &mut Vec<usize>) {
    while !free.is_empty() {
        let target = solve_free(gram, c, free);
        let steps = free.iter().zip(&target).filter(|(_, target)| **target <= 0.0);
        let steps = steps.map(|(&k, target)| (b[k] / (b[k] - target), k));
        let Some((step, first)) = steps.min_by(|a, b| a.0.total_cmp(&b.0)) else {
            free.iter().zip(&target).for_each(|(&k, &target)| b[k] = target);
            return;
        };
        free.iter().zip(&target).for_each(|(&k, target)| b[k] += step * (target - b[k]));
        b[first] = 0.0;
        free.retain(|&k| b[k] > 0.0);
    }
}

/// The unconstrained minimum over the coefficients in `free`.
fn solve_free(gram: &DMatrix<f64>, c: &DVector<f64>, free: &[usize]) -> Vec<f64> {
    let q = free.len();
    let part = DMatrix::from_fn(q, q, |i, j| gram[(free[i], free[j])]);
    let rhs = DVector::from_fn(q, |i, _| c[free[i]]);
    let factor = part.cholesky().expect("a Gram matrix with a ridge is positive definite (bug in covimap)");
    factor.solve(&rhs).iter().copied().collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The best of the solutions that set some coefficients free, over all choices of these.
    fn oracle(gram: &DMatrix<f64>, c: &DVector<f64>) -> f64 {
        let p = c.len();
        let mut best = 0.0_f64;
        for choice in 1..1_u32 << p {
            let free: Vec<usize> = (0..p).filter(|k| choice >> k & 1 == 1).collect();
            let solved = solve_free(gram, c, &free);
            if solved.iter().all(|&x| x >= 0.0) {
                // At an unconstrained minimum the objective is -c' b.
                best = best.min(-free.iter().zip(&solved).map(|(&k, x)| c[k] * x).sum::<f64>());
            }
        }
        best
    }

    fn objective(gram: &DMatrix<f64>, c: &DVector<f64>, b: &DVector<f64>) -> f64 {
        b.dot(&(gram * b)) - 2.0 * c.dot(b)
    }

    proptest! {
        #[test]
        fn no_choice_of_free_coefficients_does_better(
            entries in prop::collection::vec(-1.0..1.0_f64, 40), y in prop::collection::vec(-1.0..1.0_f64, 8),
        ) {
            // Eight observations of five correlated columns.
            let a = DMatrix::from_fn(8, 5, |i, j| entries[5 * i + j] + 0.5);
            let (gram, c) = (a.tr_mul(&a), a.tr_mul(&DVector::from_vec(y)));
            let b = non_negative_least_squares(&gram, &c);
            prop_assert!(b.iter().all(|&x| x >= 0.0));
            prop_assert!(objective(&gram, &c, &b) <= oracle(&gram, &c) + 1e-9);
        }
    }

    #[test]
    fn a_coefficient_that_wants_to_be_negative_stays_at_zero() {
        // G = I: the minimum is c where it is positive.
        let c = DVector::from_vec(vec![2.0, -1.0, 0.0]);
        let b = non_negative_least_squares(&DMatrix::identity(3, 3), &c);
        assert!((b[0] - 2.0).abs() < 1e-10 && b[1] == 0.0 && b[2] == 0.0);
    }

    #[test]
    fn equal_columns_share() {
        let gram = DMatrix::from_element(2, 2, 1.0);
        let b = non_negative_least_squares(&gram, &DVector::from_element(2, 3.0));
        assert!((b[0] + b[1] - 3.0).abs() < 1e-6);
    }

    #[test]
    fn no_coefficient() {
        assert_eq!(non_negative_least_squares(&DMatrix::zeros(0, 0), &DVector::zeros(0)).len(), 0);
    }
}
