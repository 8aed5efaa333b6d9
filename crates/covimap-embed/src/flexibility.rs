//! How far errors of the known distances bend a configuration as a whole.
//!
//! At a minimum of the stress, errors `e_ij` of the distances move the points by the solution of the
//! normal equations `H s = sum w_ij e_ij u_ij`, `u_ij` the direction of a pair and
//! `H = sum w_ij u_ij u_ij'`. Neighbours move together: what a long chain of regions or a narrow door
//! leaves free shows in the length of `s`, and not in the residuals.
//!
//! # Complexity
//! One sparse factorisation of order `2 n`, and a solution a draw, four found together.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::newton::NormalEquations;
use crate::{EmbedError, PairDistances, Point};

/// Share of the Laplacian added to the matrix: points that two distances or fewer hold would
/// otherwise be thrown about.
const DAMPING: f64 = 1e-3;
/// Draws whose moves are found together.
const TOGETHER: usize = 4;

/// Standard deviation of a coordinate, in the root mean square over all points, when the distance of each
/// pair has an independent normal error with the standard deviation given for it. Shift, turn, mirror and
/// scale of the whole are not counted. `draws >= 1` random errors are tried. `go_on` is asked as often as
/// [`flexibility_steps`] tells, the work in between being about the same; `None` if it says no.
///
/// # Errors
/// [`EmbedError::Singular`] and [`EmbedError::OutOfMemory`] as in [`newton`](crate::newton());
/// [`EmbedError::BadStart`] if there is not one finite point an object.
///
/// # Panics
/// If there is not one deviation a pair.
pub fn flexibility(
    pairs: &PairDistances,
    points: &[Point],
    deviations: &[f64],
    draws: usize,
    seed: u64,
    mut go_on: impl FnMut() -> bool,
) -> Result<Option<f64>, EmbedError> {
    crate::solve::check_start(pairs, points)?;
    assert_eq!(deviations.len(), pairs.pairs().len(), "one deviation a pair");
    let n = points.len();
    let mut system = NormalEquations::new(pairs);
    if !go_on() {
        return Ok(None);
    }
    system.factor(pairs, points, DAMPING)?;
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut square = 0.0;
    for first in (0..draws).step_by(TOGETHER) {
        if !go_on() {
            return Ok(None);
        }
        let mut moves = vec![[0.0; TOGETHER]; 2 * n];
        for (pair, deviation) in pairs.pairs().iter().zip(deviations) {
            let (i, j) = (pair.i as usize, pair.j as usize);
            let d = [points[i][0] - points[j][0], points[i][1] - points[j][1]];
            let length = (d[0] * d[0] + d[1] * d[1]).sqrt();
            if length > 0.0 {
                let pull = pair.weight * deviation / length;
                let errors = normals(&mut rng);
                for axis in 0..2 {
                    for (k, error) in errors.into_iter().enumerate() {
                        let by = pull * error * d[axis];
                        moves[2 * i + axis][k] += by;
                        moves[2 * j + axis][k] -= by;
                    }
                }
            }
        }
        system.solve(&mut moves);
        for draw in 0..TOGETHER.min(draws - first) {
            let mut own: Vec<f64> = moves.iter().map(|row| row[draw]).collect();
            take_out_frame(points, &mut own);
            square += own.iter().map(|c| c * c).sum::<f64>();
        }
    }
    Ok(Some((square / (2 * n * draws).max(1) as f64).sqrt()))
}

/// How often [`flexibility`] asks whether to go on.
#[must_use]
pub fn flexibility_steps(draws: usize) -> usize {
    1 + draws.div_ceil(TOGETHER)
}

/// Takes out of the moves what a shift, a turn and a change of scale of the whole does.
fn take_out_frame(points: &[Point], moves: &mut [f64]) {
    let n = points.len() as f64;
    let mean = [0, 1].map(|axis| points.iter().map(|point| point[axis]).sum::<f64>() / n);
    let from_mean = |point: &Point| [point[0] - mean[0], point[1] - mean[1]];
    // Orthogonal to each other, for the points are taken from their mean.
    let frames: [fn(Point) -> Point; 4] = [|_| [1.0, 0.0], |_| [0.0, 1.0], |[x, y]| [-y, x], |[x, y]| [x, y]];
    for frame in frames {
        let along = |point: &Point| frame(from_mean(point));
        let (mut product, mut square) = (0.0, 0.0);
        for (point, own) in points.iter().zip(moves.chunks_exact(2)) {
            let [x, y] = along(point);
            product += x * own[0] + y * own[1];
            square += x * x + y * y;
        }
        if square > 0.0 {
            for (point, own) in points.iter().zip(moves.chunks_exact_mut(2)) {
                let [x, y] = along(point);
                own[0] -= product / square * x;
                own[1] -= product / square * y;
            }
        }
    }
}

/// Standard normal numbers, after Box and Muller.
fn normals(rng: &mut ChaCha8Rng) -> [f64; TOGETHER] {
    let mut two = || {
        let (radius, angle): (f64, f64) = (rng.random(), rng.random());
        let radius = (-2.0 * (1.0 - radius).ln()).sqrt();
        let (sin, cos) = (std::f64::consts::TAU * angle).sin_cos();
        [radius * cos, radius * sin]
    };
    let ([a, b], [c, d]) = (two(), two());
    [a, b, c, d]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Correspondence, Pair, ProcrustesOptions, StopRule, newton, procrustes};

    /// A grid of points, each linked to those within a reach.
    fn grid(columns: u32, rows: u32, reach: f64) -> (Vec<Point>, PairDistances) {
        let points: Vec<Point> =
            (0..columns).flat_map(|x| (0..rows).map(move |y| [f64::from(x), f64::from(y)])).collect();
        let length = |i: usize, j: usize| (points[i][0] - points[j][0]).hypot(points[i][1] - points[j][1]);
        let n = points.len();
        let all = (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j)));
        let near = all.filter(|&(i, j)| length(i, j) < reach);
        let pair = |(i, j)| Pair { i: i as u32, j: j as u32, distance: length(i, j), weight: 1.0 };
        let pairs = near.map(pair).collect();
        (points.clone(), PairDistances::new(n, pairs).unwrap())
    }

    fn bend(pairs: &PairDistances, points: &[Point], error: f64, draws: usize) -> f64 {
        let errors = vec![error; pairs.pairs().len()];
        flexibility(pairs, points, &errors, draws, 1, || true).unwrap().unwrap()
    }

    #[test]
    fn it_is_the_error_of_configurations_fitted_to_wrong_distances() {
        let (points, pairs) = grid(12, 3, 2.5);
        let found = bend(&pairs, &points, 0.02, 60);
        let mut rng = ChaCha8Rng::seed_from_u64(5);
        let mut squares = 0.0;
        for _ in 0..60 {
            let wrong = pairs.pairs().iter();
            let wrong =
                wrong.map(|pair| Pair { distance: pair.distance + 0.02 * normals(&mut rng)[0], ..*pair });
            let wrong = PairDistances::new(points.len(), wrong.collect()).unwrap();
            let fitted = newton(&wrong, &points, StopRule { max_iterations: 50, tolerance: 1e-9 }).unwrap();
            let both = fitted.points.iter().zip(&points);
            let both = both.map(|(&source, &target)| Correspondence { source, target, weight: 1.0 });
            let rmse = procrustes(&both.collect::<Vec<_>>(), ProcrustesOptions::default()).unwrap().rmse;
            squares += rmse * rmse / 2.0;
        }
        let real = (squares / 60.0_f64).sqrt();
        assert!((found / real - 1.0).abs() < 0.15, "{found} {real}");
    }

    #[test]
    fn what_is_long_and_thin_bends_most() {
        let of_grid = |columns, rows| {
            let (points, pairs) = grid(columns, rows, 2.5);
            bend(&pairs, &points, 0.02, 20)
        };
        assert!(of_grid(36, 2) > 3.0 * of_grid(9, 8));
        // In proportion to the errors.
        let (points, pairs) = grid(5, 5, 1.5);
        let of = |size| bend(&pairs, &points, size, 4);
        assert!((of(0.2) / of(0.1) - 2.0).abs() < 1e-9);
        assert_eq!(of(0.0), 0.0);
    }

    #[test]
    fn a_single_pair_and_a_pile_do_not_bend() {
        let one = PairDistances::new(2, vec![Pair { i: 0, j: 1, distance: 1.0, weight: 1.0 }]).unwrap();
        // All that its error does is a change of scale.
        assert!(bend(&one, &[[0.0, 0.0], [1.0, 0.0]], 0.1, 5) < 1e-9);
        assert_eq!(bend(&one, &[[0.0; 2]; 2], 0.1, 5), 0.0);
        assert!(flexibility(&one, &[[0.0; 2]], &[0.1], 5, 1, || true).is_err());
    }

    #[test]
    fn it_asks_as_often_as_it_says_and_stops_when_it_is_told_to() {
        let (points, pairs) = grid(4, 4, 1.5);
        let errors = vec![0.1; pairs.pairs().len()];
        for draws in [1, 4, 5, 12] {
            let asked = |most: usize| {
                let mut asked = 0;
                let go_on = || {
                    asked += 1;
                    asked <= most
                };
                let found = flexibility(&pairs, &points, &errors, draws, 1, go_on).unwrap();
                (found.is_some(), asked)
            };
            assert_eq!(asked(usize::MAX), (true, flexibility_steps(draws)));
            assert_eq!(asked(1), (false, 2));
        }
    }
}
