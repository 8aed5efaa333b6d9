use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use super::*;
use crate::Pair;
use crate::solve::tests::{pairs_within, random_points};

/// A right-angled triangle with legs 3 and 4, of which the pairs want 2, 4 and 6.
fn triangle() -> (PairDistances, [Point; 3]) {
    let pair = |i, j, distance, weight| Pair { i, j, distance, weight };
    let pairs = vec![pair(0, 1, 2.0, 1.0), pair(0, 2, 4.0, 5.0), pair(1, 2, 6.0, 0.5)];
    (PairDistances::new(3, pairs).unwrap(), [[1.0, 1.0], [4.0, 1.0], [1.0, 5.0]])
}

#[test]
fn stress_computed_by_hand() {
    let (pairs, points) = triangle();
    // 1 (3 - 2)^2 + 5 (4 - 4)^2 + 0.5 (5 - 6)^2 = 1.5.
    assert_eq!(raw_stress(&pairs, &points), 1.5);
    // Over 1 * 9 + 5 * 16 + 0.5 * 25 = 101.5.
    assert_eq!(stress1(&pairs, &points), (1.5_f64 / 101.5).sqrt());
}

#[test]
fn stress_without_pairs_and_without_extent() {
    let none = PairDistances::new(2, vec![]).unwrap();
    assert_eq!((raw_stress(&none, &[[0.0; 2]; 2]), stress1(&none, &[[0.0; 2]; 2])), (0.0, 0.0));
    let (pairs, _) = triangle();
    // All in one place: 1 * 4 + 5 * 16 + 0.5 * 36 = 102 over nothing.
    assert_eq!((raw_stress(&pairs, &[[7.0; 2]; 3]), stress1(&pairs, &[[7.0; 2]; 3])), (102.0, 0.0));
}

#[test]
fn every_pair_stands_in_the_rows_of_both_objects() {
    let pair = |i, j| Pair { i, j, distance: 1.0, weight: 1.0 };
    let pairs = PairDistances::new(5, vec![pair(0, 3), pair(1, 3), pair(1, 4)]).unwrap();
    let incidence = Incidence::new(&pairs);
    assert_eq!(incidence.of(0), [(3, 0)]);
    assert_eq!(incidence.of(1), [(3, 1), (4, 2)]);
    assert!(incidence.of(2).is_empty());
    assert_eq!(incidence.of(3), [(0, 0), (1, 1)]);
    assert_eq!(incidence.of(4), [(1, 2)]);
}

#[test]
fn sums_over_many_chunks_are_those_of_all_pairs() {
    let truth = random_points(300, &mut ChaCha8Rng::seed_from_u64(4));
    let pairs = pairs_within(&truth, 9.0);
    assert!(pairs.pairs().len() > 10 * CHUNK);
    let points = random_points(300, &mut ChaCha8Rng::seed_from_u64(5));
    let obvious: f64 = pairs
        .pairs()
        .iter()
        .map(|p| (distance(points[p.i as usize], points[p.j as usize]) - p.distance).powi(2))
        .sum();
    assert!((raw_stress(&pairs, &points) - obvious).abs() < 1e-10 * obvious);
}
