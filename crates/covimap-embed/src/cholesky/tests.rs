use proptest::prelude::*;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::*;
use crate::solve::tests::cases;

/// Lower triangle of `[[a, -1, 0], [-1, 3, -1], [0, -1, 2]]`.
fn chain(a: f64) -> LowerTriangle {
    LowerTriangle {
        starts: vec![0, 2, 4, 5],
        rows: vec![0, 1, 1, 2, 2],
        values: vec![a, -1.0, 3.0, -1.0, 2.0],
    }
}

#[test]
fn other_values_in_the_same_places_are_factored_anew() {
    let factored = Factored::new(&chain(4.0)).unwrap().refactor(&chain(1.0)).unwrap();
    // [[1, -1, 0], [-1, 3, -1], [0, -1, 2]] (1, 2, 3)' = (-1, 2, 4)'.
    assert_eq!(chain(1.0).times(&[1.0, 2.0, 3.0]), [-1.0, 2.0, 4.0]);
    let mut solution = [[-1.0], [2.0], [4.0]];
    factored.solve(&mut solution);
    for ([got], wanted) in solution.iter().zip([1.0, 2.0, 3.0]) {
        assert!((got - wanted).abs() < 1e-14, "{solution:?}");
    }
}

#[test]
fn a_matrix_that_is_not_positive_definite_is_refused() {
    // The determinant 6 a - a - 2 = 5 a - 2 is zero at 0.4 and negative below.
    for a in [0.3, -1.0, f64::NAN] {
        assert!(matches!(Factored::new(&chain(a)), Err(EmbedError::Singular { order: 3 })), "{a}");
        let refactored = Factored::new(&chain(4.0)).unwrap().refactor(&chain(a));
        assert!(matches!(refactored, Err(EmbedError::Singular { order: 3 })), "{a}");
    }
}

/// A grid of `width` by `height` unknowns, each tied to its neighbours, in a shuffled order.
fn grid(width: usize, height: usize) -> LowerTriangle {
    let n = width * height;
    // A multiplier without common divisors with n goes through all numbers.
    let mut step = n / 2 + 1;
    while gcd(step, n) > 1 {
        step += 1;
    }
    let name = |column: usize, row: usize| (row * width + column) * step % n;
    let mut below = vec![Vec::new(); n];
    for (column, row) in (0..width).flat_map(|column| (0..height).map(move |row| (column, row))) {
        let own = name(column, row);
        for (column, row) in [(column + 1, row), (column, row + 1)] {
            if column < width && row < height {
                let other = name(column, row);
                below[own.min(other)].push(own.max(other));
            }
        }
    }
    let (mut starts, mut rows, mut values) = (vec![0], Vec::new(), Vec::new());
    for (column, mut below) in below.into_iter().enumerate() {
        below.sort_unstable();
        rows.push(column);
        values.push(4.01);
        rows.extend(&below);
        values.resize(rows.len(), -1.0);
        starts.push(rows.len());
    }
    LowerTriangle { starts, rows, values }
}

fn gcd(a: usize, b: usize) -> usize {
    if b == 0 { a } else { gcd(b, a % b) }
}

/// Several right-hand sides, an unknown a row.
fn sides<const K: usize>(n: usize) -> Vec<[f64; K]> {
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    (0..n).map(|_| std::array::from_fn(|_| rng.random::<f64>() - 0.5)).collect()
}

fn largest_miss<const K: usize>(matrix: &LowerTriangle, solved: &[[f64; K]], wanted: &[[f64; K]]) -> f64 {
    let mut most = 0.0_f64;
    for k in 0..K {
        let column: Vec<f64> = solved.iter().map(|row| row[k]).collect();
        for (got, wanted) in matrix.times(&column).iter().zip(wanted) {
            most = most.max((got - wanted[k]).abs());
        }
    }
    most
}

#[test]
fn a_large_matrix_is_solved_in_parts_by_any_number_of_threads() {
    let matrix = grid(170, 150);
    let n = matrix.order();
    let elimination = Elimination::of(n, matrix.entries()).unwrap();
    assert!(elimination.parts.len() > 8, "{:?}", elimination.parts);
    assert!(*elimination.parts.last().unwrap() > n * 9 / 10);
    let factored = Factored::eliminated(&matrix, elimination).unwrap();
    let wanted = sides::<3>(n);
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let mut solved = wanted.clone();
        pool.install(|| factored.solve(&mut solved));
        solved
    };
    let solved = on(1);
    assert!(largest_miss(&matrix, &solved, &wanted) < 1e-12);
    assert_eq!(solved, on(3));
}

#[test]
fn parts_do_not_depend_on_each_other() {
    let matrix = grid(150, 160);
    let Elimination { order, places, parts } = Elimination::of(matrix.order(), matrix.entries()).unwrap();
    let part = |unknown: u32| parts.partition_point(|&end| end <= places[unknown as usize]);
    for (a, b) in matrix.entries() {
        let (a, b) = (part(a), part(b));
        assert!(a == b || a.max(b) == parts.len(), "{a} {b} of {}", parts.len());
    }
    assert!((0..order.len()).all(|place| places[order[place]] == place));
}

#[test]
fn blocks_stand_where_their_unknown_stood() {
    let chain = Elimination::of(3, chain(4.0).entries()).unwrap();
    let first = chain.order[0];
    let blocks = chain.in_blocks(2);
    assert_eq!(blocks.order[..2], [2 * first, 2 * first + 1]);
    assert!((0..6).all(|place| blocks.places[blocks.order[place]] == place));
}

proptest! {
    #![proptest_config(cases(32))]

    /// A factor taken with the order of another one of the same structure is that of its own matrix.
    #[test]
    fn another_matrix_of_the_same_structure(width in 1_usize..9, height in 1_usize..9, more in 0.0_f64..3.0) {
        let first = grid(width, height);
        let values = first.starts.iter().take(width * height).fold(first.values.clone(), |mut values, &start| {
            values[start] += more;
            values
        });
        let second = LowerTriangle { starts: first.starts.clone(), rows: first.rows.clone(), values };
        let factored = Factored::new(&first).unwrap().another(&second).unwrap();
        let wanted = sides::<2>(width * height);
        let mut solved = wanted.clone();
        factored.solve(&mut solved);
        prop_assert!(largest_miss(&second, &solved, &wanted) < 1e-12);
    }
}
