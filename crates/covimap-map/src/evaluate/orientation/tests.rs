use proptest::prelude::*;

use super::*;
use crate::{LandmarkId, delaunay_edges};

fn chart(map: &[Point], truth: &[Point]) -> Chart {
    let landmarks = (0..map.len() as u32).map(LandmarkId).collect();
    Chart { component: 0, landmarks, map: map.to_vec(), truth: truth.to_vec() }
}

/// Twice the signed area, by the shoelace formula over the three corners.
fn area(points: &[Point], [i, j, k]: [usize; 3]) -> f64 {
    let term = |a: usize, b: usize| points[a][0] * points[b][1] - points[b][0] * points[a][1];
    term(i, j) + term(j, k) + term(k, i)
}

/// All triples the obvious way, for points of moderate size without near-collinear triples.
fn by_areas(map: &[Point], truth: &[Point]) -> Tally {
    let sign = |area: f64| if area.abs() < 1e-9 { 0 } else { area.signum() as i32 };
    let mut tally = Tally::default();
    for i in 0..map.len() {
        for j in i + 1..map.len() {
            for k in j + 1..map.len() {
                let product = sign(area(map, [i, j, k])) * sign(area(truth, [i, j, k]));
                tally.known += u64::from(sign(area(truth, [i, j, k])) != 0);
                tally.same += u64::from(product > 0);
                tally.opposite += u64::from(product < 0);
            }
        }
    }
    tally
}

fn params(exact_up_to: usize, samples: u64) -> EvaluateParams {
    EvaluateParams { exact_up_to, samples, ..EvaluateParams::default() }
}

fn grid_points(n: std::ops::Range<usize>) -> impl Strategy<Value = Vec<(Point, Point)>> {
    prop::collection::vec(([0i32..7, 0i32..7], [0i32..7, 0i32..7]), n).prop_map(|pairs| {
        pairs.into_iter().map(|(map, truth)| (map.map(f64::from), truth.map(f64::from))).collect()
    })
}

proptest! {
    #[test]
    fn agrees_with_signed_areas_collinear_triples_and_copies_included(pairs in grid_points(0..25)) {
        let (map, truth): (Vec<_>, Vec<_>) = pairs.into_iter().unzip();
        prop_assert_eq!(all(&chart(&map, &truth)), by_areas(&map, &truth));
    }

    #[test]
    fn frame_and_mirror_image_change_nothing(
        pairs in prop::collection::vec(([0.0..1.0f64, 0.0..1.0f64], [0.0..1.0f64, 0.0..1.0f64]), 3..25),
        angle in 0.0..6.0f64,
        scale in 0.01..100.0f64,
    ) {
        let (map, truth): (Vec<Point>, Vec<Point>) = pairs.into_iter().unzip();
        let turned: Vec<Point> = map
            .iter()
            .map(|[x, y]| {
                [scale * (angle.cos() * x - angle.sin() * y) + 5.0, -scale * (angle.sin() * x + angle.cos() * y)]
            })
            .collect();
        let error = |map: &[Point]| Orientations::of(&[chart(map, &truth)], &params(1000, 0)).error().unwrap();
        prop_assert_eq!(error(&map), error(&turned));
        prop_assert!(error(&map) <= 0.5);
    }
}

#[test]
fn one_landmark_on_the_wrong_side_by_hand() {
    // A square A B C D; in the map D has crossed the diagonal AC (1, 0 instead of 0, 1), to B.
    // ABC turns as before; ACD turns the other way; ABD and BCD: B and D coincide, no orientation.
    let truth = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let map = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [1.0, 0.0]];
    let tally = all(&chart(&map, &truth));
    assert_eq!(tally, Tally { known: 4, same: 1, opposite: 1 });
    // Either mirror image has 1 right and 3 wrong of 4.
    assert_eq!(Orientations::of(&[chart(&map, &truth)], &params(1000, 0)).error(), Some(0.75));
}

#[test]
fn collinear_truth_has_no_orientation_error() {
    let line: Vec<Point> = (0..5).map(|i| [0.1 * f64::from(i), 0.3 * f64::from(i)]).collect();
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.3, 0.2]];
    let orientations = Orientations::of(&[chart(&square, &line)], &params(1000, 0));
    assert_eq!(orientations.error(), None);
    assert_eq!(orientations.standard_error(), None);
    assert_eq!(Orientations::of(&[chart(&square, &line)], &params(0, 100)).standard_error(), None);
}

#[test]
fn a_map_in_one_place_is_all_wrong() {
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let orientations = Orientations::of(&[chart(&[[2.0, 2.0]; 4], &square)], &params(1000, 0));
    assert_eq!(orientations.error(), Some(1.0));
}

#[test]
fn each_chart_takes_its_own_mirror_image_and_triples_are_pooled() {
    let truth = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let mirrored = truth.map(|[x, y]| [x, -y]);
    // Crossing one diagonal only: B moves to (0.4, 0.6), beyond AC and short of BD. ABC (wrong), ACD, ABD, BCD.
    let crossed = [[0.0, 0.0], [0.4, 0.6], [1.0, 1.0], [0.0, 1.0]];
    let charts = [chart(&mirrored, &truth), chart(&truth, &truth), chart(&crossed, &truth)];
    let orientations = Orientations::of(&charts, &params(1000, 0));
    assert_eq!(orientations.mirrored().collect::<Vec<_>>(), [true, false, false]);
    assert_eq!(orientations.error(), Some(1.0 / 12.0));
}

/// Points of a sunflower, and the same with every third one moved.
fn disturbed(n: u32) -> Chart {
    let truth: Vec<Point> = (0..n)
        .map(|i| {
            let (r, a) = (f64::from(i).sqrt(), 2.4 * f64::from(i));
            [r * a.cos(), r * a.sin()]
        })
        .collect();
    let map: Vec<Point> = (0..n)
        .zip(&truth)
        .map(|(i, [x, y])| if i % 3 == 0 { [0.4 * x + 1.0, *y] } else { [*x, *y] })
        .collect();
    chart(&map, &truth)
}

#[test]
fn random_triples_estimate_the_count_of_all_within_their_standard_error() {
    let charts = [disturbed(300), disturbed(120)];
    let exact = Orientations::of(&charts, &params(1000, 0));
    assert_eq!(exact.standard_error(), None);
    let truth = exact.error().unwrap();
    for (exact_up_to, seed) in [(0, 1), (200, 2), (200, 3)] {
        let drawn = Orientations::of(&charts, &EvaluateParams { exact_up_to, samples: 100_000, seed });
        let (error, deviation) = (drawn.error().unwrap(), drawn.standard_error().unwrap());
        assert!((error - truth).abs() < 3.0 * deviation, "{error} {truth} {deviation}");
        // At most sqrt(0.25 / 100 000) = 0.0016.
        assert!(deviation > 0.0005 && deviation < 0.0016, "{deviation}");
    }
}

#[test]
fn drawn_triples_are_of_three_landmarks_and_all_are_met() {
    // Four landmarks, ten thousand draws: every triple turns as in truth, none is degenerate.
    let truth = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let tally = sampled(&chart(&truth, &truth), 10_000, 5);
    assert_eq!(tally, Tally { known: 10_000, same: 10_000, opposite: 0 });
    // One of the four triples is wrong: a quarter of the draws, give or take 4.7 standard deviations.
    let crossed = [[0.0, 0.0], [0.4, 0.6], [1.0, 1.0], [0.0, 1.0]];
    let tally = sampled(&chart(&crossed, &truth), 10_000, 5);
    assert!(tally.opposite.abs_diff(2500) < 200, "{tally:?}");
}

#[test]
fn any_number_of_threads_draws_the_same() {
    let chart = disturbed(50);
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| sampled(&chart, 50_000, 9))
    };
    assert_eq!(with(1), with(3));
    assert_ne!(sampled(&chart, 50_000, 9), sampled(&chart, 50_000, 10));
}

#[test]
fn near_triples_are_those_of_each_landmark_with_two_neighbours() {
    let chart = disturbed(40);
    let neighbours = NearestNeighbours::of(&chart.truth, &delaunay_edges(&chart.truth).unwrap());
    let tally = near(&chart, &neighbours, false);
    let (mut known, mut same) = (0, 0);
    for i in 0..chart.len() {
        for (a, &j) in neighbours.row(i).iter().enumerate() {
            for &k in &neighbours.row(i)[..a] {
                let triple = [i, j as usize, k as usize];
                known += 1;
                same += u64::from(area(&chart.map, triple) * area(&chart.truth, triple) > 0.0);
            }
        }
    }
    // 40 landmarks with 10 neighbours: 45 pairs each.
    assert_eq!((tally.known, known), (1800, 1800));
    assert_eq!(tally.same, same);
    assert_eq!(near(&chart, &neighbours, true).same, tally.opposite);
}
