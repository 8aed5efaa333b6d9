use covimap_embed::{Point, Similarity};
use proptest::prelude::*;

use super::*;
use crate::{BuildReport, LandmarkNames, MapperParams, PlacedLandmark};

type Row<'a> = (&'a str, Point, u32);

fn map(rows: &[Row]) -> GlobalMap {
    let names: LandmarkNames = rows.iter().map(|row| row.0).collect();
    let placed = rows.iter().map(|&(_, position, component)| PlacedLandmark {
        position,
        component,
        region: component,
        sightings: 1,
        partners: 1,
        ..PlacedLandmark::default()
    });
    GlobalMap::from_parts(names, placed.collect(), MapperParams::default(), BuildReport::default()).unwrap()
}

fn truth(rows: &[(&str, Point)]) -> Truth {
    let lines = rows.iter().map(|(id, [x, y])| format!("{id},{x},{y}\n"));
    Truth::parse(format!("id,x,y\n{}", lines.collect::<String>()).as_bytes(), "truth.csv").unwrap()
}

fn numbered(points: &[Point]) -> Vec<(String, Point)> {
    points.iter().enumerate().map(|(i, &point)| (format!("L{i}"), point)).collect()
}

fn compare(in_map: &[Point], in_truth: &[Point]) -> Evaluation {
    let (m, t) = (numbered(in_map), numbered(in_truth));
    let m: Vec<Row> = m.iter().map(|(id, point)| (id.as_str(), *point, 0)).collect();
    let t: Vec<_> = t.iter().rev().map(|(id, point)| (id.as_str(), *point)).collect();
    against(&map(&m), &truth(&t), &EvaluateParams::default()).unwrap()
}

/// Longer from A to C than from B to D.
const KITE: [Point; 4] = [[-2.0, 0.0], [0.0, -1.0], [2.0, 0.0], [0.0, 1.0]];

#[test]
fn every_measure_of_a_small_map_by_hand() {
    // The map has the kite's diagonals swapped: B and D are 4 apart, A and C only 2.
    let found = compare(&[[-1.0, 0.0], [0.0, -2.0], [1.0, 0.0], [0.0, 2.0]], &KITE);
    assert_eq!((found.n, found.components, found.isolated, found.missing, found.unknown), (4, 1, 0, 0, 0));
    // The four sides, and AC in the map against BD in truth: 2 edges of 3 * 4 - 6.
    assert_eq!(found.delaunay_error, 2.0 / 6.0);
    // All four triples go round as before.
    assert_eq!((found.orientation_error, found.local_orientation_error), (Some(0.0), Some(0.0)));
    assert_eq!(found.orientation_standard_error, None);
    // Both centroids are 0, sum m.t = 4 * 2 = 8, sum |m|^2 = sum |t|^2 = 10: the best scale is 0.8 without
    // a turn, the residual 10 - 8^2 / 10 = 3.6 over 4 landmarks, its share of the spread 3.6 / 10.
    assert!((found.rmse - 0.9f64.sqrt()).abs() < 1e-15, "{}", found.rmse);
    assert!((found.relative_rmse.unwrap() - 0.6).abs() < 1e-15);
    // All three others are near, in the map too.
    assert_eq!(found.knn10, 1.0);
}

#[test]
fn a_simulated_room_gets_the_errors_of_an_independent_implementation() {
    // Ten objects and their map by the paper's method (phi2, with the triangle constraint), computed and
    // measured with numpy and scipy.
    let room = [
        [0.317725, 0.100331],
        [0.700271, 1.054111],
        [0.642115, 0.730297],
        [0.091280, 0.732926],
        [1.347323, 1.224275],
        [1.060912, 0.221011],
        [0.297197, 0.928916],
        [0.101694, 0.231829],
        [0.501729, 0.287497],
        [1.100140, 1.180308],
    ];
    let mapped = [
        [-0.57464811, 0.23353628],
        [0.37237576, -0.24143742],
        [-0.00954488, 0.01541369],
        [-0.35608319, -0.46890542],
        [0.86282001, 0.13003881],
        [-0.04466651, 0.66139918],
        [-0.0415224, -0.44572806],
        [-0.5545897, -0.00721172],
        [-0.45769751, 0.11625996],
        [0.80355655, 0.0066347],
    ];
    let found = compare(&mapped, &room);
    // 0.208333 of 3 * 10 - 6 edges, 0.041667 of 120 triples.
    assert_eq!((found.delaunay_error, found.orientation_error), (5.0 / 24.0, Some(5.0 / 120.0)));
}

#[test]
fn landmarks_of_one_side_only_and_small_components_are_counted_and_left_out() {
    let [a, b, c, d] = KITE;
    let rows = [
        ("A", a, 0),
        ("nowhere", [9.0, 9.0], 0),
        ("B", b, 0),
        ("C", c, 0),
        ("D", d, 0),
        ("E", [0.0, 0.0], 1),
        ("F", [1.0, 0.0], 1),
        ("new", [0.0, 1.0], 1),
        ("G", [3.0, 3.0], 2),
    ];
    let surveyed = [
        ("A", a),
        ("B", b),
        ("gone", [5.0, 5.0]),
        ("lost", [6.0, 5.0]),
        ("C", c),
        ("D", d),
        ("E", [0.0, 7.0]),
        ("F", [1.0, 7.0]),
        ("G", [2.0, 7.0]),
        ("too", [8.0, 8.0]),
    ];
    let found = against(&map(&rows), &truth(&surveyed), &EvaluateParams::default()).unwrap();
    assert_eq!((found.n, found.components, found.isolated, found.missing, found.unknown), (4, 1, 3, 3, 2));
    assert_eq!((found.delaunay_error, found.orientation_error, found.knn10), (0.0, Some(0.0), 1.0));
    assert!(found.rmse < 1e-15);
}

#[test]
fn components_are_aligned_each_by_itself_and_pooled() {
    let [a, b, c, d] = KITE;
    // Component 7 is a mirror image at another scale, component 2 the swapped kite of the first test.
    let rows = [
        ("E", [0.0, 0.0], 7),
        ("A", [-1.0, 0.0], 2),
        ("F", [0.0, 3.0], 7),
        ("B", [0.0, -2.0], 2),
        ("C", [1.0, 0.0], 2),
        ("D", [0.0, 2.0], 2),
        ("G", [6.0, 0.0], 7),
    ];
    let surveyed =
        [("A", a), ("B", b), ("C", c), ("D", d), ("E", [10.0, 0.0]), ("F", [10.0, -1.0]), ("G", [12.0, 0.0])];
    let found = against(&map(&rows), &truth(&surveyed), &EvaluateParams::default()).unwrap();
    assert_eq!((found.n, found.components), (7, 2));
    // 2 of (3 * 4 - 6) + (3 * 3 - 6) edges.
    assert_eq!(found.delaunay_error, 2.0 / 9.0);
    assert_eq!(found.orientation_error, Some(0.0));
    // The residual 3.6 of the kite alone, over 7 landmarks.
    assert!((found.rmse - (3.6f64 / 7.0).sqrt()).abs() < 1e-14, "{}", found.rmse);
    assert_eq!(found.knn10, 1.0);
}

#[test]
fn sets_without_a_shape_are_refused() {
    let full = [("A", [0.0, 0.0], 0), ("B", [1.0, 0.0], 0), ("C", [0.0, 1.0], 1)];
    let refusal = |rows: &[Row], surveyed: &[(&str, Point)]| {
        against(&map(rows), &truth(surveyed), &EvaluateParams::default()).unwrap_err()
    };
    let strangers = refusal(&full, &[("1", [0.0; 2]), ("2", [1.0; 2])]);
    assert!(matches!(strangers, MapError::NoCommonLandmarks { .. }));
    assert_eq!(
        strangers.to_string(),
        "no landmark of the map is in the truth: the map has 3 such as \"A\", the truth 2 such as \"1\"; \
         give both the same IDs"
    );
    assert!(matches!(refusal(&full, &[]), MapError::NoCommonLandmarks { .. }));
    assert!(matches!(refusal(&[], &[("A", [0.0; 2])]), MapError::NoCommonLandmarks { .. }));
    let split = refusal(&full, &[("A", [0.0; 2]), ("B", [1.0; 2]), ("C", [2.0; 2])]);
    assert!(matches!(split, MapError::TooFewCommon { common: 3, fewest: 3 }));
    assert_eq!(
        split.to_string(),
        "map and truth share 3 landmarks, but no component of the map has 3 of them; survey more landmarks of \
         one component"
    );
}

#[test]
fn degenerate_shapes_give_null_and_no_nan() {
    let line = [[0.0, 0.0], [1.0, 1.0], [2.0, 2.0], [5.0, 5.0]];
    let one_place = [[3.0, 3.0]; 4];
    for (in_map, in_truth) in [(&one_place, &KITE), (&line, &KITE), (&line, &line)] {
        let found = compare(in_map, in_truth);
        let json = serde_json::to_value(&found).unwrap();
        assert!(json["rmse"].is_number() && json["delaunay_error"].is_number() && json["knn10"].is_number());
    }
    let flat = compare(&KITE, &line);
    assert_eq!((flat.orientation_error, flat.local_orientation_error), (None, None));
    let collapsed = compare(&one_place, &KITE);
    assert_eq!((collapsed.orientation_error, collapsed.relative_rmse), (Some(1.0), Some(1.0)));
    // sum |t|^2 = 10 over 4 landmarks.
    assert!((collapsed.rmse - 2.5f64.sqrt()).abs() < 1e-15);
    let unsurveyable = compare(&KITE, &one_place);
    assert_eq!((unsurveyable.rmse, unsurveyable.relative_rmse), (0.0, None));
    assert!(serde_json::to_string(&unsurveyable).unwrap().contains("\"relative_rmse\":null"));
}

#[test]
fn coordinates_beyond_all_reason_are_refused() {
    let rows = [("A", [1e200, 0.0], 0), ("B", [0.0, 0.0], 0), ("C", [0.0, 1e200], 0)];
    let surveyed = truth(&[("A", [1.0, 0.0]), ("B", [0.0, 0.0]), ("C", [0.0, 1.0])]);
    let error = against(&map(&rows), &surveyed, &EvaluateParams::default()).unwrap_err();
    assert_eq!(error.to_string(), "pair of points 0: coordinates must be finite and at most 1e100");
}

proptest! {
    #[test]
    fn a_map_that_is_the_truth_in_another_frame_is_perfect(
        points in prop::collection::vec([0.0..1.0f64, 0.0..1.0f64], 3..60),
        angle in 0.0..6.0f64,
        scale in 0.001..1000.0f64,
        mirrored in any::<bool>(),
    ) {
        let frame = Similarity { cos: angle.cos(), sin: angle.sin(), mirrored, scale, shift: [3.0, -2.0] };
        let moved: Vec<Point> = points.iter().map(|&point| frame.apply(point)).collect();
        let found = compare(&moved, &points);
        prop_assert_eq!((found.delaunay_error, found.orientation_error), (0.0, Some(0.0)));
        prop_assert_eq!((found.local_orientation_error, found.knn10), (Some(0.0), 1.0));
        prop_assert!(found.rmse < 1e-9, "{}", found.rmse);
    }

    #[test]
    fn no_other_similarity_comes_nearer(
        pairs in prop::collection::vec(([0.0..1.0f64, 0.0..1.0f64], [0.0..1.0f64, 0.0..1.0f64]), 3..12),
        nudge in [-0.1..0.1f64, -0.1..0.1f64, -0.1..0.1f64, 0.9..1.1f64],
        mirror in any::<bool>(),
    ) {
        let (in_map, in_truth): (Vec<Point>, Vec<Point>) = pairs.into_iter().unzip();
        let landmarks = Vec::new();
        let chart = Chart { component: 0, landmarks, map: in_map.clone(), truth: in_truth.clone() };
        let best = truth_from_map(&chart).unwrap().unwrap();
        let [dx, dy, turn, scale] = nudge;
        let nudge =
            Similarity { cos: turn.cos(), sin: turn.sin(), mirrored: mirror, scale, shift: [dx, dy] };
        let misfit = |fit: &Similarity| -> f64 {
            let gaps = in_map.iter().zip(&in_truth).map(|(&m, t)| (fit.apply(m), t));
            gaps.map(|(m, t)| (m[0] - t[0]).powi(2) + (m[1] - t[1]).powi(2)).sum()
        };
        prop_assert!(misfit(&best) <= misfit(&nudge.after(&best)) + 1e-12);
        let rmse = compare(&in_map, &in_truth).rmse;
        prop_assert!((rmse - (misfit(&best) / in_map.len() as f64).sqrt()).abs() < 1e-12);
    }

    #[test]
    fn the_order_of_the_landmarks_does_not_matter(
        pairs in prop::collection::vec(([0.0..1.0f64, 0.0..1.0f64], [0.0..1.0f64, 0.0..1.0f64]), 3..30)
    ) {
        let (mut in_map, mut in_truth): (Vec<Point>, Vec<Point>) = pairs.into_iter().unzip();
        let one = compare(&in_map, &in_truth);
        in_map.reverse();
        in_truth.reverse();
        let other = compare(&in_map, &in_truth);
        prop_assert_eq!(one.delaunay_error, other.delaunay_error);
        prop_assert_eq!(one.orientation_error, other.orientation_error);
        prop_assert_eq!(one.knn10, other.knn10);
    }
}
