//! Classical scaling: the plane in which squared distances are best kept as inner products.
//!
//! Given squared distances `D2` of `n` objects, the centred inner products are
//!
//! `B = -1/2 H D2 H`, `H = I - 11'/n`  (1)
//!
//! and with the two largest eigenpairs `(lambda_k, v_k)` of `B` the coordinates are
//!
//! `x_ik = sqrt(max(lambda_k, 0)) v_ik`.  (2)
//!
//! They minimise the strain `|B - X X'|^2`. The method is exact for points of the plane and a
//! good start for [stress](crate::PairDistances) otherwise; far pairs dominate it.
//!
//! # Algorithm
//! Up to [`FULL_LIMIT`] objects the whole spectrum is computed. Above it only the leading four
//! pairs are, by a block method that never forms `B`; should it not converge, the whole spectrum
//! is computed after all.
//!
//! # Complexity
//! `O(n^3)` time for the whole spectrum, `O(n^2)` per step of the block method (some ten steps
//! where the map fits the plane well).
//!
//! # Determinism
//! The start of the block method has a fixed seed and every sum a fixed order.
//!
//! # References
//! W. S. Torgerson, "Multidimensional scaling: I. Theory and method", Psychometrika 17, 1952.
//! I. Borg, P. J. F. Groenen, "Modern Multidimensional Scaling", 2nd ed., Springer 2005, ch. 12.

use rayon::prelude::*;

use crate::eigen::{BLOCK, Eigenpairs, leading_eigenpairs, symmetric_eigen};
use crate::{DistanceMatrix, EmbedError, Point};

/// Most objects for which the whole spectrum is computed at once.
const FULL_LIMIT: usize = 256;
/// Accepted residuals of the four leading pairs, relative to the largest absolute eigenvalue: the
/// two that span the plane are exact to rounding, the next two serve the report only.
const TOLERANCES: [f64; 4] = [1e-12, 1e-12, 1e-7, 1e-7];
/// Rows of one parallel task.
const ROWS: usize = 64;

/// Coordinates in the plane and the spectrum that they come from.
#[derive(Debug, Clone, PartialEq)]
pub struct ClassicalScaling {
    /// One point per object, centred on the origin, axes in descending order of their variance.
    ///
    /// On each axis the coordinate of largest absolute value is positive (the first such object
    /// decides between equal ones). Axes of equal variance are any orthogonal pair of the plane.
    pub points: Vec<Point>,
    /// Eigenvalues of `B`, descending: all `n` up to 256 objects, the four largest above. Negative
    /// ones say that the table is not Euclidean; a third one near the second, not flat.
    pub eigenvalues: Vec<f64>,
    /// Axes in use: 2, or 1 if the objects lie on a line, or 0 if they coincide. The coordinates
    /// on an unused axis are zero. An axis is used if its eigenvalue exceeds `8 n` times the
    /// rounding error of the largest absolute one.
    pub rank: usize,
}

/// Places objects in the plane from their SQUARED distances.
///
/// # Errors
/// [`EmbedError::UnknownDistance`] if an entry is infinite.
///
/// # Examples
/// ```
/// use covimap_embed::{DistanceMatrix, classical_scaling};
///
/// // A right triangle with legs 3 and 4.
/// let squared = DistanceMatrix::from_rows(3, vec![0., 9., 16., 9., 0., 25., 16., 25., 0.])?;
/// let scaled = classical_scaling(&squared)?;
/// let [a, b] = [scaled.points[1], scaled.points[2]];
/// assert!(((a[0] - b[0]).hypot(a[1] - b[1]) - 5.0).abs() < 1e-12);
/// # Ok::<(), covimap_embed::EmbedError>(())
/// ```
pub fn classical_scaling(squared: &DistanceMatrix) -> Result<ClassicalScaling, EmbedError> {
    if let Some((i, j)) = squared.first_unknown() {
        return Err(EmbedError::UnknownDistance { i, j });
    }
    let n = squared.objects();
    // Entries of order one, so that no sum overflows.
    let unit = (0..n).flat_map(|i| squared.row(i)).fold(0.0, |most: f64, &d| most.max(d));
    if unit == 0.0 {
        let eigenvalues = vec![0.0; reported(n)];
        return Ok(ClassicalScaling { points: vec![[0.0; 2]; n], eigenvalues, rank: 0 });
    }
    let block_method = || leading_eigenpairs(n, &TOLERANCES, |block| centred_product(squared, unit, block));
    let few = if n > FULL_LIMIT { block_method() } else { None };
    let pairs = few.unwrap_or_else(|| symmetric_eigen(n, &inner_products(squared, unit)));
    Ok(coordinates(n, unit, &pairs))
}

/// Eq. (1), divided by `unit`.
fn inner_products(squared: &DistanceMatrix, unit: f64) -> Vec<f64> {
    let n = squared.objects();
    let mean = |i: usize| squared.row(i).iter().map(|d| d / unit).sum::<f64>() / n as f64;
    let means: Vec<f64> = (0..n).map(mean).collect();
    let grand = means.iter().sum::<f64>() / n as f64;
    let entry = |i: usize, j: usize| -0.5 * (squared.get(i, j) / unit - means[i] - means[j] + grand);
    (0..n * n).map(|at| entry(at / n, at % n)).collect()
}

/// `B V / unit`, without forming `B`.
fn centred_product(squared: &DistanceMatrix, unit: f64, block: &[[f64; BLOCK]]) -> Vec<[f64; BLOCK]> {
    let n = squared.objects();
    let block = centred(block.to_vec());
    let row_times_block = |i: usize| {
        let mut sum = [0.0; BLOCK];
        for (d, row) in squared.row(i).iter().zip(&block) {
            for (s, v) in sum.iter_mut().zip(row) {
                *s += d * v;
            }
        }
        sum.map(|s| -0.5 * s / unit)
    };
    centred((0..n).into_par_iter().with_min_len(ROWS).map(row_times_block).collect())
}

/// Subtracts the mean of each column.
fn centred(mut block: Vec<[f64; BLOCK]>) -> Vec<[f64; BLOCK]> {
    let mut mean = [0.0; BLOCK];
    for row in &block {
        mean.iter_mut().zip(row).for_each(|(m, x)| *m += x);
    }
    mean.iter_mut().for_each(|m| *m /= block.len() as f64);
    for row in &mut block {
        row.iter_mut().zip(&mean).for_each(|(x, m)| *x -= m);
    }
    block
}

/// Eq. (2).
fn coordinates(n: usize, unit: f64, pairs: &Eigenpairs) -> ClassicalScaling {
    let largest = pairs.values.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
    let noise = 8.0 * n as f64 * f64::EPSILON * largest;
    let rank = pairs.values.iter().take(2).filter(|&&value| value > noise).count();
    let mut points = vec![[0.0; 2]; n];
    for (axis, (value, vector)) in pairs.values.iter().zip(&pairs.vectors).take(rank).enumerate() {
        let length = value.sqrt() * unit.sqrt() * sign(vector);
        points.iter_mut().zip(vector).for_each(|(point, x)| point[axis] = length * x);
    }
    let eigenvalues = pairs.values.iter().take(reported(n)).map(|value| value * unit).collect();
    ClassicalScaling { points, eigenvalues, rank }
}

/// Number of eigenvalues handed out for `n` objects.
fn reported(n: usize) -> usize {
    if n > FULL_LIMIT { TOLERANCES.len() } else { n }
}

/// The sign that makes the entry of largest absolute value positive. Entries that differ by
/// rounding count as equal: the first one decides.
pub(crate) fn sign(vector: &[f64]) -> f64 {
    let largest = vector.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    let leader = vector.iter().find(|x| x.abs() >= largest * (1.0 - 1e-9));
    leader.map_or(1.0, |x| x.signum())
}

#[cfg(test)]
mod tests;
