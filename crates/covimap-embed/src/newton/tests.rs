use proptest::prelude::*;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::*;
use crate::raw_stress;
use crate::solve::tests::{TO_THE_END, after, cases, jittered, pairs_within, random_points, random_problem};
use crate::{Pair, Smacof, Steps, smacof};

/// Half the stress after a move of one coordinate.
fn half_stress(pairs: &PairDistances, points: &[Point], (object, axis): (usize, usize), by: f64) -> f64 {
    let mut moved = points.to_vec();
    moved[object][axis] += by;
    raw_stress(pairs, &moved) / 2.0
}

fn half_gradient(pairs: &PairDistances, points: &[Point]) -> Vec<f64> {
    let distances: Vec<f64> = pairs.pairs().iter().map(|pair| pair.distance).collect();
    PairLayout::new(pairs).forces(points, &distances).forces.into_flattened()
}

/// All coordinates, in the order of the unknowns.
fn unknowns(n: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..n).flat_map(|object| [(object, 0), (object, 1)])
}

proptest! {
    #![proptest_config(cases(32))]

    #[test]
    fn the_gradient_is_that_of_half_the_stress(n in 2_u32..12, seed in 0_u64..1000) {
        let (pairs, points) = random_problem(n, seed);
        let gradient = half_gradient(&pairs, &points);
        let size = raw_stress(&pairs, &points);
        for (unknown, derivative) in unknowns(n as usize).zip(gradient) {
            let by = 1e-6;
            let rise = half_stress(&pairs, &points, unknown, by) - half_stress(&pairs, &points, unknown, -by);
            prop_assert!((rise / (2.0 * by) - derivative).abs() < 1e-4 * (1.0 + size), "{:?}", unknown);
        }
    }

    /// Where every pair is too long nothing is dropped: the matrix is the second derivative.
    #[test]
    fn the_matrix_is_the_second_derivative_where_all_pairs_are_too_long(n in 2_usize..9, seed in 0_u64..1000) {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let points = random_points(n, &mut rng);
        let given = pairs_within(&points, 9.0);
        let shrunk =
            given.pairs().iter().map(|pair| Pair { distance: rng.random::<f64>() * pair.distance, ..*pair });
        let pairs = PairDistances::new(n, shrunk.collect()).unwrap();
        let mut system = NormalEquations::new(&pairs);
        let damping = 0.25;
        system.assemble(&pairs, &points, damping);
        let by = 1e-5;
        for (column, (object, axis)) in unknowns(n).enumerate() {
            let unit: Vec<f64> = (0..2 * n).map(|row| f64::from(u8::from(row == column))).collect();
            let got = system.matrix.times(&unit);
            let gradient_at = |by: f64| {
                let mut moved = points.clone();
                moved[object][axis] += by;
                half_gradient(&pairs, &moved)
            };
            let (high, low) = (gradient_at(by), gradient_at(-by));
            for (row, (other, other_axis)) in unknowns(n).enumerate() {
                // V has -1 for every pair and n - 1 on the diagonal here, for either axis.
                let laplacian = match (other_axis == axis, other == object) {
                    (false, _) => 0.0,
                    (true, true) => n as f64 - 1.0,
                    (true, false) => -1.0,
                };
                let wanted = (high[row] - low[row]) / (2.0 * by) + damping * laplacian;
                // Object 0 is tied: its diagonal block holds its own trace on top.
                if !(object == 0 && other == 0) {
                    prop_assert!((got[row] - wanted).abs() < 1e-4 * (1.0 + wanted.abs()), "{got:?} {wanted}");
                }
            }
        }
    }

    #[test]
    fn the_minimum_is_that_of_majorisation(n in 6_usize..40, seed in 0_u64..1000) {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let truth = random_points(n, &mut rng);
        let blurred = pairs_within(&truth, 1.0).pairs().iter().map(|pair| Pair {
            distance: pair.distance * rng.random_range(0.9..1.1),
            weight: rng.random_range(0.2..5.0),
            ..*pair
        }).collect();
        let pairs = PairDistances::new(n, blurred).unwrap();
        let fast = newton(&pairs, &truth, TO_THE_END).unwrap();
        let slow = smacof(&pairs, &truth, TO_THE_END).unwrap();
        prop_assert!((fast.stress - slow.stress).abs() < 1e-6 * (1e-3 + slow.stress), "{} {}", fast.stress, slow.stress);
    }
}

#[test]
fn a_long_bent_strip_needs_few_steps() {
    // A corridor of 2 x 100 units with links up to 1.2, bent into an arc of half a radian: every known
    // distance is nearly right, and yet the ends are far from where they belong.
    let mut rng = ChaCha8Rng::seed_from_u64(17);
    let truth: Vec<Point> =
        (0..800).map(|_| [rng.random_range(0.0..100.0), rng.random_range(0.0..2.0)]).collect();
    let pairs = pairs_within(&truth, 1.2);
    let bent = jittered(&truth, 0.1, &mut rng).into_iter().map(|[x, y]| {
        let (radius, angle) = (200.0, x / 200.0);
        [(radius - y) * angle.sin(), radius - (radius - y) * angle.cos()]
    });
    let bent: Vec<Point> = bent.collect();
    let fast = newton(&pairs, &bent, after(30)).unwrap();
    let plain = Smacof { steps: Steps::Plain, stop: after(300), ..Smacof::default() };
    let slow = plain.from_start(&pairs, &bent).unwrap().embedding;
    assert!(fast.stress < 1e-3 * slow.stress, "newton {}, majorisation {}", fast.stress, slow.stress);
}

#[test]
fn a_component_stays_about_where_it_was() {
    let truth = [[40.0, 7.0], [41.0, 7.0], [41.0, 8.0], [40.0, 8.0]];
    let pairs = pairs_within(&truth, 9.0);
    let pairs = PairDistances::new(5, pairs.pairs().to_vec()).unwrap();
    let start = [[40.0, 7.0], [41.2, 7.0], [41.0, 8.1], [40.0, 8.0], [-3.0, 2.0]];
    let solved = newton(&pairs, &start, TO_THE_END).unwrap().points;
    assert!(solved[..4].iter().all(|[x, y]| (x - 40.5).abs() < 1.0 && (y - 7.5).abs() < 1.0), "{solved:?}");
    assert_eq!(solved[4], [-3.0, 2.0]);
}
