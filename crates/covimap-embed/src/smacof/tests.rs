use proptest::prelude::*;

use super::*;
use crate::eigen::symmetric_eigen;
use crate::solve::tests::{after, cases, random_problem};
use crate::stress::distance;
use crate::{Pair, raw_stress};

/// The Guttman transform `V^+ B(X) X` with dense matrices and the pseudo-inverse by eigenvalues.
fn dense_guttman(pairs: &PairDistances, points: &[Point]) -> Vec<Point> {
    let n = points.len();
    let (mut v, mut b) = (vec![0.0; n * n], vec![0.0; n * n]);
    for pair in pairs.pairs() {
        let (i, j) = (pair.i as usize, pair.j as usize);
        let pull = pair.weight * pair.distance / distance(points[i], points[j]);
        for (matrix, entry) in [(&mut v, pair.weight), (&mut b, pull)] {
            matrix[i * n + j] -= entry;
            matrix[j * n + i] -= entry;
            matrix[i * n + i] += entry;
            matrix[j * n + j] += entry;
        }
    }
    let product = |i: usize, axis: usize| (0..n).map(|j| b[i * n + j] * points[j][axis]).sum::<f64>();
    let right: Vec<Point> = (0..n).map(|i| [product(i, 0), product(i, 1)]).collect();
    let pairs = symmetric_eigen(n, &v);
    let mut solution = vec![[0.0; 2]; n];
    // The last eigenvalue of a connected problem is the zero of the shifts.
    for (value, vector) in pairs.values.iter().zip(&pairs.vectors).take(n - 1) {
        for axis in 0..2 {
            let part = vector.iter().zip(&right).map(|(e, y)| e * y[axis]).sum::<f64>() / value;
            solution.iter_mut().zip(vector).for_each(|(x, e)| x[axis] += part * e);
        }
    }
    solution
}

/// The factor that brings the points to the size that fits best: `sum w d r / sum w r^2`.
fn fitting_size(pairs: &PairDistances, points: &[Point]) -> f64 {
    let (mut fit, mut extent) = (0.0, 0.0);
    for pair in pairs.pairs() {
        let r = distance(points[pair.i as usize], points[pair.j as usize]);
        fit += pair.weight * pair.distance * r;
        extent += pair.weight * r * r;
    }
    fit / extent
}

proptest! {
    #![proptest_config(cases(64))]

    #[test]
    fn steps_are_those_of_the_dense_formula(n in 2_u32..20, seed in 0_u64..1000, count in 1_usize..6) {
        let (pairs, start) = random_problem(n, seed);
        // All but the last step of a run, which is plain, go as far as is asked.
        for (steps, reach) in [(Steps::Plain, 1.0), (Steps::Relaxed, 2.0)] {
            let how = Smacof { steps, stop: after(count), ..Smacof::default() };
            let solved = how.from_start(&pairs, &start).unwrap().embedding;
            let mut points = start.clone();
            for _ in 1..solved.iterations {
                let guttman = dense_guttman(&pairs, &points);
                let size = fitting_size(&pairs, &points);
                let beyond = |new: f64, old: f64| reach * new - (reach - 1.0) * size * old;
                let next: Vec<Point> = guttman
                    .iter()
                    .zip(&points)
                    .map(|(new, old)| [beyond(new[0], old[0]), beyond(new[1], old[1])])
                    .collect();
                let most = raw_stress(&pairs, &points) * (1.0 + 1e-9) + 1e-9;
                prop_assert!(raw_stress(&pairs, &next) <= most);
                points = next;
            }
            // Weights over six decades cost the dense pseudo-inverse about as many digits.
            for (got, wanted) in solved.points.iter().zip(dense_guttman(&pairs, &points)) {
                prop_assert!(distance(*got, wanted) < 1e-7, "{:?}: {:?} for {:?}", steps, got, wanted);
            }
        }
    }
}

#[test]
fn the_result_is_centred_in_every_component() {
    let pair = |i, j| Pair { i, j, distance: 1.0, weight: 2.0 };
    let pairs = PairDistances::new(6, vec![pair(0, 2), pair(0, 4), pair(1, 3), pair(2, 4)]).unwrap();
    let start = [[5.0, 1.0], [-2.0, 3.0], [6.0, 1.5], [-2.5, 8.0], [5.5, 0.0], [1.0, 1.0]];
    let solved = smacof(&pairs, &start, after(3)).unwrap().points;
    for component in [vec![0, 2, 4], vec![1, 3], vec![5]] {
        let own = component.iter().map(|&object: &usize| solved[object]);
        let sum = own.fold([0.0; 2], |sum, [x, y]| [sum[0] + x, sum[1] + y]);
        assert!(sum[0].hypot(sum[1]) < 1e-12, "{component:?}: {sum:?}");
    }
}

#[test]
fn weights_beyond_what_numbers_can_hold_are_refused() {
    let pair = |i, j, weight| Pair { i, j, distance: 1.0, weight };
    let pairs = PairDistances::new(3, vec![pair(0, 1, 1e200), pair(1, 2, 1e-200)]).unwrap();
    let error = smacof(&pairs, &[[0.0, 0.0], [1.0, 0.1], [2.0, 0.0]], after(3)).unwrap_err();
    assert!(matches!(error, EmbedError::Singular { order: 3 }));
    assert_eq!(
        error.to_string(),
        "a linear system of 3 unknowns is singular to working precision; the weights differ too much in size"
    );
}
