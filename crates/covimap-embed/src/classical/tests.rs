use super::*;

/// Squared distances of ten objects, upper triangle row by row: a table that is far from flat.
#[rustfmt::skip]
const GOLDEN: [f64; 45] = [
    2.0, 0.222413793, 0.227272727, 2.0, 0.371875, 0.595833333, 0.1, 0.1, 2.0,
    0.1, 0.187931034, 0.257142857, 0.9875, 0.1, 2.0, 0.361904762, 0.1,
    0.1, 1.45, 0.144186047, 0.1, 0.25, 0.1, 0.339583333,
    2.0, 2.0, 0.1, 0.131666667, 0.12804878, 2.0,
    2.0, 2.0, 2.0, 2.0, 0.1,
    2.0, 1.36, 0.136585366, 1.65,
    0.326315789, 0.208823529, 0.536666667,
    0.1, 2.0,
    2.0,
];
/// Made with numpy: leading eigenvalues of `-1/2 H D2 H` and the coordinates, up to reflection.
const GOLDEN_EIGENVALUES: [f64; 4] = [2.917266229, 1.476994128, 0.811747697, 0.514105532];
const GOLDEN_POINTS: [Point; 10] = [
    [-0.59614617, -0.22026811],
    [0.56138422, 0.16956468],
    [-0.07078543, -0.07304891],
    [-0.37086409, 0.51372578],
    [0.88874916, -0.1331726],
    [-0.16114034, -0.87924574],
    [-0.078298, 0.55151675],
    [-0.57790232, 0.15414779],
    [-0.45560806, -0.10591593],
    [0.86061103, 0.02269629],
];

fn squared_distance(a: Point, b: Point) -> f64 {
    (a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2)
}

fn squared_distances(points: &[Point]) -> DistanceMatrix {
    DistanceMatrix::from_fn(points.len(), |i, j| squared_distance(points[i], points[j])).unwrap()
}

/// Points on a sunflower spiral: round, hence with two nearly equal leading eigenvalues.
fn sunflower(n: usize) -> Vec<Point> {
    let at = |k: usize| {
        let (radius, turn) = ((k as f64 + 0.5).sqrt(), k as f64 * 2.399_963);
        [radius * turn.cos(), radius * turn.sin()]
    };
    (0..n).map(at).collect()
}

fn worst_distance_error(points: &[Point], squared: &DistanceMatrix) -> f64 {
    let mut worst: f64 = 0.0;
    for (i, &a) in points.iter().enumerate() {
        for (j, &b) in points.iter().enumerate() {
            worst = worst.max((squared_distance(a, b).sqrt() - squared.get(i, j).sqrt()).abs());
        }
    }
    worst
}

#[test]
fn an_independent_implementation_is_reproduced() {
    let mut entries = GOLDEN.iter();
    let squared = DistanceMatrix::from_fn(10, |_, _| *entries.next().unwrap()).unwrap();
    let scaled = classical_scaling(&squared).unwrap();
    for (value, golden) in scaled.eigenvalues.iter().zip(GOLDEN_EIGENVALUES) {
        assert!((value - golden).abs() < 1e-8, "{value} {golden}");
    }
    assert_eq!((scaled.eigenvalues.len(), scaled.rank), (10, 2));
    assert!(worst_distance_error(&scaled.points, &squared_distances(&GOLDEN_POINTS)) < 1e-7);
}

#[test]
fn points_of_the_plane_come_back_on_both_sides_of_the_full_limit() {
    for n in [4, 50, FULL_LIMIT, FULL_LIMIT + 1, 500] {
        let squared = squared_distances(&sunflower(n));
        let scaled = classical_scaling(&squared).unwrap();
        assert!(worst_distance_error(&scaled.points, &squared) < 1e-10, "n = {n}");
        assert_eq!(scaled.rank, 2);
        let third = scaled.eigenvalues[2].abs();
        assert!(third < 1e-10 * scaled.eigenvalues[0], "n = {n}: {third}");
    }
}

#[test]
fn the_block_method_finds_what_the_whole_spectrum_holds() {
    // Square roots of distances: a spectrum with a slow tail in every dimension.
    let rough = squared_distances(&sunflower(300)).map(f64::sqrt).unwrap();
    let whole = coordinates(300, 1.0, &symmetric_eigen(300, &inner_products(&rough, 1.0)));
    let scaled = classical_scaling(&rough).unwrap();
    assert_eq!(scaled.eigenvalues.len(), TOLERANCES.len());
    for (value, expected) in scaled.eigenvalues.iter().zip(&whole.eigenvalues) {
        assert!((value - expected).abs() < 1e-10 * whole.eigenvalues[0], "{value} {expected}");
    }
    assert!(worst_distance_error(&scaled.points, &squared_distances(&whole.points)) < 1e-8);
}

#[test]
fn axes_are_centred_ordered_and_signed() {
    let scaled = classical_scaling(&squared_distances(&[[0.0, 0.0], [0.0, 9.0], [1.0, 2.0]])).unwrap();
    for axis in 0..2 {
        let on_axis = || scaled.points.iter().map(move |point| point[axis]);
        assert!(on_axis().sum::<f64>().abs() < 1e-12);
        // Eq. (2): the squares of a column sum to the eigenvalue.
        let variance = on_axis().map(|x| x * x).sum::<f64>();
        assert!((variance - scaled.eigenvalues[axis]).abs() < 1e-12);
        assert!(on_axis().fold(0.0, f64::max) >= -on_axis().fold(0.0, f64::min));
    }
}

#[test]
fn no_object_and_one_object() {
    let of = |n| classical_scaling(&DistanceMatrix::from_fn(n, |_, _| 1.0).unwrap()).unwrap();
    assert_eq!(of(0), ClassicalScaling { points: vec![], eigenvalues: vec![], rank: 0 });
    assert_eq!(of(1), ClassicalScaling { points: vec![[0.0; 2]], eigenvalues: vec![0.0], rank: 0 });
}

#[test]
fn two_objects_lie_on_the_first_axis() {
    // B = [[d2/4, -d2/4], [-d2/4, d2/4]] with d2 = 4: eigenvalues 2 and 0, x = +-sqrt(2)/sqrt(2).
    let scaled = classical_scaling(&DistanceMatrix::from_fn(2, |_, _| 4.0).unwrap()).unwrap();
    assert!((scaled.points[0][0] - 1.0).abs() < 1e-15 && (scaled.points[1][0] + 1.0).abs() < 1e-15);
    assert_eq!((scaled.points[0][1], scaled.points[1][1], scaled.rank), (0.0, 0.0, 1));
}

#[test]
fn three_equidistant_objects_make_an_equilateral_triangle() {
    let squared = DistanceMatrix::from_fn(3, |_, _| 1.0).unwrap();
    let scaled = classical_scaling(&squared).unwrap();
    assert!(worst_distance_error(&scaled.points, &squared) < 1e-14);
    // B = 1/2 H: eigenvalues 1/2, 1/2, 0.
    assert!((scaled.eigenvalues[0] - 0.5).abs() < 1e-15 && (scaled.eigenvalues[1] - 0.5).abs() < 1e-15);
}

#[test]
fn identical_objects_coincide() {
    for (n, reported) in [(5, 5), (300, 4)] {
        let scaled = classical_scaling(&DistanceMatrix::from_fn(n, |_, _| 0.0).unwrap()).unwrap();
        let eigenvalues = vec![0.0; reported];
        assert_eq!(scaled, ClassicalScaling { points: vec![[0.0; 2]; n], eigenvalues, rank: 0 });
    }
}

#[test]
fn collinear_objects_use_one_axis() {
    for n in [5, 300] {
        let squared = DistanceMatrix::from_fn(n, |i, j| ((j - i) * (j - i)) as f64).unwrap();
        let scaled = classical_scaling(&squared).unwrap();
        assert_eq!(scaled.rank, 1, "n = {n}");
        assert!(scaled.points.iter().all(|point| point[1] == 0.0));
        assert!(worst_distance_error(&scaled.points, &squared) < 1e-9 * n as f64);
    }
}

#[test]
fn a_table_that_breaks_the_triangle_inequality_has_negative_eigenvalues() {
    // Object 0 is within 1 of two objects that are 10 apart.
    let squared = DistanceMatrix::from_rows(3, vec![0., 1., 1., 1., 0., 100., 1., 100., 0.]).unwrap();
    let scaled = classical_scaling(&squared).unwrap();
    assert!(scaled.eigenvalues[2] < -1.0);
    assert_eq!(scaled.rank, 1);
}

#[test]
fn huge_and_tiny_units_change_nothing_but_the_unit() {
    let squared = squared_distances(&sunflower(20));
    let plain = classical_scaling(&squared).unwrap();
    for unit in [1e300, 1e-300] {
        let scaled = classical_scaling(&squared.map(|d| d * unit).unwrap()).unwrap();
        for (point, expected) in scaled.points.iter().zip(&plain.points) {
            assert!((point[0] / f64::sqrt(unit) - expected[0]).abs() < 1e-12);
        }
    }
}

#[test]
fn an_unknown_pair_is_refused() {
    let squared = DistanceMatrix::from_fn(3, |i, _| if i == 1 { f64::INFINITY } else { 1.0 }).unwrap();
    let error = classical_scaling(&squared).unwrap_err();
    assert!(matches!(error, EmbedError::UnknownDistance { i: 1, j: 2 }));
    assert!(error.to_string().starts_with("nothing is known of pair (1, 2)"));
}

#[test]
fn the_result_does_not_depend_on_the_number_of_threads() {
    let rough = squared_distances(&sunflower(300)).map(f64::sqrt).unwrap();
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| classical_scaling(&rough).unwrap())
    };
    assert_eq!(run(1), run(4));
}
