use proptest::prelude::*;

use super::*;
use crate::solve::tests::{cases, pairs_within, random_problem};
use crate::{Pair, StopRule, newton, raw_stress};

const CONVERGED: StopRule = StopRule { max_iterations: 300, tolerance: 1e-9 };

/// All pairs that are not listed are at least so far apart.
struct Beyond(f64);

impl Apart for Beyond {
    fn bound(&self, _: u32, _: u32) -> Bound {
        Bound { distance: self.0, weight: 1.0 }
    }

    fn longest(&self) -> f64 {
        self.0
    }
}

/// Streets, a unit wide, that meet in nine crossings 5 apart: twelve objects to the unit square.
fn streets(seed: u64) -> Vec<Point> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut points = Vec::new();
    while points.len() < 680 {
        let point = [0, 1].map(|_| 11.0 * rng.random::<f64>());
        if point.iter().any(|c: &f64| c % 5.0 < 1.0) {
            points.push(point);
        }
    }
    points
}

/// Pairs up to 0.9 apart, their distances off by up to a tenth.
fn noisy_pairs(truth: &[Point], seed: u64) -> PairDistances {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let exact = pairs_within(truth, 0.9);
    let off = |pair: &Pair| Pair { distance: pair.distance * rng.random_range(0.9..1.1), ..*pair };
    PairDistances::new(truth.len(), exact.pairs().iter().map(off).collect()).unwrap()
}

/// One of five of the squares two units wide lies mirrored, as local maps that were put together wrongly.
fn twisted(points: &[Point], seed: u64) -> Vec<Point> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mirrored: Vec<bool> = (0..36).map(|_| rng.random_bool(0.2)).collect();
    let turn = |&[x, y]: &Point| {
        let [column, line] = [x, y].map(|c| (c / 2.0) as usize);
        if mirrored[6 * line + column] { [x, 2.0 * (2 * line + 1) as f64 - y] } else { [x, y] }
    };
    points.iter().map(turn).collect()
}

/// Every map gets better, and all together lose more than half of what they have too much; two of them lose all of it.
#[test]
fn what_lies_mirrored_is_turned_round() {
    let (mut before, mut after, mut undone) = (0.0, 0.0, Vec::new());
    for seed in 0..12 {
        let truth = streets(seed);
        let pairs = noisy_pairs(&truth, seed);
        let best = newton(&pairs, &truth, CONVERGED).unwrap().stress;
        let wrong = newton(&pairs, &twisted(&truth, seed), CONVERGED).unwrap();
        let untwisted = lift(&pairs, &wrong.points, &Beyond(0.9), seed, || true).unwrap();
        let right = newton(&pairs, &untwisted, CONVERGED).unwrap().stress;
        assert!(right < 0.9 * wrong.stress, "seed {seed}: {} {right}", wrong.stress);
        before += wrong.stress - best;
        after += right - best;
        if right < 1.001 * best {
            undone.push(seed);
        }
    }
    assert!(after < 0.5 * before, "{after} of {before}");
    assert_eq!(undone, [0, 5]);
}

#[test]
fn a_map_that_is_right_stays_right() {
    for seed in 0..4 {
        let truth = streets(seed);
        let pairs = noisy_pairs(&truth, seed);
        let best = newton(&pairs, &truth, CONVERGED).unwrap();
        let lifted = lift(&pairs, &best.points, &Beyond(0.9), seed, || true).unwrap();
        let again = newton(&pairs, &lifted, CONVERGED).unwrap();
        assert!(again.stress < (1.0 + 1e-3) * best.stress, "seed {seed}: {} {}", again.stress, best.stress);
    }
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let truth = streets(3);
    let pairs = noisy_pairs(&truth, 3);
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| lift(&pairs, &twisted(&truth, 3), &Beyond(0.9), 3, || true).unwrap())
    };
    assert_eq!(on(1), on(3));
}

#[test]
fn it_stops_when_it_is_told_to() {
    let truth = streets(1);
    let pairs = noisy_pairs(&truth, 1);
    let mut asked = 0;
    let stopped = lift(&pairs, &truth, &Beyond(0.9), 1, || {
        asked += 1;
        asked <= 5
    });
    assert_eq!(asked, 6);
    assert!(stopped.unwrap().iter().flatten().all(|c| c.is_finite()));
    asked = 0;
    lift(&pairs, &truth, &Beyond(0.9), 1, || {
        asked += 1;
        true
    })
    .unwrap();
    assert!(asked <= LIFT_STEPS, "{asked}");
}

#[test]
fn no_object_one_object_no_pair_and_one() {
    let apart = Beyond(1.0);
    let none = PairDistances::new(0, Vec::new()).unwrap();
    assert_eq!(lift(&none, &[], &apart, 0, || true).unwrap(), Vec::<Point>::new());
    let alone = PairDistances::new(1, Vec::new()).unwrap();
    assert_eq!(lift(&alone, &[[2.0, 1.0]], &apart, 0, || true).unwrap(), [[2.0, 1.0]]);
    let pair = Pair { i: 0, j: 1, distance: 3.0, weight: 2.0 };
    let two = PairDistances::new(2, vec![pair]).unwrap();
    let points = lift(&two, &[[0.0, 0.0], [1.0, 0.0]], &apart, 0, || true).unwrap();
    assert!(raw_stress(&two, &points) < 1e-2, "{points:?}");
    // Objects that coincide in the plane rest on each other, as in newton.
    let all = (0..4).flat_map(|i| (i + 1..4).map(move |j| Pair { i, j, distance: 1.0, weight: 1.0 }));
    let four = PairDistances::new(4, all.collect()).unwrap();
    assert_eq!(lift(&four, &[[0.0; 2]; 4], &apart, 0, || true).unwrap(), [[0.0; 2]; 4]);
    let error = lift(&two, &[[f64::NAN, 0.0], [1.0, 0.0]], &apart, 0, || true).unwrap_err();
    assert!(matches!(error, EmbedError::BadStart { .. }), "{error}");
}

/// A problem with bounds, raised and pressed a little.
fn raised_problem(n: u32, seed: u64) -> (Unfolding, Vec<f64>) {
    let (pairs, points) = random_problem(n, seed);
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut problem = Unfolding::of(&pairs).unwrap();
    let x: Vec<f64> =
        points.iter().flat_map(|&[x, y]| [x, y, rng.random::<f64>(), rng.random::<f64>()]).collect();
    problem.press = 0.25;
    problem.bounds = too_near(x.as_chunks().0, &problem.links, &Beyond(1.5));
    (problem, x)
}

proptest! {
    #![proptest_config(cases(32))]

    #[test]
    fn the_gradient_is_that_of_half_the_value(n in 2_u32..12, seed in 0_u64..1000) {
        let (problem, x) = raised_problem(n, seed);
        let (value, gradient) = problem.at(&x);
        for (unknown, derivative) in gradient.into_iter().enumerate() {
            let at = |by: f64| {
                let mut moved = x.clone();
                moved[unknown] += by;
                problem.at(&moved).0 / 2.0
            };
            let by = 1e-6;
            let rise = (at(by) - at(-by)) / (2.0 * by);
            prop_assert!((rise - derivative).abs() < 1e-4 * (1.0 + value), "{unknown}: {rise} {derivative}");
        }
    }

    /// `V + mu_0 diag(w)`, but for the tie of the last object of each component, in all four coordinates while the
    /// press is soft; then the diagonal for those that are to go.
    #[test]
    fn the_preconditioner_solves_its_own_matrix(n in 2_u32..12, seed in 0_u64..1000, firm in any::<bool>()) {
        let (pairs, _) = random_problem(n, seed);
        let mut problem = Unfolding::of(&pairs).unwrap();
        problem.press = if firm { 0.5 } else { SOFT };
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let y: Vec<Lifted> = (0..n).map(|_| std::array::from_fn(|_| rng.random())).collect();
        let mut solved = y.clone();
        problem.precondition(solved.as_flattened_mut());
        let (component, sizes) = crate::laplacian::components(n as usize, pairs.pairs().iter().map(|p| (p.i, p.j)));
        let last = |c: u32| component.iter().rposition(|&other| other == c).unwrap();
        let tied: Vec<usize> = (0..sizes.len() as u32).map(last).collect();
        for own in (0..n as usize).filter(|own| !tied.contains(own)) {
            let mut product = [0.0; 4];
            for pair in pairs.pairs() {
                let other = match own as u32 {
                    end if end == pair.i => pair.j,
                    end if end == pair.j => pair.i,
                    _ => continue,
                };
                for axis in 0..4 {
                    let here = solved[own][axis];
                    product[axis] += pair.weight * match (firm, axis) {
                        (true, 2..) => 1.5 * here,
                        _ => here - solved[other as usize][axis] + PRESS[0] * here,
                    };
                }
            }
            for axis in 0..4 {
                prop_assert!((product[axis] - y[own][axis]).abs() < 1e-9, "{product:?} {:?}", y[own]);
            }
        }
    }

    #[test]
    fn near_pairs_are_those_of_looking_at_all(n in 2_u32..40, seed in 0_u64..1000, bound in 0.1_f64..2.0) {
        let (pairs, points) = random_problem(n, seed);
        let x: Vec<Lifted> = points.iter().enumerate().map(|(k, &[x, y])| [x, y, 0.1 * k as f64, 0.0]).collect();
        let found = too_near(&x, &Springs::of_pairs(&pairs), &Beyond(bound));
        for own in 0..n {
            let listed = |to: u32| {
                pairs.pairs().iter().any(|pair| (pair.i, pair.j) == (own.min(to), own.max(to)))
            };
            let near = |to: u32| length(x[own as usize], x[to as usize]) < near::AHEAD * bound;
            let wanted: Vec<u32> = (0..n).filter(|&to| to != own && near(to) && !listed(to)).collect();
            let got: Vec<u32> = found.of(own as usize).iter().map(|spring| spring.to).collect();
            prop_assert_eq!(got, wanted);
        }
    }
}
