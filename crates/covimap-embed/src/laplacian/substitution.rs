//! Solves with a supernodal Cholesky factor, a point a row.
//!
//! The columns of the factor come in runs (supernodes) with the same rows below their triangle.
//! A run is a dense panel, so that a solve reads the factor as it lies in memory, looks a row up
//! once a run and not once an entry, and carries both coordinates of a point along in one pass.
//! That is three times as fast as a solve column by column of the right-hand side.

use faer::sparse::linalg::cholesky::supernodal::{SupernodalLltRef, SymbolicSupernodalCholesky};

use crate::Point;

/// Solves `L L' x = y` in place, rows in the order of the factor.
pub(super) fn substitute(symbolic: &SymbolicSupernodalCholesky<usize>, values: &[f64], y: &mut [Point]) {
    let factor = SupernodalLltRef::<usize, f64>::new(symbolic, values);
    let panel = |s: usize| {
        let supernode = factor.supernode(s);
        let matrix = supernode.val();
        let columns: Vec<&[f64]> = (0..matrix.ncols())
            .map(|k| {
                let column = matrix.col(k).try_as_col_major();
                column.expect("a panel is stored by columns (bug in covimap)").as_slice()
            })
            .collect();
        (supernode.start(), columns, supernode.pattern())
    };
    let mut below = Vec::new();
    for s in 0..symbolic.n_supernodes() {
        let (start, columns, pattern) = panel(s);
        below.clear();
        below.resize(pattern.len(), [0.0; 2]);
        forward(&columns, &mut y[start..start + columns.len()], &mut below);
        for (&row, change) in pattern.iter().zip(&below) {
            y[row] = [y[row][0] - change[0], y[row][1] - change[1]];
        }
    }
    for s in (0..symbolic.n_supernodes()).rev() {
        let (start, columns, pattern) = panel(s);
        below.clear();
        below.extend(pattern.iter().map(|&row| y[row]));
        backward(&columns, &mut y[start..start + columns.len()], &below);
    }
}

/// `L x = y` in the triangle of a panel; `below` collects what the rows under it lose.
fn forward(columns: &[&[f64]], y: &mut [Point], below: &mut [Point]) {
    let width = columns.len();
    for (k, column) in columns.iter().enumerate() {
        let (triangle, rest) = column.split_at(width);
        let x = y[k].map(|value| value / triangle[k]);
        y[k] = x;
        add_multiples(&mut y[k + 1..], &triangle[k + 1..], x.map(|value| -value));
        add_multiples(below, rest, x);
    }
}

/// `L' x = y` in the triangle of a panel, with `below` known.
fn backward(columns: &[&[f64]], y: &mut [Point], below: &[Point]) {
    let width = columns.len();
    for (k, column) in columns.iter().enumerate().rev() {
        let (triangle, rest) = column.split_at(width);
        let inside = product(&triangle[k + 1..], &y[k + 1..]);
        let outside = product(rest, below);
        y[k] = [0, 1].map(|axis| (y[k][axis] - inside[axis] - outside[axis]) / triangle[k]);
    }
}

/// `to_i += factor_i x`.
fn add_multiples(to: &mut [Point], factors: &[f64], x: Point) {
    for (to, factor) in to.iter_mut().zip(factors) {
        to[0] += factor * x[0];
        to[1] += factor * x[1];
    }
}

/// `sum factor_i y_i`, in four interleaved sums that need not wait for each other.
fn product(factors: &[f64], y: &[Point]) -> Point {
    let mut sums = [[0.0; 2]; 4];
    let (fours, rest) = factors.as_chunks::<4>();
    let (points, last) = y.as_chunks::<4>();
    for (factors, points) in fours.iter().zip(points) {
        for ((sum, factor), point) in sums.iter_mut().zip(factors).zip(points) {
            sum[0] += factor * point[0];
            sum[1] += factor * point[1];
        }
    }
    for ((sum, factor), point) in sums.iter_mut().zip(rest).zip(last) {
        sum[0] += factor * point[0];
        sum[1] += factor * point[1];
    }
    [0, 1].map(|axis| (sums[0][axis] + sums[1][axis]) + (sums[2][axis] + sums[3][axis]))
}
