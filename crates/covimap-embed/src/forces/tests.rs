use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::*;
use crate::Pair;
use crate::stress::distance;

/// Pairs of `n` objects, each listed with the given probability, with equal weights or not, their
/// disparities, and points of which the first two coincide.
fn problem(n: u32, listed: f64, weighted: bool, seed: u64) -> (PairDistances, Vec<f64>, Vec<Point>) {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut pairs = Vec::new();
    for (i, j) in (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j))) {
        if rng.random_bool(listed) {
            let weight = if weighted { rng.random_range(0.1..9.0) } else { 2.5 };
            pairs.push(Pair { i, j, distance: 1.0, weight });
        }
    }
    let disparities = pairs.iter().map(|_| rng.random_range(0.0..2.0)).collect();
    let mut points: Vec<Point> =
        (0..n).map(|_| [rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0)]).collect();
    if n > 1 {
        points[1] = points[0];
    }
    (PairDistances::new(n as usize, pairs).unwrap(), disparities, points)
}

/// The sums of the module's head, one after the other.
fn oracle(pairs: &PairDistances, points: &[Point], disparities: &[f64]) -> Forces {
    let mut sums = Forces { stress: 0.0, forces: vec![[0.0; 2]; points.len()] };
    for (pair, e) in pairs.pairs().iter().zip(disparities) {
        let (i, j) = (pair.i as usize, pair.j as usize);
        let r = distance(points[i], points[j]);
        sums.stress += pair.weight * (e - r).powi(2);
        if r > 0.0 {
            let pull = pair.weight * (1.0 - e / r);
            let [x, y] = [points[i][0] - points[j][0], points[i][1] - points[j][1]];
            for (object, sign) in [(i, pull), (j, -pull)] {
                let sum = &mut sums.forces[object];
                *sum = [sum[0] + sign * x, sum[1] + sign * y];
            }
        }
    }
    sums
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 128, rng_seed: RngSeed::Fixed(1), ..ProptestConfig::default() })]

    // The sizes straddle the eight pairs that go together and, at the top, several tasks.
    #[test]
    fn every_layout_adds_up_the_same(
        n in prop_oneof![0_u32..40, Just(190)],
        listed in prop_oneof![Just(1.0), 0.0..1.0],
        weighted: bool,
        seed in 0_u64..1000,
    ) {
        let (pairs, disparities, points) = problem(n, listed, weighted, seed);
        let layout = PairLayout::new(&pairs);
        prop_assert_eq!(matches!(layout, PairLayout::Complete(_)), pairs.is_complete());
        let (found, expected) = (layout.forces(&points, &disparities), oracle(&pairs, &points, &disparities));
        prop_assert!((found.stress - expected.stress).abs() <= 1e-12 * expected.stress);
        for (found, expected) in found.forces.iter().flatten().zip(expected.forces.iter().flatten()) {
            prop_assert!((found - expected).abs() < 1e-9, "{} for {}", found, expected);
        }
    }
}

#[test]
fn worked_by_hand() {
    // A triangle with legs 3 and 4, disparities 2, 4 and 6, weights 1, 5 and 0.5:
    // stress 1 (3-2)^2 + 5 (4-4)^2 + 0.5 (5-6)^2 = 1.5, pulls w (1 - e / r) = 1/3, 0 and -0.1.
    let pair = |i, j, weight| Pair { i, j, distance: 1.0, weight };
    let pairs = PairDistances::new(3, vec![pair(0, 1, 1.0), pair(0, 2, 5.0), pair(1, 2, 0.5)]).unwrap();
    let points = [[0.0, 0.0], [3.0, 0.0], [0.0, 4.0]];
    let found = PairLayout::new(&pairs).forces(&points, &[2.0, 4.0, 6.0]);
    assert!((found.stress - 1.5).abs() < 1e-15);
    // On 0: 1/3 (-3, 0); on 1: 1/3 (3, 0) - 0.1 (3, -4); on 2: -0.1 (-3, 4).
    let expected = [[-1.0, 0.0], [0.7, 0.4], [0.3, -0.4]];
    for (found, expected) in found.forces.iter().flatten().zip(expected.iter().flatten()) {
        assert!((found - expected).abs() < 1e-14);
    }
}

#[test]
fn the_same_bits_on_one_thread_and_on_three() {
    for listed in [1.0, 0.3] {
        let (pairs, disparities, points) = problem(250, listed, true, 7);
        let layout = PairLayout::new(&pairs);
        let run = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let found = pool.install(|| layout.forces(&points, &disparities));
            (found.stress, found.forces)
        };
        assert_eq!(run(1), run(3));
    }
}
