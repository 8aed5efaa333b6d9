use proptest::prelude::*;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::*;
use crate::solve::tests::cases;

/// Lower triangle of `[[a, -1, 0], [-1, 3, -1], [0, -1, 2]]`.
fn chain(a: f64) -> LowerTriangle<1> {
    LowerTriangle {
        starts: vec![0, 2, 4, 5],
        rows: vec![0, 1, 1, 2, 2],
        blocks: [a, -1.0, 3.0, -1.0, 2.0].map(|value| [[value]]).to_vec(),
    }
}

#[test]
fn other_values_in_the_same_places_are_factored_anew() {
    let factored = SparseCholesky::new(&chain(4.0)).unwrap().refactor(&chain(1.0)).unwrap();
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
        assert!(matches!(SparseCholesky::new(&chain(a)), Err(EmbedError::Singular { order: 3 })), "{a}");
        let refactored = SparseCholesky::new(&chain(4.0)).unwrap().refactor(&chain(a));
        assert!(matches!(refactored, Err(EmbedError::Singular { order: 3 })), "{a}");
    }
}

/// A grid of `width` by `height` unknowns, each tied to its neighbours, in a shuffled order.
fn grid<const B: usize>(
    width: usize,
    height: usize,
    block: impl Fn(f64) -> [[f64; B]; B],
) -> LowerTriangle<B> {
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
    let (mut starts, mut rows, mut blocks) = (vec![0], Vec::new(), Vec::new());
    for (column, mut below) in (0..).zip(below) {
        below.sort_unstable();
        rows.push(column);
        blocks.push(block(4.01));
        rows.extend(below.into_iter().map(|row| row as u32));
        blocks.resize(rows.len(), block(-1.0));
        starts.push(rows.len() as u32);
    }
    LowerTriangle { starts, rows, blocks }
}

fn gcd(a: usize, b: usize) -> usize {
    if b == 0 { a } else { gcd(b, a % b) }
}

/// Several right-hand sides, an unknown a row.
fn sides<const K: usize>(n: usize) -> Vec<[f64; K]> {
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    (0..n).map(|_| std::array::from_fn(|_| rng.random::<f64>() - 0.5)).collect()
}

fn largest_miss<const B: usize, const K: usize>(
    matrix: &LowerTriangle<B>,
    solved: &[[f64; K]],
    wanted: &[[f64; K]],
) -> f64 {
    let mut most = 0.0_f64;
    for k in 0..K {
        let column: Vec<f64> = solved.iter().map(|row| row[k]).collect();
        for (got, wanted) in matrix.times(&column).iter().zip(wanted) {
            most = most.max((got - wanted[k]).abs());
        }
    }
    most
}

/// One unknown an object.
fn single(value: f64) -> [[f64; 1]; 1] {
    [[value]]
}

/// Two unknowns an object, which are tied a little.
fn tied(value: f64) -> [[f64; 2]; 2] {
    [[value, 0.1 * value], [0.1 * value, value]]
}

/// Two unknowns an object; one is tied to the other of the next object, but not the other way round.
fn twisted(value: f64) -> [[f64; 2]; 2] {
    if value > 0.0 { tied(1.5 * value) } else { [[value, 0.2 * value], [0.0, value]] }
}

/// Entry of the symmetric matrix, by what the blocks are said to be.
fn entry(matrix: &LowerTriangle<2>, a: usize, b: usize) -> f64 {
    let (row, column) = if a / 2 < b / 2 { (b, a) } else { (a, b) };
    let mut own = matrix.column(column / 2);
    own.find(|&k| matrix.rows[k] as usize == row / 2).map_or(0.0, |k| matrix.blocks[k][row % 2][column % 2])
}

fn on<T: Send>(threads: usize, work: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(work)
}

#[test]
fn a_large_matrix_is_factored_and_solved_in_parts_by_any_number_of_threads() {
    let matrix = grid(170, 150, twisted);
    let elimination = Elimination::of(matrix.objects(), matrix.edges()).unwrap();
    assert!(elimination.parts.len() > 8, "{:?}", elimination.parts);
    assert!(*elimination.parts.last().unwrap() as usize > matrix.objects() * 9 / 10);
    let wanted = sides::<3>(matrix.order());
    let solved = |threads| {
        on(threads, || {
            let factored = SparseCholesky::new(&matrix).unwrap();
            let mut solved = wanted.clone();
            factored.solve(&mut solved);
            (factored.values, solved)
        })
    };
    let one = solved(1);
    assert!(largest_miss(&matrix, &one.1, &wanted) < 1e-12);
    assert!([2, 3].iter().all(|&threads| solved(threads) == one));
}

#[test]
fn parts_do_not_depend_on_each_other() {
    let matrix = grid(150, 160, single);
    let Elimination { order, places, parts } = Elimination::of(matrix.objects(), matrix.edges()).unwrap();
    let part = |unknown: u32| parts.partition_point(|&end| end <= places[unknown as usize]);
    for (a, b) in matrix.edges() {
        let (a, b) = (part(a), part(b));
        assert!(a == b || a.max(b) == parts.len(), "{a} {b} of {}", parts.len());
    }
    assert!((0..).zip(&order).all(|(place, &object)| places[object as usize] == place));
}

/// All links among `n` objects.
fn complete<const B: usize>(n: u32, block: impl Fn(f64) -> [[f64; B]; B]) -> LowerTriangle<B> {
    let column = |k: u32| (k..n).map(move |row| (k, row));
    let rows: Vec<(u32, u32)> = (0..n).flat_map(column).collect();
    let mut starts = vec![0];
    (0..n).for_each(|k| starts.push(starts[k as usize] + n - k));
    let blocks = rows.iter().map(|&(k, row)| block(if k == row { f64::from(2 * n) } else { -1.0 })).collect();
    LowerTriangle { starts, rows: rows.into_iter().map(|(_, row)| row).collect(), blocks }
}

#[test]
fn a_large_front_is_eliminated_by_any_number_of_threads() {
    let matrix = complete(250, tied);
    let factored = |threads| on(threads, || SparseCholesky::new(&matrix).unwrap());
    let one = factored(1);
    assert_eq!(one.structure.panels.columns.len(), 2, "one front");
    assert!([2, 3].iter().all(|&threads| factored(threads).values == one.values));
    let wanted = sides::<1>(matrix.order());
    let mut solved = wanted.clone();
    one.solve(&mut solved);
    assert!(largest_miss(&matrix, &solved, &wanted) < 1e-12);
}

#[test]
fn the_factor_is_that_of_the_dense_matrix() {
    let matrix = grid(9, 7, twisted);
    let order = matrix.order();
    let factored = SparseCholesky::new(&matrix).unwrap();
    let Structure { order: objects, panels, .. } = &factored.structure;
    let unknown = |row: usize| 2 * objects[row / 2] as usize + row % 2;
    let mut factor = vec![vec![0.0; order]; order];
    for run in 0..panels.columns.len() - 1 {
        let (panel, rows) = panels.panel(run, &factored.values);
        let columns = panels.of_run(run);
        let all: Vec<u32> = columns.clone().chain(rows.iter().copied()).collect();
        for (k, values) in panel.chunks_exact(all.len()).enumerate() {
            for (&row, value) in all.iter().zip(values).skip(k) {
                factor[row as usize][columns.start as usize + k] = *value;
            }
        }
    }
    for a in 0..order {
        let unit: Vec<f64> = (0..order).map(|k| f64::from(u8::from(k == unknown(a)))).collect();
        let column = matrix.times(&unit);
        for b in 0..order {
            let product: f64 = factor[a].iter().zip(&factor[b]).map(|(a, b)| a * b).sum();
            let wanted = entry(&matrix, unknown(b), unknown(a));
            assert!((product - wanted).abs() < 1e-13 && column[unknown(b)] == wanted, "{a} {b}");
        }
    }
}

proptest! {
    #![proptest_config(cases(32))]

    /// A factor taken with the order of another one of the same structure is that of its own matrix.
    #[test]
    fn another_matrix_of_the_same_structure(width in 1_usize..9, height in 1_usize..9, more in 0.0_f64..3.0) {
        let first = grid(width, height, tied);
        let second = grid(width, height, |value| tied(if value > 0.0 { value + more } else { value }));
        let factored = SparseCholesky::new(&first).unwrap().refactor(&second).unwrap();
        let wanted = sides::<2>(second.order());
        let mut solved = wanted.clone();
        factored.solve(&mut solved);
        prop_assert!(largest_miss(&second, &solved, &wanted) < 1e-12);
    }
}
