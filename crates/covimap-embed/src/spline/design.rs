//! A basis at given places, to be fitted to values there again and again.

use nalgebra::{DMatrix, DVector};

use super::MonotoneSplineBasis;
use crate::nnls::non_negative_least_squares;

/// The B-splines of a basis at the places `x`, and the normal equations of fits with given weights.
#[derive(Debug, Clone)]
pub(crate) struct SplineDesign {
    weights: Vec<f64>,
    /// First B-spline that is not zero at each place.
    first: Vec<usize>,
    /// Values of the B-splines from there: `width` a place.
    values: Vec<f64>,
    width: usize,
    /// `A' W A` in integrated splines.
    gram: DMatrix<f64>,
}

impl SplineDesign {
    /// Evaluates the basis at every place.
    pub fn new(basis: &MonotoneSplineBasis, x: &[f64], weights: &[f64]) -> Self {
        let width = basis.degree + 1;
        let p = basis.coefficients();
        let mut first = Vec::with_capacity(x.len());
        let mut values = Vec::with_capacity(width * x.len());
        let mut gram = DMatrix::zeros(p, p);
        for (&x, &weight) in x.iter().zip(weights) {
            // In B-splines only degree + 1 entries of a row are not zero.
            let (from, row) = basis.b_splines(x);
            for (i, value) in row.iter().enumerate() {
                for (j, other) in row.iter().enumerate() {
                    gram[(from + i, from + j)] += weight * value * other;
                }
            }
            first.push(from);
            values.extend(row);
        }
        // Eq. (2), I = T B with T upper triangular of ones: sums from the end, on either side.
        for k in (1..p).rev() {
            let below = gram.row(k).clone_owned();
            gram.row_mut(k - 1).zip_apply(&below, |entry, add| *entry += add);
        }
        for k in (1..p).rev() {
            let after = gram.column(k).clone_owned();
            gram.column_mut(k - 1).zip_apply(&after, |entry, add| *entry += add);
        }
        Self { weights: weights.to_vec(), first, values, width, gram }
    }

    /// Coefficients `b_0 .. b_p` of the curve nearest to the values `y`.
    pub fn nearest(&self, y: &[f64]) -> Vec<f64> {
        let p = self.gram.nrows();
        let mut c = DVector::zeros(p);
        for (((&from, row), y), weight) in self.rows().zip(y).zip(&self.weights) {
            row.iter().enumerate().for_each(|(i, value)| c[from + i] += weight * value * y);
        }
        for k in (1..p).rev() {
            c[k - 1] += c[k];
        }
        non_negative_least_squares(&self.gram, &c).iter().copied().collect()
    }

    /// The curve's values at the places.
    pub fn values(&self, coefficients: &[f64]) -> Vec<f64> {
        // Eq. (2) exchanged: the coefficient of B_k is the sum of b_0 .. b_k.
        let mut level = 0.0;
        let levels: Vec<f64> = coefficients
            .iter()
            .map(|b| {
                level += b;
                level
            })
            .collect();
        let value = |(&from, row): (&usize, &[f64])| {
            row.iter().zip(&levels[from..]).map(|(value, level)| value * level).sum()
        };
        self.rows().map(value).collect()
    }

    fn rows(&self) -> impl Iterator<Item = (&usize, &[f64])> {
        self.first.iter().zip(self.values.chunks_exact(self.width))
    }
}
