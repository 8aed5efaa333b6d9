use super::*;
use crate::{Correspondence, Pair, PairDistances, ProcrustesOptions, ShortestPaths, procrustes};

fn matrix_of(points: &[Point]) -> DistanceMatrix {
    let distance = |i: usize, j: usize| (points[i][0] - points[j][0]).hypot(points[i][1] - points[j][1]);
    DistanceMatrix::from_fn(points.len(), distance).unwrap()
}

fn sunflower(n: usize) -> Vec<Point> {
    let at = |k: usize| {
        let (radius, turn) = ((k as f64 + 0.5).sqrt(), k as f64 * 2.399_963);
        [radius * turn.cos(), 0.6 * radius * turn.sin()]
    };
    (0..n).map(at).collect()
}

/// Root mean square error after the best rigid fit.
fn rmse(placed: &[Point], points: &[Point]) -> f64 {
    let pair = |(&source, &target)| Correspondence { source, target, weight: 1.0 };
    let pairs: Vec<_> = placed.iter().zip(points).map(pair).collect();
    procrustes(&pairs, ProcrustesOptions { scale: false, ..Default::default() }).unwrap().rmse
}

#[test]
fn pivots_are_spread_out() {
    // On the line 0, 1, .., 10: the far end, the near end, the middle, then 2 or 3 (first: 2).
    let line: Vec<Point> = (0..11).map(|k| [f64::from(k), 0.0]).collect();
    let chosen = PivotDistances::max_min(&matrix_of(&line), 4).unwrap();
    assert_eq!(chosen.pivots(), [10, 0, 5, 2]);
}

#[test]
fn there_are_no_more_pivots_than_places() {
    let places = [[0.0, 0.0], [1.0, 0.0], [0.0, 0.0], [1.0, 0.0]];
    let chosen = PivotDistances::max_min(&matrix_of(&places), 4).unwrap();
    assert_eq!(chosen.pivots(), [1, 0]);
}

#[test]
fn landmark_scaling_is_exact_in_the_plane() {
    let points = sunflower(300);
    for pivots in [3, 10] {
        let chosen = PivotDistances::max_min(&matrix_of(&points), pivots).unwrap();
        assert!(rmse(&landmark_scaling(&chosen), &points) < 1e-10, "{pivots} pivots");
    }
}

#[test]
fn with_all_objects_as_pivots_both_methods_are_classical_scaling() {
    // Not flat, so that only the same formulas give the same points.
    let bent = matrix_of(&sunflower(40)).map(f64::sqrt).unwrap();
    let classical = classical_scaling(&bent.map(|d| d * d).unwrap()).unwrap().points;
    let all = PivotDistances::max_min(&bent, 40).unwrap();
    assert!(rmse(&landmark_scaling(&all), &classical) < 1e-10);
    // Up to the scale, which pivot scaling fits to the distances.
    let pivot = pivot_scaling(&all);
    let scale = fitting_scale(&all, &classical);
    for (point, expected) in pivot.iter().zip(&classical) {
        assert!(
            (point[0] - scale * expected[0]).abs() < 1e-9 && (point[1] - scale * expected[1]).abs() < 1e-9
        );
    }
}

#[test]
fn shortest_paths_through_a_mesh_give_its_shape() {
    // A mesh of 30 by 15 with both diagonals: paths are 5 % too long on average.
    let (width, height) = (30, 15);
    let mut pairs = Vec::new();
    for y in 0..height {
        for x in 0..width {
            for (dx, dy) in [(1_i32, 0_i32), (-1, 1), (0, 1), (1, 1)] {
                if (0..width).contains(&(x + dx)) && y + dy < height {
                    let (i, j) = ((y * width + x) as u32, ((y + dy) * width + x + dx) as u32);
                    pairs.push(Pair { i, j, distance: f64::from(dx * dx + dy * dy).sqrt(), weight: 1.0 });
                }
            }
        }
    }
    let points: Vec<Point> =
        (0..width * height).map(|k| [f64::from(k % width), f64::from(k / width)]).collect();
    let pairs = PairDistances::new(points.len(), pairs).unwrap();
    let chosen = PivotDistances::max_min(&ShortestPaths::new(&pairs), 20).unwrap();
    let (landmark, pivot) =
        (rmse(&landmark_scaling(&chosen), &points), rmse(&pivot_scaling(&chosen), &points));
    // The extent is 33 by diagonal; the root mean square distance from the centre is 9.7.
    assert!(landmark < 1.0 && pivot < 1.0, "{landmark} {pivot}");
}

#[test]
fn degenerate_sets() {
    let of = |points: &[Point]| PivotDistances::max_min(&matrix_of(points), 5).unwrap();
    for method in [landmark_scaling, pivot_scaling] {
        assert!(method(&of(&[])).is_empty());
        assert_eq!(method(&of(&[[3.0, 3.0]])), [[0.0; 2]]);
        assert_eq!(method(&of(&[[3.0, 3.0]; 4])), [[0.0; 2]; 4]);
        for line in [vec![[0.0, 0.0], [2.0, 2.0]], vec![[0.0, 0.0], [1.0, 1.0], [5.0, 5.0], [6.0, 6.0]]] {
            let placed = method(&of(&line));
            assert!(placed.iter().all(|point| point[1] == 0.0));
            assert!(rmse(&placed, &line) < 1e-7);
        }
    }
}

#[test]
fn unusable_distances_are_refused() {
    let unknown = DistanceMatrix::from_fn(3, |_, j| if j == 2 { f64::INFINITY } else { 1.0 }).unwrap();
    let error = PivotDistances::max_min(&unknown, 2).unwrap_err();
    assert!(matches!(error, EmbedError::UnknownDistance { i: 0, j: 2 }));
    struct Rows(Vec<f64>);
    impl DistanceRows for Rows {
        fn objects(&self) -> usize {
            3
        }
        fn row(&self, _: usize) -> Vec<f64> {
            self.0.clone()
        }
    }
    let negative = PivotDistances::max_min(&Rows(vec![0.0, -1.0, 1.0]), 2).unwrap_err();
    assert!(matches!(negative, EmbedError::BadDistance { i: 0, j: 1, .. }));
    let short = PivotDistances::max_min(&Rows(vec![0.0]), 2).unwrap_err();
    assert!(matches!(short, EmbedError::Lengths { first: 3, second: 1 }));
}
