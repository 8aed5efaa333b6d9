use proptest::prelude::*;

use super::*;

/// The definition: an edge belongs to the triangulation of points in general position when a
/// circle through its ends and some third point is empty, or when all others lie on one side of
/// it and nothing is inside such a circle.
fn by_empty_circles(points: &[Point]) -> Vec<(u32, u32)> {
    let mut edges = Vec::new();
    for a in 0..points.len() {
        for b in a + 1..points.len() {
            for c in b + 1..points.len() {
                if (0..points.len()).all(|d| [a, b, c].contains(&d) || outside(points, [a, b, c], d)) {
                    edges.extend([(a as u32, b as u32), (a as u32, c as u32), (b as u32, c as u32)]);
                }
            }
        }
    }
    edges.sort_unstable();
    edges.dedup();
    edges
}

fn outside(points: &[Point], [a, b, c]: [usize; 3], d: usize) -> bool {
    let [[ax, ay], [bx, by], [cx, cy]] =
        [a, b, c].map(|i| [points[i][0] - points[d][0], points[i][1] - points[d][1]]);
    let turn = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
    let in_circle = (ax * ax + ay * ay) * (bx * cy - cx * by) - (bx * bx + by * by) * (ax * cy - cx * ay)
        + (cx * cx + cy * cy) * (ax * by - bx * ay);
    in_circle * turn < 0.0
}

fn edges(points: &[Point]) -> Vec<(u32, u32)> {
    delaunay_edges(points).unwrap()
}

proptest! {
    #[test]
    fn agrees_with_the_empty_circle_definition(
        points in prop::collection::vec([0.0..1.0f64, 0.0..1.0f64], 3..14)
    ) {
        prop_assert_eq!(edges(&points), by_empty_circles(&points));
    }

    #[test]
    fn a_far_origin_and_any_scale_change_nothing(
        points in prop::collection::vec([0i32..1000, 0i32..1000], 0..40),
        power in -900..900i32,
        shift in [-4000i32..4000, -4000i32..4000],
    ) {
        let plain: Vec<Point> = points.iter().map(|p| p.map(f64::from)).collect();
        let moved: Vec<Point> = points
            .iter()
            .map(|p| [0, 1].map(|axis| f64::from(p[axis] + shift[axis]) * 2f64.powi(power)))
            .collect();
        let (a, b) = (edges(&plain), edges(&moved));
        // Cocircular points may be joined by the other diagonal, but never by more or fewer edges.
        prop_assert_eq!(a.len(), b.len());
    }

    #[test]
    fn edges_are_ascending_bounded_and_reach_every_point(
        points in prop::collection::vec([0i32..6, 0i32..6], 3..60)
    ) {
        let points: Vec<Point> = points.iter().map(|p| p.map(f64::from)).collect();
        let edges = edges(&points);
        prop_assert!(edges.is_sorted_by(|a, b| a < b));
        prop_assert!(edges.len() <= 3 * points.len() - 6);
        let mut root: Vec<usize> = (0..points.len()).collect();
        for &(a, b) in &edges {
            let (from, to) = (root[a as usize], root[b as usize]);
            root.iter_mut().filter(|r| **r == from).for_each(|r| *r = to);
        }
        prop_assert!(root.iter().all(|&r| r == root[0]));
    }
}

#[test]
fn the_smallest_sets() {
    assert_eq!(edges(&[]), []);
    assert_eq!(edges(&[[5.0, 5.0]]), []);
    assert_eq!(edges(&[[5.0, 5.0], [1.0, 2.0]]), [(0, 1)]);
    assert_eq!(edges(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]), [(0, 1), (0, 2), (1, 2)]);
}

#[test]
fn a_kite_is_cut_along_its_short_diagonal() {
    // Points 0 and 2 lie 4 apart, 1 and 3 lie 2 apart.
    let kite = [[-2.0, 0.0], [0.0, -1.0], [2.0, 0.0], [0.0, 1.0]];
    assert_eq!(edges(&kite), [(0, 1), (0, 3), (1, 2), (1, 3), (2, 3)]);
}

#[test]
fn collinear_points_give_the_path_along_the_line() {
    let line = [[2.0, 4.0], [0.0, 0.0], [3.0, 6.0], [1.0, 2.0]];
    assert_eq!(edges(&line), [(0, 2), (0, 3), (1, 3)]);
    let upright = [[1.0, 3.0], [1.0, 1.0], [1.0, 2.0]];
    assert_eq!(edges(&upright), [(0, 2), (1, 2)]);
}

#[test]
fn copies_form_a_path_from_the_first_point_at_their_place() {
    let all_the_same = [[3.0, 3.0]; 4];
    assert_eq!(edges(&all_the_same), [(0, 1), (1, 2), (2, 3)]);
    let twin = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 0.0]];
    assert_eq!(edges(&twin), [(0, 1), (0, 2), (1, 2), (1, 3)]);
    assert_eq!(edges(&[[0.0, 1.0], [-0.0, 1.0]]), [(0, 1)]);
}

#[test]
fn extreme_coordinates_are_no_trouble() {
    let triangle = [(0, 1), (0, 2), (1, 2)];
    assert_eq!(edges(&[[f64::MAX, 0.0], [-f64::MAX, 0.0], [0.0, f64::MAX]]), triangle);
    assert_eq!(edges(&[[5e-324, 0.0], [0.0, 0.0], [0.0, 5e-324]]), triangle);
    // The two points near the origin are one beside a third at 1e300.
    assert_eq!(edges(&[[1e-300, 0.0], [0.0, 0.0], [1e300, 1e300]]), [(0, 1), (0, 2)]);
}

#[test]
fn numbers_that_are_not_finite_are_refused() {
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let error = delaunay_edges(&[[0.0, 0.0], [1.0, bad]]).unwrap_err();
        assert!(matches!(error, MapError::NotFinite { index: 1, .. }));
    }
    let text = delaunay_edges(&[[f64::NAN, 1.0]]).unwrap_err().to_string();
    assert_eq!(text, "point 0 is at (NaN, 1), positions must be finite; leave it out");
}

#[test]
fn a_large_grid_has_all_its_edges() {
    let side = 100;
    let grid: Vec<Point> = (0..side * side).map(|i| [f64::from(i % side), f64::from(i / side)]).collect();
    // A triangulated square grid: rows and columns 2 s (s - 1), one diagonal a cell (s - 1)^2.
    assert_eq!(edges(&grid).len(), 2 * 100 * 99 + 99 * 99);
}
