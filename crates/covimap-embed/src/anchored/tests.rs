use proptest::prelude::*;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use super::*;
use crate::solve::tests::{TO_THE_END, after, cases, jittered, pairs_within, random_points, random_problem};
use crate::stress::raw_stress;
use crate::{Pair, Termination, newton};

fn anchored(pairs: &PairDistances, start: &[Point], held: &[bool], stop: StopRule) -> Embedding {
    anchored_while(pairs, start, held, stop, || true).unwrap()
}

proptest! {
    #![proptest_config(cases(32))]

    #[test]
    fn what_is_held_stays_and_the_stress_never_rises(n in 2_u32..25, seed in 0_u64..1000, every in 1_usize..5) {
        let (pairs, start) = random_problem(n, seed);
        let held: Vec<bool> = (0..n as usize).map(|object| object % every == 0).collect();
        let solved = anchored(&pairs, &start, &held, after(20));
        prop_assert!(solved.stress <= raw_stress(&pairs, &start));
        for ((before, after), held) in start.iter().zip(&solved.points).zip(held) {
            prop_assert!(!held || before == after);
        }
    }
}

#[test]
fn free_objects_find_their_true_places_among_those_held() {
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    let truth = random_points(80, &mut rng);
    let pairs = pairs_within(&truth, 0.8);
    let held: Vec<bool> = (0..80).map(|object| object >= 30).collect();
    let mut start = jittered(&truth, 0.1, &mut rng);
    start[30..].copy_from_slice(&truth[30..]);
    let solved = anchored(&pairs, &start, &held, TO_THE_END);
    assert_eq!(solved.termination, Termination::Converged);
    for (found, truth) in solved.points.iter().zip(&truth) {
        assert!((found[0] - truth[0]).hypot(found[1] - truth[1]) < 1e-6, "{found:?} {truth:?}");
    }
}

#[test]
fn the_minimum_over_all_objects_is_a_minimum_over_some() {
    let mut rng = ChaCha8Rng::seed_from_u64(7);
    let points = random_points(60, &mut rng);
    let exact = pairs_within(&points, 0.8);
    let noisy = exact.pairs().iter().enumerate();
    let noisy =
        noisy.map(|(k, pair)| Pair { distance: pair.distance * (0.9 + 0.2 * (k % 7) as f64 / 6.0), ..*pair });
    let pairs = PairDistances::new(60, noisy.collect()).unwrap();
    let least = newton(&pairs, &points, TO_THE_END).unwrap().points;
    let held: Vec<bool> = (0..60).map(|object| object >= 20).collect();
    let mut start = jittered(&least, 0.05, &mut rng);
    start[20..].copy_from_slice(&least[20..]);
    let solved = anchored(&pairs, &start, &held, TO_THE_END);
    for (found, least) in solved.points.iter().zip(&least) {
        assert!((found[0] - least[0]).hypot(found[1] - least[1]) < 1e-4, "{found:?} {least:?}");
    }
}

#[test]
fn nothing_free_and_nothing_at_all() {
    let pair = Pair { i: 0, j: 1, distance: 1.0, weight: 1.0 };
    let pairs = PairDistances::new(2, vec![pair]).unwrap();
    let start = [[0.0, 0.0], [3.0, 0.0]];
    let solved = anchored(&pairs, &start, &[true, true], after(10));
    assert_eq!((solved.points.as_slice(), solved.termination), (start.as_slice(), Termination::Converged));
    let none = PairDistances::new(0, Vec::new()).unwrap();
    assert_eq!(anchored(&none, &[], &[], after(10)).termination, Termination::Converged);
    // One is held, the other comes to the distance asked of it.
    let solved = anchored(&pairs, &start, &[true, false], TO_THE_END);
    assert!((solved.points[1][0] - 1.0).abs() < 1e-12 && solved.points[1][1] == 0.0, "{solved:?}");
}

#[test]
fn a_list_of_those_held_must_fit_and_a_caller_may_stop() {
    let (pairs, start) = random_problem(10, 1);
    let error = anchored_while(&pairs, &start, &[true], after(1), || true).unwrap_err();
    assert!(matches!(error, EmbedError::BadStart { found: 1, wanted: 10, .. }), "{error}");
    let stopped = anchored_while(&pairs, &start, &[false; 10], after(9), || false).unwrap();
    assert_eq!((stopped.termination, stopped.points), (Termination::Interrupted, start));
}
