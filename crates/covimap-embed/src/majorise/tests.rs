use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::*;
use crate::stress::{distance, raw_stress};
use crate::{Pair, PairBounds, Scaling, StopRule, Ties, Transformation, random_starts, torgerson_start};

/// Dissimilarities that no plane has, with ties; each pair listed with the given probability, the
/// path through all objects always.
fn problem(n: u32, listed: f64, weighted: bool, seed: u64) -> PairDistances {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut pairs = Vec::new();
    for (i, j) in (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j))) {
        if j == i + 1 || rng.random_bool(listed) {
            let weight = if weighted { 10f64.powf(rng.random_range(-2.0..2.0)) } else { 0.5 };
            pairs.push(Pair { i, j, distance: f64::from(rng.random_range(0..8)), weight });
        }
    }
    PairDistances::new(n as usize, pairs).unwrap()
}

fn all_transformations(pairs: &PairDistances) -> Vec<Transformation> {
    let lower: Vec<f64> = pairs.pairs().iter().map(|pair| 0.5 * pair.distance).collect();
    let upper = pairs.pairs().iter().map(|pair| if pair.i % 2 == 0 { f64::INFINITY } else { pair.distance });
    let bounds = PairBounds::new(lower, upper.collect()).unwrap();
    vec![
        Transformation::Ratio,
        Transformation::Interval,
        Transformation::Ordinal(Ties::Primary),
        Transformation::Ordinal(Ties::Secondary),
        Transformation::Ordinal(Ties::Tertiary),
        Transformation::MSpline { degree: 2, interior_knots: 2 },
        Transformation::Bounds(bounds),
    ]
}

fn after(max_iterations: usize) -> StopRule {
    StopRule { max_iterations, tolerance: 0.0 }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, rng_seed: RngSeed::Fixed(3), ..ProptestConfig::default() })]

    #[test]
    fn the_stress_never_rises_and_is_that_of_the_result(
        n in 2_u32..16,
        listed in prop_oneof![Just(1.0), 0.1..0.9],
        weighted: bool,
        take in prop_oneof![Just(Steps::Plain), Just(Steps::Relaxed), Just(Steps::QuasiNewton)],
        warm: bool,
        steps in 0_usize..40,
        seed in 0_u64..1000,
    ) {
        let pairs = problem(n, listed, weighted, seed);
        let start = random_starts(&pairs, 1, seed).remove(0);
        let size: f64 = pairs.pairs().iter().map(|pair| pair.weight * pair.distance.powi(2)).sum();
        for transformation in all_transformations(&pairs) {
            let how = Smacof { transformation, steps: take, warm, relocations: 0, stop: after(steps) };
            let Scaling { embedding, disparities, trace } = how.from_start(&pairs, &start).unwrap();
            for (step, pair) in trace.windows(2).enumerate() {
                prop_assert!(
                    pair[1] <= pair[0] * (1.0 + 1e-9) + 1e-20 * size,
                    "{:?}, step {}: {} to {}", how.transformation, step, pair[0], pair[1]
                );
            }
            prop_assert_eq!(trace.len(), embedding.iterations + 1);
            prop_assert_eq!(trace[embedding.iterations], embedding.stress);

            // From the returned points and disparities alone.
            let (mut residual, mut target, mut extent) = (0.0, 0.0, 0.0);
            for (pair, e) in pairs.pairs().iter().zip(&disparities) {
                let r = distance(embedding.points[pair.i as usize], embedding.points[pair.j as usize]);
                residual += pair.weight * (r - e).powi(2);
                target += pair.weight * e * e;
                extent += pair.weight * r * r;
            }
            let near = |found: f64, expected: f64| (found - expected).abs() <= 1e-12 * expected + 1e-20 * size;
            prop_assert!(near(embedding.stress, residual));
            prop_assert!(near(embedding.normalised_stress * target, residual));
            prop_assert!(near(embedding.stress1.powi(2) * extent, residual));
            // And the disparities are the ones that fit the points: fitting again changes nothing.
            let mut again = disparities.clone();
            if steps > 0 || warm {
                let rule = Disparities::new(&pairs, &how.transformation).unwrap();
                again = rule.fit(&embedding.points).unwrap_or(again);
            }
            for (again, e) in again.iter().zip(&disparities) {
                prop_assert!((again - e).abs() <= 1e-9 * (1.0 + e));
            }
        }
    }
}

#[test]
fn relaxed_steps_do_not_depend_on_the_size_of_the_start() {
    let pairs = problem(12, 1.0, true, 4);
    let start = random_starts(&pairs, 1, 4).remove(0);
    let thousandfold: Vec<Point> = start.iter().map(|point| point.map(|x| 1000.0 * x)).collect();
    let how = Smacof { steps: Steps::Relaxed, stop: after(30), ..Smacof::default() };
    let [a, b] = [start, thousandfold].map(|start| how.from_start(&pairs, &start).unwrap().trace);
    for (a, b) in a.iter().zip(&b).skip(1) {
        assert!((a - b).abs() < 1e-9 * a);
    }
}

#[test]
fn longer_steps_are_fewer_and_lead_as_low() {
    let pairs = problem(20, 1.0, false, 9);
    let start = torgerson_start(&pairs).unwrap();
    let stop = StopRule { max_iterations: 100_000, tolerance: 1e-11 };
    let run =
        |steps| Smacof { steps, stop, ..Smacof::default() }.from_start(&pairs, &start).unwrap().embedding;
    let [plain, relaxed, learnt] = [Steps::Plain, Steps::Relaxed, Steps::QuasiNewton].map(run);
    for other in [&relaxed, &learnt] {
        assert!((other.stress / plain.stress - 1.0).abs() < 1e-8, "{} {}", other.stress, plain.stress);
    }
    assert!(3 * relaxed.iterations < 2 * plain.iterations, "{} {}", relaxed.iterations, plain.iterations);
    assert!(2 * learnt.iterations < relaxed.iterations, "{} {}", learnt.iterations, relaxed.iterations);
}

#[test]
fn distances_of_the_plane_are_found_exactly() {
    // Relaxed steps alone would keep an error of size; here nothing must be left.
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    let truth: Vec<Point> = (0..30).map(|_| [rng.random(), rng.random()]).collect();
    let pair = |(i, j)| Pair { i, j, distance: distance(truth[i as usize], truth[j as usize]), weight: 1.0 };
    let pairs = (0..30).flat_map(|i| (i + 1..30).map(move |j| (i, j))).map(pair).collect();
    let pairs = PairDistances::new(30, pairs).unwrap();
    let start: Vec<Point> =
        truth.iter().map(|p| [3.0 * p[0] + rng.random_range(-0.1..0.1), 3.0 * p[1]]).collect();
    let solved = Smacof::default().from_start(&pairs, &start).unwrap().embedding;
    assert_eq!(solved.termination, Termination::Converged);
    assert!(solved.normalised_stress < 1e-20, "{}", solved.normalised_stress);
}

#[test]
fn a_warm_start_stays_where_it_is() {
    let pairs = problem(15, 1.0, true, 6);
    let start = torgerson_start(&pairs).unwrap();
    for transformation in all_transformations(&pairs) {
        let stop = StopRule { max_iterations: 20_000, tolerance: 1e-9 };
        let cold = Smacof { transformation, stop, ..Smacof::default() };
        let solved = cold.from_start(&pairs, &start).unwrap().embedding;
        let warm = Smacof { warm: true, ..cold };
        let again = warm.from_start(&pairs, &solved.points).unwrap();
        assert!(again.embedding.iterations <= 3, "{:?}: {}", warm.transformation, again.embedding.iterations);
        assert!((again.trace[0] / solved.stress - 1.0).abs() < 1e-9, "{:?}", warm.transformation);
    }
}

#[test]
fn a_random_start_leads_as_low_under_a_transformation_as_without() {
    // What the wider sets admit contains the dissimilarities: their least stress is not above.
    let pairs = problem(30, 1.0, true, 8);
    let starts = random_starts(&pairs, 10, 8);
    let least = |transformation| {
        let how = Smacof { transformation, ..Smacof::default() };
        how.from_starts(&pairs, &starts).unwrap().best.embedding.stress
    };
    let ratio = least(Transformation::Ratio);
    for transformation in all_transformations(&pairs) {
        let found = least(transformation.clone());
        assert!(found <= ratio, "{transformation:?}: {found} {ratio}");
    }
}

#[test]
fn bounds_push_unseen_pairs_apart() {
    // A chain of four links of length 1, known to span at least 3.5 from end to end, and nothing
    // else: any bend with the ends that far apart has no stress.
    let link = |i| Pair { i, j: i + 1, distance: 1.0, weight: 1.0 };
    let ends = Pair { i: 0, j: 4, distance: 4.0, weight: 1.0 };
    let pairs = PairDistances::new(5, vec![link(0), ends, link(1), link(2), link(3)]).unwrap();
    let bounds = PairBounds::new(vec![1.0, 3.5, 1.0, 1.0, 1.0], vec![1.0, f64::INFINITY, 1.0, 1.0, 1.0]);
    let how =
        Smacof { transformation: Transformation::Bounds(bounds.unwrap()), warm: true, ..Smacof::default() };
    let start = [[0.0, 0.0], [0.9, 0.5], [1.0, 1.0], [0.5, 1.5], [-0.5, 1.0]];
    let solved = how.from_start(&pairs, &start).unwrap();
    let points = &solved.embedding.points;
    // Below this no pair misses its bounds by more than 1e-3.
    assert!(solved.embedding.stress < 1e-6);
    assert!(distance(points[0], points[4]) > 3.5 - 1e-3);
    assert!((distance(points[1], points[2]) - 1.0).abs() < 1e-3);
}

#[test]
fn no_object_and_pairs_of_length_zero() {
    let none = PairDistances::new(0, vec![]).unwrap();
    for transformation in all_transformations(&none) {
        let how = Smacof { transformation, ..Smacof::default() };
        let solved = how.from_start(&none, &[]).unwrap();
        assert_eq!((solved.embedding.stress, solved.disparities.len()), (0.0, 0));
    }
    // All dissimilarities zero: all objects in one place, under any transformation of fixed size.
    let pair = |i, j| Pair { i, j, distance: 0.0, weight: 1.0 };
    let zeros = PairDistances::new(3, vec![pair(0, 1), pair(0, 2), pair(1, 2)]).unwrap();
    for transformation in &all_transformations(&zeros)[..6] {
        let how = Smacof { transformation: transformation.clone(), ..Smacof::default() };
        let solved = how.from_start(&zeros, &[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]).unwrap();
        assert_eq!(raw_stress(&zeros, &solved.embedding.points), 0.0, "{transformation:?}");
    }
}

#[test]
fn the_same_bits_on_one_thread_and_on_three() {
    let pairs = problem(120, 0.8, true, 2);
    let starts = random_starts(&pairs, 3, 2);
    for transformation in all_transformations(&pairs) {
        let how = Smacof { transformation, stop: after(5), ..Smacof::default() };
        let run = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| how.from_starts(&pairs, &starts).unwrap())
        };
        assert_eq!(run(1), run(3), "{:?}", how.transformation);
    }
}
