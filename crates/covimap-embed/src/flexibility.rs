//! How far errors of the known distances bend a configuration as a whole.
//!
//! At a minimum of the stress, errors `e_ij` of the distances move the points by the solution of the
//! normal equations `H s = sum w_ij e_ij u_ij`, `u_ij` the direction of a pair and
//! `H = sum w_ij u_ij u_ij'`. Neighbours move together: what a long chain of regions or a narrow door
//! leaves free shows in the length of `s`, and not in the residuals. Errors that neighbours share do not cancel as independent
//! ones do, and so bend more.
//!
//! # Complexity
//! One sparse factorisation of order `2 n`, and a solution a draw, four found together; a draw of errors is `O(m)` for `m` pairs.

use std::f64::consts::FRAC_1_SQRT_2;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::newton::NormalEquations;
use crate::{EmbedError, Pair, PairDistances, Point};

/// Share of the Laplacian added to the matrix: points that two distances or fewer hold would
/// otherwise be thrown about.
const DAMPING: f64 = 1e-3;
/// Draws whose moves are found together.
const TOGETHER: usize = 4;

/// How wrong the distances of the pairs are, as standard deviations, one a pair each, in units of the distances. The
/// error of pair `ij` is
///
/// `e_ij = own_ij a_ij + shared_ij (h_i + h_j) / sqrt 2`,
///
/// with independent standard normal `a_ij`, and `h_i` standard normal, too, but alike for neighbours: the sum of
/// what is independent at `i` and at all points that have a distance to it, over the root of their number.
#[derive(Debug, Clone, PartialEq)]
pub struct DistanceErrors {
    /// Of the part that each pair has for itself.
    pub own: Vec<f64>,
    /// Of the part that pairs nearby have in common.
    pub shared: Vec<f64>,
}

impl DistanceErrors {
    /// Random errors of every pair.
    fn draw(&self, pairs: &PairDistances, rng: &mut ChaCha8Rng) -> Vec<[f64; TOGETHER]> {
        let field = common_field(pairs, rng);
        let of_pair = |((pair, own), shared): ((&Pair, &f64), &f64)| {
            let (alone, ends) = (normals(rng), [pair.i, pair.j].map(|end| field[end as usize]));
            let common = shared * FRAC_1_SQRT_2;
            std::array::from_fn(|k| own * alone[k] + common * (ends[0][k] + ends[1][k]))
        };
        pairs.pairs().iter().zip(&self.own).zip(&self.shared).map(of_pair).collect()
    }
}

/// `h` of [`DistanceErrors`].
fn common_field(pairs: &PairDistances, rng: &mut ChaCha8Rng) -> Vec<[f64; TOGETHER]> {
    let alone: Vec<[f64; TOGETHER]> = (0..pairs.objects()).map(|_| normals(rng)).collect();
    let mut sums: Vec<([f64; TOGETHER], f64)> = alone.iter().map(|&own| (own, 1.0)).collect();
    for pair in pairs.pairs() {
        for (to, from) in [(pair.i, pair.j), (pair.j, pair.i)] {
            let (sum, terms) = &mut sums[to as usize];
            *terms += 1.0;
            for (sum, other) in sum.iter_mut().zip(alone[from as usize]) {
                *sum += other;
            }
        }
    }
    sums.into_iter().map(|(sum, terms)| sum.map(|sum| sum / terms.sqrt())).collect()
}

/// Standard deviation of a coordinate of every point, when the distances have random errors of this size. Shift, turn, mirror and
/// scale of the whole are not counted. `draws >= 1` random errors are tried, so that a result is off by
/// a share of `1 / 2 sqrt(draws)` to `1 / sqrt(2 draws)` of it. `go_on` is asked as often as
/// [`flexibility_steps`] tells, the work in between being about the same; `None` if it says no.
///
/// # Errors
/// [`EmbedError::Singular`] and [`EmbedError::OutOfMemory`] as in [`newton`](crate::newton());
/// [`EmbedError::BadStart`] if there is not one finite point an object.
///
/// # Panics
/// If there is not one deviation of each kind a pair.
pub fn flexibility(
    pairs: &PairDistances,
    points: &[Point],
    errors: &DistanceErrors,
    draws: usize,
    seed: u64,
    mut go_on: impl FnMut() -> bool,
) -> Result<Option<Vec<f64>>, EmbedError> {
    crate::solve::check_start(pairs, points)?;
    for deviations in [&errors.own, &errors.shared] {
        assert_eq!(deviations.len(), pairs.pairs().len(), "one deviation a pair");
    }
    let n = points.len();
    let mut system = NormalEquations::new(pairs);
    if !go_on() {
        return Ok(None);
    }
    system.factor(pairs, points, DAMPING)?;
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut squares = vec![0.0; n];
    for first in (0..draws).step_by(TOGETHER) {
        if !go_on() {
            return Ok(None);
        }
        let mut moves = vec![[0.0; TOGETHER]; 2 * n];
        for (pair, errors) in pairs.pairs().iter().zip(errors.draw(pairs, &mut rng)) {
            let (i, j) = (pair.i as usize, pair.j as usize);
            let d = [points[i][0] - points[j][0], points[i][1] - points[j][1]];
            let length = (d[0] * d[0] + d[1] * d[1]).sqrt();
            if length > 0.0 {
                for axis in 0..2 {
                    for (k, error) in errors.into_iter().enumerate() {
                        let by = pair.weight / length * error * d[axis];
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
            for (square, [x, y]) in squares.iter_mut().zip(own.as_chunks().0) {
                *square += x * x + y * y;
            }
        }
    }
    Ok(Some(squares.into_iter().map(|square| (square / (2 * draws).max(1) as f64).sqrt()).collect()))
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
    use crate::{Correspondence, ProcrustesOptions, StopRule, newton, procrustes};

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

    /// Every pair as wrong as another.
    fn errors(pairs: &PairDistances, own: f64, shared: f64) -> DistanceErrors {
        let all = pairs.pairs().len();
        DistanceErrors { own: vec![own; all], shared: vec![shared; all] }
    }

    fn rms(deviations: &[f64]) -> f64 {
        (deviations.iter().map(|d| d * d).sum::<f64>() / deviations.len() as f64).sqrt()
    }

    /// Root mean square over the points.
    fn bend(pairs: &PairDistances, points: &[Point], error: f64, draws: usize) -> f64 {
        rms(&flexibility(pairs, points, &errors(pairs, error, 0.0), draws, 1, || true).unwrap().unwrap())
    }

    /// What `flexibility` tells of a corridor against the errors of configurations that are fitted to wrong distances,
    /// of every point.
    fn told_and_found(errors: &DistanceErrors, points: &[Point], pairs: &PairDistances) -> [Vec<f64>; 2] {
        let told = flexibility(pairs, points, errors, 100, 1, || true).unwrap().unwrap();
        let mut rng = ChaCha8Rng::seed_from_u64(5);
        let mut squares = vec![0.0; points.len()];
        for _ in 0..100 {
            let wrong = pairs.pairs().iter().zip(errors.draw(pairs, &mut rng));
            let wrong = wrong.map(|(pair, error)| Pair { distance: pair.distance + error[0], ..*pair });
            let wrong = PairDistances::new(points.len(), wrong.collect()).unwrap();
            let fitted = newton(&wrong, points, StopRule { max_iterations: 50, tolerance: 1e-9 }).unwrap();
            let both = fitted.points.iter().zip(points);
            let both = both.map(|(&source, &target)| Correspondence { source, target, weight: 1.0 });
            let fit = procrustes(&both.collect::<Vec<_>>(), ProcrustesOptions::default()).unwrap();
            for ((square, &source), target) in squares.iter_mut().zip(&fitted.points).zip(points) {
                let [x, y] = fit.target_from_source.apply(source);
                *square += ((x - target[0]).powi(2) + (y - target[1]).powi(2)) / 200.0;
            }
        }
        [told, squares.into_iter().map(f64::sqrt).collect()]
    }

    #[test]
    fn it_is_the_error_of_configurations_fitted_to_wrong_distances() {
        let (points, pairs) = grid(12, 3, 2.5);
        for (own, shared) in [(0.02, 0.0), (0.0, 0.01), (0.01, 0.01)] {
            let [told, found] = told_and_found(&errors(&pairs, own, shared), &points, &pairs);
            let (whole, real) = (rms(&told), rms(&found));
            assert!((whole / real - 1.0).abs() < 0.15, "{own} {shared}: {whole} {real}");
            for (point, (told, found)) in told.iter().zip(&found).enumerate() {
                assert!((told / found - 1.0).abs() < 0.4, "{own} {shared}, point {point}: {told} {found}");
            }
        }
    }

    #[test]
    fn errors_have_the_size_that_is_told_and_shared_ones_are_alike_nearby() {
        let (_, pairs) = grid(20, 20, 1.5);
        let mut rng = ChaCha8Rng::seed_from_u64(2);
        let size = |own, shared, rng: &mut ChaCha8Rng| {
            let drawn: Vec<f64> =
                (0..25).flat_map(|_| errors(&pairs, own, shared).draw(&pairs, rng)).flatten().collect();
            rms(&drawn)
        };
        assert!((size(0.3, 0.0, &mut rng) / 0.3 - 1.0).abs() < 0.02);
        // The two ends of a pair are alike: up to twice the variance, and no less than that of unlike ends.
        let shared = size(0.0, 0.3, &mut rng) / 0.3;
        assert!(shared > 1.2 && shared < 2.0_f64.sqrt(), "{shared}");
        // The field has the variance 1, and is alike in neighbours and not beyond those of neighbours.
        let products = |a: usize, b: usize, rng: &mut ChaCha8Rng| {
            let fields = (0..2000).map(|_| common_field(&pairs, rng));
            fields.map(|field| (0..TOGETHER).map(|k| field[a][k] * field[b][k]).sum::<f64>()).sum::<f64>()
                / (2000 * TOGETHER) as f64
        };
        let middle = 10 * 20 + 10;
        assert!((products(middle, middle, &mut rng) - 1.0).abs() < 0.06);
        // Six of the nine terms of each are the other's, too.
        assert!((products(middle, middle + 1, &mut rng) - 6.0 / 9.0).abs() < 0.06);
        assert!(products(middle, middle + 3, &mut rng).abs() < 0.06);
    }

    #[test]
    fn shared_errors_bend_more_and_the_ends_of_a_corridor_most() {
        let (points, pairs) = grid(30, 8, 2.5);
        let told = |own, shared| {
            flexibility(&pairs, &points, &errors(&pairs, own, shared), 40, 1, || true).unwrap().unwrap()
        };
        let ratio = rms(&told(0.0, 0.02)) / rms(&told(0.02, 0.0));
        assert!(ratio > 2.0, "{ratio}");
        // A bow is furthest off at its ends; 8 points a column.
        let bent = told(0.02, 0.0);
        assert!(rms(&bent[..8]) > 1.5 * rms(&bent[56..64]), "{bent:?}");
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
        assert!(flexibility(&one, &[[0.0; 2]], &errors(&one, 0.1, 0.1), 5, 1, || true).is_err());
    }

    #[test]
    fn it_asks_as_often_as_it_says_and_stops_when_it_is_told_to() {
        let (points, pairs) = grid(4, 4, 1.5);
        let errors = errors(&pairs, 0.1, 0.0);
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
