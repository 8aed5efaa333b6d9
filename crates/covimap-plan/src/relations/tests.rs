use std::f64::consts::TAU;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::*;
use crate::fixtures::{index_of, lines_among, scattered, square_and_pair};

fn numbers(ids: &[LandmarkId]) -> Vec<u32> {
    ids.iter().map(|id| id.0).collect()
}

#[test]
fn left_is_counter_clockwise() {
    let index = square_and_pair();
    let turn = |a, b, c| index.orientation(a, b, c).unwrap();
    assert_eq!(turn("L0", "L1", "L2").orientation, Turn::Left);
    assert_eq!(turn("L0", "L1", "L3").orientation, Turn::Left);
    assert_eq!(turn("L1", "L0", "L2").orientation, Turn::Right);
    // Any order of the same three is as certain.
    let certain = turn("L0", "L1", "L2").probability;
    for (a, b, c) in [("L1", "L2", "L0"), ("L1", "L0", "L2"), ("L2", "L1", "L0")] {
        assert!((turn(a, b, c).probability - certain).abs() < 1e-12);
    }
    assert!(certain > 0.9 && certain < 1.0);
    assert_eq!(serde_json::to_value(turn("L1", "L0", "L2")).unwrap()["orientation"], "right");
}

#[test]
fn in_line_is_even_chance() {
    let index = index_of(&[[0.0, 0.0], [1.0, 1.0], [2.0, 2.0], [2.0, 2.0]], &[]);
    for c in ["L2", "L3"] {
        let even = Orientation { orientation: Turn::Left, probability: 0.5 };
        assert_eq!(index.orientation("L0", "L1", c).unwrap(), even);
    }
    let same = index_of(&[[1.0; 2]; 3], &[]);
    assert_eq!(same.orientation("L0", "L1", "L2").unwrap().probability, 0.5);
}

#[test]
fn the_probability_is_that_of_landmarks_strewn_by_their_covariances() {
    let points = scattered(40, 11);
    let index = index_of(&points, &lines_among(&points, 4));
    let mut random = ChaCha8Rng::seed_from_u64(6);
    let mut normal = || {
        let (u, v): (f64, f64) = (random.random_range(1e-12..1.0), random.random_range(0.0..TAU));
        (-2.0 * u.ln()).sqrt() * v.cos()
    };
    for ids in [[0, 1, 2], [3, 4, 5], [6, 7, 8], [9, 10, 11]].map(|ids: [u32; 3]| ids.map(LandmarkId)) {
        let told = index.turn(ids);
        let sides = [0, 1, 2].map(|i| crate::confidence::length(index.map(), ids[i], ids[(i + 1) % 3]));
        let growth = index.growth(0, sides.into_iter().fold(0.0, f64::max));
        let mut strewn = |id: LandmarkId| {
            let (covariance, [x, y]) = (index.covariance_of(id), index.placed(id).position);
            let [xx, xy, yy] = [covariance.xx, covariance.xy, covariance.yy].map(|v| growth * v);
            let (p, q) = (normal(), normal());
            // The Cholesky factor of the covariance.
            let l = xx.sqrt();
            [x + l * p, y + xy / l * p + (yy - xy * xy / xx).sqrt() * q]
        };
        let draws = 20_000;
        let left = (0..draws)
            .filter(|_| {
                let [a, b, c] = ids.map(&mut strewn);
                doubled_area(a, b, c) > 0.0
            })
            .count();
        let share = left as f64 / f64::from(draws);
        let right = if told.orientation == Turn::Left { share } else { 1.0 - share };
        // To first order only, and drawn 20 000 times: standard error below 0.0036.
        assert!((right - told.probability).abs() < 0.03, "{ids:?}: {right} {}", told.probability);
    }
}

#[test]
fn triples_that_have_no_turn_are_refused() {
    let index = square_and_pair();
    let refusal = |a, b, c| index.orientation(a, b, c).unwrap_err().to_string();
    assert_eq!(refusal("L0", "L1", "L0"), "landmark \"L0\" is named twice; give different landmarks");
    assert_eq!(
        refusal("L0", "L1", "L4"),
        "\"L0\" lies in component 0 and \"L4\" in component 1, and nothing tells how the two lie to each other; \
         give landmarks of one component, or a look that shows landmarks of both"
    );
    assert!(matches!(index.orientation("L0", "L1", "X"), Err(PlanError::UnknownLandmark { .. })));
}

#[test]
fn sides_and_batches_are_turns_one_by_one() {
    let index = square_and_pair();
    let sides = index.sides("L0", "L2", &["L1", "L3"]).unwrap();
    assert_eq!(sides.iter().map(|side| side.orientation).collect::<Vec<_>>(), [Turn::Right, Turn::Left]);
    let triples = [["L0", "L2", "L1"], ["L0", "L2", "L3"]];
    assert_eq!(index.orientation_of_each(&triples).unwrap(), sides);
    assert!(matches!(index.sides("L0", "L2", &["L2"]), Err(PlanError::Repeated { .. })));
}

#[test]
fn next_to_each_other_are_the_ends_of_delaunay_edges() {
    let index = square_and_pair();
    assert!(index.is_next_to("L0", "L1").unwrap());
    // One diagonal of the square is an edge, the other is not.
    assert_ne!(index.is_next_to("L0", "L2").unwrap(), index.is_next_to("L1", "L3").unwrap());
    assert!(index.is_next_to("L5", "L4").unwrap());
    assert!(!index.is_next_to("L0", "L4").unwrap());
    assert!(matches!(index.is_next_to("L0", "L0"), Err(PlanError::Repeated { .. })));
}

#[test]
fn the_order_around_a_place_turns_left_from_the_first() {
    let index = square_and_pair();
    let around = |others: &[&str]| numbers(&index.cyclic_order_at(0, [0.5, 0.5], others).unwrap());
    assert_eq!(around(&["L0", "L1", "L2", "L3"]), [0, 1, 2, 3]);
    assert_eq!(around(&["L2", "L1", "L0", "L3"]), [2, 3, 0, 1]);
    assert_eq!(around(&["L3"]), [3]);
    assert!(around(&[]).is_empty());
    assert_eq!(numbers(&index.cyclic_order("L0", &["L3", "L2", "L1"]).unwrap()), [3, 1, 2]);
    // In one direction the nearer comes first, but the first stays.
    let line = index_of(&[[0.0; 2], [3.0, 0.0], [1.0, 0.0], [2.0, 0.0], [0.0, 1.0]], &[]);
    assert_eq!(numbers(&line.cyclic_order("L0", &["L1", "L4", "L3", "L2"]).unwrap()), [1, 2, 3, 4]);
}

#[test]
fn a_triple_nearly_in_line_turns_one_way_whatever_comes_first() {
    for ray in 0..200 {
        let (sin, cos) = (f64::from(ray) * 0.03).sin_cos();
        let at = |far: f64| [0.1 + far * cos, 0.2 + far * sin];
        let index = index_of(&[at(0.3), at(1.1), at(0.7)], &[]);
        let left =
            |ids: [&str; 3]| index.orientation(ids[0], ids[1], ids[2]).unwrap().orientation == Turn::Left;
        let first = left(["L0", "L1", "L2"]);
        assert!(left(["L1", "L2", "L0"]) == first && left(["L2", "L0", "L1"]) == first, "ray {ray}");
        // The other way round but for those in line exactly, which count as left.
        let exactly = doubled_area(at(0.3), at(1.1), at(0.7)) == 0.0;
        assert!(exactly || left(["L1", "L0", "L2"]) != first, "ray {ray}");
    }
}

#[test]
fn rounding_does_not_turn_one_direction_into_a_whole_turn() {
    // Landmarks on rays from a place whose differences are not exact.
    let from = [0.1, 0.2];
    for ray in 0..60 {
        let (sin, cos) = (f64::from(ray) * 0.105 + 0.01).sin_cos();
        let at = |far: f64| [from[0] + far * cos, from[1] + far * sin];
        let aside = [from[0] - sin, from[1] + cos];
        let index =
            index_of(&[at(1.1), at(0.3), aside, at(0.7), [from[0] - 2.0 * sin, from[1] + 2.0 * cos]], &[]);
        let order = index.cyclic_order_at(0, from, &["L0", "L4", "L3", "L1", "L2"]).unwrap();
        assert_eq!(numbers(&order), [0, 1, 3, 2, 4], "ray {ray}");
    }
}

#[test]
fn what_has_no_direction_from_a_place_is_refused() {
    let index = square_and_pair();
    assert_eq!(
        index.cyclic_order("L0", &["L1", "L0"]).unwrap_err().to_string(),
        "landmark \"L0\" lies at the place itself, so it has no direction from there; leave it out"
    );
    assert!(matches!(index.cyclic_order("L0", &["L4"]), Err(PlanError::Apart { .. })));
    assert!(matches!(index.cyclic_order_at(7, [0.0; 2], &["L4"]), Err(PlanError::UnknownComponent { .. })));
    assert!(matches!(index.cyclic_order_at(0, [f64::NAN; 2], &["L1"]), Err(PlanError::Nowhere { .. })));
}
