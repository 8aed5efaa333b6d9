//! What every iterative solver keeps to, and the problems that its own tests take as well.

use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::*;
use crate::stress::{distance, raw_stress, stress1};
use crate::{Pair, newton, smacof};

type Solver = fn(&PairDistances, &[Point], StopRule) -> Result<Embedding, EmbedError>;

const SOLVERS: [(&str, Solver); 2] = [("smacof", smacof), ("newton", newton)];

/// A rule that lets a solver go on until rounding stops it.
pub(crate) const TO_THE_END: StopRule = StopRule { max_iterations: 20_000, tolerance: 1e-15 };

/// So many cases, the same ones in every run.
pub(crate) fn cases(cases: u32) -> ProptestConfig {
    ProptestConfig {
        cases,
        rng_seed: RngSeed::Fixed(1),
        failure_persistence: None,
        ..ProptestConfig::default()
    }
}

pub(crate) fn after(max_iterations: usize) -> StopRule {
    StopRule { max_iterations, tolerance: 0.0 }
}

pub(crate) fn random_points(n: usize, rng: &mut ChaCha8Rng) -> Vec<Point> {
    (0..n).map(|_| [rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0)]).collect()
}

/// A connected problem that no configuration solves exactly, with weights over six decades, and
/// a start that has nothing to do with it.
pub(crate) fn random_problem(n: u32, seed: u64) -> (PairDistances, Vec<Point>) {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut pairs = Vec::new();
    for i in 0..n {
        for j in i + 1..n {
            // The path 0 - 1 - 2 .. connects all; a fifth of the other pairs come on top.
            if j == i + 1 || rng.random_bool(0.2) {
                let weight = 10f64.powf(rng.random_range(-3.0..3.0));
                pairs.push(Pair { i, j, distance: rng.random_range(0.0..2.0), weight });
            }
        }
    }
    (PairDistances::new(n as usize, pairs).unwrap(), random_points(n as usize, &mut rng))
}

/// The true distances of all pairs of points that are nearer than `reach`.
pub(crate) fn pairs_within(points: &[Point], reach: f64) -> PairDistances {
    let mut pairs = Vec::new();
    for (i, &a) in points.iter().enumerate() {
        for (j, &b) in points.iter().enumerate().skip(i + 1).filter(|&(_, &b)| distance(a, b) < reach) {
            pairs.push(Pair { i: i as u32, j: j as u32, distance: distance(a, b), weight: 1.0 });
        }
    }
    PairDistances::new(points.len(), pairs).unwrap()
}

pub(crate) fn jittered(points: &[Point], size: f64, rng: &mut ChaCha8Rng) -> Vec<Point> {
    let mut moved = |x: f64| x + rng.random_range(-size..size);
    points.iter().map(|point| point.map(&mut moved)).collect()
}

proptest! {
    #![proptest_config(cases(64))]

    #[test]
    fn no_step_raises_the_stress(n in 2_u32..25, seed in 0_u64..1000) {
        let (pairs, start) = random_problem(n, seed);
        for (name, solve) in SOLVERS {
            let mut points = start.clone();
            for step in 0..12 {
                let before = raw_stress(&pairs, &points);
                let solved = solve(&pairs, &points, after(1)).unwrap();
                let most = before * (1.0 + 1e-12) + negligible_stress(&pairs);
                prop_assert!(solved.stress <= most, "{name}, step {step}: {before} to {}", solved.stress);
                points = solved.points;
            }
        }
    }

    #[test]
    fn the_report_describes_the_points(n in 0_u32..25, seed in 0_u64..1000, steps in 0_usize..9) {
        let (pairs, start) = random_problem(n, seed);
        for (name, solve) in SOLVERS {
            let solved = solve(&pairs, &start, after(steps)).unwrap();
            prop_assert_eq!(solved.points.len(), n as usize);
            prop_assert_eq!(solved.stress, raw_stress(&pairs, &solved.points), "{}", name);
            prop_assert_eq!(solved.stress1, stress1(&pairs, &solved.points), "{}", name);
            prop_assert!(solved.iterations <= steps);
        }
    }
}

#[test]
fn an_exact_configuration_is_found_again_from_nearby() {
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    let truth = random_points(60, &mut rng);
    let pairs = pairs_within(&truth, 0.9);
    let start = jittered(&truth, 0.1, &mut rng);
    for (name, solve) in SOLVERS {
        let solved = solve(&pairs, &start, TO_THE_END).unwrap();
        assert_eq!(solved.termination, Termination::Converged, "{name}");
        // All pairs, the listed and the others: the shape as a whole is the true one.
        for i in 0..60 {
            for j in 0..i {
                let miss = distance(solved.points[i], solved.points[j]) - distance(truth[i], truth[j]);
                assert!(miss.abs() < 1e-6, "{name}: pair ({i}, {j}) is off by {miss}");
            }
        }
    }
}

#[test]
fn a_limit_of_steps_is_kept_and_told() {
    let (pairs, start) = random_problem(20, 5);
    for (name, solve) in SOLVERS {
        for limit in [0, 1, 3] {
            let solved = solve(&pairs, &start, after(limit)).unwrap();
            assert_eq!(
                (solved.iterations, solved.termination),
                (limit, Termination::IterationLimit),
                "{name}"
            );
        }
        assert_eq!(solve(&pairs, &start, after(0)).unwrap().points, start, "{name}");
        let rule = StopRule { max_iterations: 20_000, tolerance: 1e-6 };
        let solved = solve(&pairs, &start, rule).unwrap();
        assert_eq!(solved.termination, Termination::Converged, "{name}");
        // The next step gains less than the tolerance, or the rule stopped too early.
        let next = solve(&pairs, &solved.points, after(1)).unwrap();
        assert!(solved.stress - next.stress <= 1e-6 * solved.stress, "{name}");
    }
}

#[test]
fn a_perfect_start_is_done_at_once() {
    let truth = random_points(12, &mut ChaCha8Rng::seed_from_u64(8));
    for (name, solve) in SOLVERS {
        let solved = solve(&pairs_within(&truth, 9.0), &truth, TO_THE_END).unwrap();
        assert!(solved.stress < 1e-24, "{name}: {}", solved.stress);
        assert!(solved.iterations <= 1, "{name}: {} steps", solved.iterations);
    }
}

#[test]
fn a_start_that_does_not_fit_is_refused() {
    let (pairs, start) = random_problem(4, 1);
    for (_, solve) in SOLVERS {
        let refusal = |start: &[Point]| {
            let error = solve(&pairs, start, after(5)).unwrap_err();
            assert!(matches!(error, EmbedError::BadStart { .. }));
            error.to_string()
        };
        assert_eq!(
            refusal(&start[1..]),
            "start configuration: wrong number of points - 3 points for 4 objects; give one finite point an object"
        );
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let mut start = start.clone();
            start[2][1] = bad;
            assert!(refusal(&start).starts_with("start configuration: a coordinate is not finite"));
        }
    }
}

#[test]
fn no_object_one_object_and_two() {
    for (name, solve) in SOLVERS {
        let none = solve(&PairDistances::new(0, vec![]).unwrap(), &[], TO_THE_END).unwrap();
        assert_eq!((none.points.len(), none.stress, none.stress1), (0, 0.0, 0.0), "{name}");
        let one = solve(&PairDistances::new(1, vec![]).unwrap(), &[[3.0, -1.0]], TO_THE_END).unwrap();
        assert_eq!((one.stress, one.termination), (0.0, Termination::Converged), "{name}");
        assert!(one.points[0].iter().all(|c| c.is_finite()), "{name}");
        let pair = Pair { i: 0, j: 1, distance: 2.0, weight: 0.5 };
        let two = PairDistances::new(2, vec![pair]).unwrap();
        let solved = solve(&two, &[[0.0, 0.0], [0.3, 0.4]], TO_THE_END).unwrap();
        assert!((distance(solved.points[0], solved.points[1]) - 2.0).abs() < 1e-9, "{name}");
    }
}

#[test]
fn objects_that_coincide_at_the_start() {
    // A square with its diagonals, objects 0 and 1 in one place: their pair rests until the other
    // pairs have pulled them apart.
    let truth = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let pairs = pairs_within(&truth, 9.0);
    for (name, solve) in SOLVERS {
        let solved = solve(&pairs, &[[0.5, 0.1], [0.5, 0.1], [1.0, 1.0], [0.0, 1.0]], TO_THE_END).unwrap();
        assert!(solved.stress < 1e-9, "{name}: {}", solved.stress);
    }
    // All in one place: nothing tells which way is apart, so they stay, and the stress tells.
    for (name, solve) in SOLVERS {
        let solved = solve(&pairs, &[[0.25, 4.0]; 4], TO_THE_END).unwrap();
        // Four sides of 1 and two diagonals of sqrt 2: 4 + 2 * 2.
        assert!((solved.stress - 8.0).abs() < 1e-12, "{name}: {}", solved.stress);
    }
}

#[test]
fn components_do_not_feel_each_other() {
    // Twelve objects, one without pairs, and fifteen more.
    let (first, start) = random_problem(12, 21);
    let (second, more) = random_problem(15, 22);
    let moved = second.pairs().iter().map(|pair| Pair { i: pair.i + 13, j: pair.j + 13, ..*pair });
    let both = PairDistances::new(28, first.pairs().iter().copied().chain(moved).collect()).unwrap();
    let all: Vec<Point> = start.iter().chain(&[[7.0, 7.0]]).chain(&more).copied().collect();
    for (name, solve) in SOLVERS {
        let together = solve(&both, &all, TO_THE_END).unwrap();
        let apart = [solve(&first, &start, TO_THE_END).unwrap(), solve(&second, &more, TO_THE_END).unwrap()];
        let stress = [(&first, &together.points[..12]), (&second, &together.points[13..])]
            .map(|(pairs, points)| raw_stress(pairs, points));
        for (stress, alone) in stress.iter().zip(&apart) {
            let miss = (stress - alone.stress).abs();
            assert!(miss < 1e-6 * alone.stress, "{name}: {stress} {}", alone.stress);
        }
    }
}

#[test]
fn weights_that_differ_hugely() {
    // A heavy triangle of sides 3, 4, 5, and an object 3 that hangs on two of its corners by light pairs.
    // Majorisation solves a system whose condition is the ratio of the weights, and so has fewer digits.
    for (name, solve, ratio) in [("smacof", smacof as Solver, 1e6), ("newton", newton, 1e12)] {
        let pair = |i, j, distance, weight| Pair { i, j, distance, weight };
        let pairs = vec![
            pair(0, 1, 3.0, ratio),
            pair(0, 2, 4.0, ratio),
            pair(0, 3, 2.0, 1.0),
            pair(1, 2, 5.0, ratio),
            pair(1, 3, 20.0, 1.0),
        ];
        let pairs = PairDistances::new(4, pairs).unwrap();
        let start = [[0.1, 0.2], [3.0, 0.3], [0.4, 4.0], [-1.0, 0.5]];
        let solved = solve(&pairs, &start, TO_THE_END).unwrap();
        let side = |i: usize, j: usize| distance(solved.points[i], solved.points[j]);
        for (i, j, wanted) in [(0, 1, 3.0), (0, 2, 4.0), (1, 2, 5.0)] {
            assert!((side(i, j) - wanted).abs() < 1e-4, "{name}: side ({i}, {j}) is {}", side(i, j));
        }
        // Object 3 ends on the line through 0 and 1, beyond 0, where both of its pairs miss alike:
        // r - 2 = 20 - (r + 3), so r = 9.5 and the stress is 2 * 7.5^2 = 112.5.
        assert!((side(0, 3) - 9.5).abs() < 1e-3, "{name}: {}", side(0, 3));
        assert!((solved.stress - 112.5).abs() < 0.01, "{name}: {}", solved.stress);
    }
}

#[test]
fn the_same_bits_on_one_thread_and_on_three() {
    let mut rng = ChaCha8Rng::seed_from_u64(13);
    let truth = random_points(900, &mut rng);
    // Some 14 000 pairs: several chunks of the parallel sums.
    let pairs = pairs_within(&truth, 0.22);
    assert!(pairs.pairs().len() > 10_000);
    let start = jittered(&truth, 0.05, &mut rng);
    for (name, solve) in SOLVERS {
        let run = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| solve(&pairs, &start, after(4)).unwrap())
        };
        assert_eq!(run(1), run(3), "{name}");
    }
}
