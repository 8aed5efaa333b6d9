//! Scaling of very many objects from their distances to a few pivots.
//!
//! [`landmark_scaling`] places the `k` pivots by classical scaling and every other object by its
//! distances to them,
//!
//! `x_a = -1/2 L# (delta_a - mean delta)`  (1)
//!
//! with `delta` squared distances to the pivots and `L#` the pseudo-inverse of the pivots'
//! coordinates. It is exact for points of the plane. [`pivot_scaling`] takes all distances to the
//! pivots into account at once: with `C` the `n x k` table of squared distances, centred along
//! rows and columns, `C = -1/2 H_n D2 H_k`, and its leading singular triples `(u, s, v)`,
//!
//! `x_i = u_i sqrt(s)`, times the scale that fits the distances best.  (2)
//!
//! It is less disturbed by distances that do not fit the plane.
//!
//! # Complexity
//! `k` rows of distances, `O(n k)` to choose the pivots, `O(n k^2 + k^3)` for either method.
//!
//! # References
//! V. de Silva, J. B. Tenenbaum, "Sparse multidimensional scaling using landmark points", Stanford
//! 2004. U. Brandes, C. Pich, "Eigensolver methods for progressive multidimensional scaling of large
//! data", Graph Drawing 2006.

use rayon::prelude::*;

use crate::classical::sign;
use crate::eigen::symmetric_eigen;
use crate::{DistanceMatrix, DistanceRows, EmbedError, Point, classical_scaling};

/// Objects of one parallel task.
const OBJECTS: usize = 1024;
/// A singular value below this share of the largest is zero: it comes from an eigenvalue of
/// `C' C`, its square.
const FLAT: f64 = 1e-7;

/// Distances of all objects to a few of them.
#[derive(Debug, Clone, PartialEq)]
pub struct PivotDistances {
    objects: usize,
    pivots: Vec<u32>,
    /// `rows[p]` holds the distances of pivot `p` to all objects.
    rows: Vec<Vec<f64>>,
}

impl PivotDistances {
    /// Chooses up to `count` pivots, each as far as can be from those before it. The first is the
    /// object farthest from object 0; there are fewer if no other object is off the pivots.
    ///
    /// # Errors
    /// [`EmbedError::BadDistance`] for a distance that is negative or NaN;
    /// [`EmbedError::UnknownDistance`] for an infinite one: take one component at a time;
    /// [`EmbedError::Lengths`] for a row that has not an entry for each object.
    ///
    /// # Examples
    /// ```
    /// use covimap_embed::{Pair, PairDistances, PivotDistances, ShortestPaths, landmark_scaling};
    ///
    /// // A chain of a thousand links: three pivots are enough.
    /// let link = |i| Pair { i, j: i + 1, distance: 1.0, weight: 1.0 };
    /// let chain = PairDistances::new(1001, (0..1000).map(link).collect())?;
    /// let pivots = PivotDistances::max_min(&ShortestPaths::new(&chain), 3)?;
    /// assert_eq!(pivots.pivots(), [1000, 0, 500]);
    /// let points = landmark_scaling(&pivots);
    /// assert!(((points[0][0] - points[700][0]).abs() - 700.0).abs() < 1e-6);
    /// # Ok::<(), covimap_embed::EmbedError>(())
    /// ```
    pub fn max_min(distances: &impl DistanceRows, count: usize) -> Result<Self, EmbedError> {
        let objects = distances.objects();
        let mut chosen = Self { objects, pivots: Vec::new(), rows: Vec::new() };
        if objects == 0 || count == 0 {
            return Ok(chosen);
        }
        let mut next = farthest(&checked_row(distances, 0)?);
        let mut nearest = vec![f64::INFINITY; objects];
        while chosen.pivots.len() < count && nearest[next] > 0.0 {
            let row = checked_row(distances, next)?;
            nearest.iter_mut().zip(&row).for_each(|(near, &d)| *near = near.min(d));
            chosen.pivots.push(next as u32);
            chosen.rows.push(row);
            next = farthest(&nearest);
        }
        Ok(chosen)
    }

    /// The pivots, in the order of their choice.
    #[must_use]
    pub fn pivots(&self) -> &[u32] {
        &self.pivots
    }

    /// For each pivot, its distances to all objects.
    pub fn rows(&self) -> impl Iterator<Item = &[f64]> {
        self.rows.iter().map(Vec::as_slice)
    }

    /// Largest distance to a pivot.
    fn largest(&self) -> f64 {
        self.rows.iter().flatten().fold(0.0, |most: f64, &d| most.max(d))
    }
}

/// A row of distances, all known.
pub(crate) fn checked_row(distances: &impl DistanceRows, i: usize) -> Result<Vec<f64>, EmbedError> {
    let row = distances.row(i);
    if row.len() != distances.objects() {
        return Err(EmbedError::Lengths { first: distances.objects(), second: row.len() });
    }
    for (j, &distance) in row.iter().enumerate() {
        if distance.is_nan() || distance < 0.0 {
            let what = "a distance must be a number and not negative";
            return Err(EmbedError::BadDistance { i, j, distance, what });
        }
        if distance.is_infinite() {
            return Err(EmbedError::UnknownDistance { i, j });
        }
    }
    Ok(row)
}

/// The first of the objects with the largest distance.
pub(crate) fn farthest(distances: &[f64]) -> usize {
    let mut best = 0;
    for (object, &distance) in distances.iter().enumerate() {
        if distance > distances[best] {
            best = object;
        }
    }
    best
}

/// Places all objects by eq. (1). Axes and signs are those of [`classical_scaling`] of the pivots;
/// the mean of the pivots is the origin.
///
/// Pivots on a line, or fewer than three, fix one axis only: the second coordinates are zero.
#[must_use]
pub fn landmark_scaling(distances: &PivotDistances) -> Vec<Point> {
    let (unit, k) = (distances.largest(), distances.pivots.len());
    if unit == 0.0 {
        return vec![[0.0; 2]; distances.objects];
    }
    let squared = |p: usize, object: usize| (distances.rows[p][object] / unit).powi(2);
    let between = |p: usize, q: usize| squared(p, distances.pivots[q] as usize);
    let table = DistanceMatrix::from_fn(k, between).expect("checked distances (bug in covimap)");
    let placed = classical_scaling(&table).expect("known distances (bug in covimap)");
    let mean = |p: usize| (0..k).map(|q| between(p, q)).sum::<f64>() / k as f64;
    let means: Vec<f64> = (0..k).map(mean).collect();
    let place = |object: usize| {
        let mut point = [0.0; 2];
        for (axis, x) in point.iter_mut().enumerate().take(placed.rank) {
            // Row `axis` of L#: the coordinates over the eigenvalue, which is their squared norm.
            let product = |p: usize| placed.points[p][axis] * (squared(p, object) - means[p]);
            *x = -0.5 * unit * (0..k).map(product).sum::<f64>() / placed.eigenvalues[axis];
        }
        point
    };
    (0..distances.objects).into_par_iter().with_min_len(OBJECTS).map(place).collect()
}

/// Places all objects by eq. (2), centred on the origin, with the signs of [`classical_scaling`].
///
/// Objects on a line, or a single pivot, leave the second coordinates at zero.
#[must_use]
pub fn pivot_scaling(distances: &PivotDistances) -> Vec<Point> {
    let (unit, k, n) = (distances.largest(), distances.pivots.len(), distances.objects);
    if unit == 0.0 {
        return vec![[0.0; 2]; n];
    }
    let rows = centred_squares(distances, unit);
    let mut gram = vec![0.0; k * k];
    for p in 0..k {
        for q in 0..=p {
            let product: f64 = rows[p].iter().zip(&rows[q]).map(|(a, b)| a * b).sum();
            gram[p * k + q] = product;
            gram[q * k + p] = product;
        }
    }
    let pairs = symmetric_eigen(k, &gram);
    let mut points = vec![[0.0; 2]; n];
    for axis in 0..k.min(2) {
        let singular = pairs.values[axis].max(0.0).sqrt();
        if singular <= FLAT * pairs.values[0].max(0.0).sqrt() {
            break;
        }
        // C v = s u, hence u sqrt(s) = C v / sqrt(s).
        let of = |object: usize| -> f64 { (0..k).map(|p| rows[p][object] * pairs.vectors[axis][p]).sum() };
        let column: Vec<f64> = (0..n).into_par_iter().with_min_len(OBJECTS).map(of).collect();
        let factor = sign(&column) / singular.sqrt();
        points.iter_mut().zip(column).for_each(|(point, x)| point[axis] = factor * x);
    }
    let scale = fitting_scale(distances, &points);
    points.iter_mut().flatten().for_each(|x| *x *= scale);
    points
}

/// `C'`, in units of `unit` squared.
fn centred_squares(distances: &PivotDistances, unit: f64) -> Vec<Vec<f64>> {
    let (k, n) = (distances.pivots.len(), distances.objects);
    let mut rows: Vec<Vec<f64>> =
        distances.rows.iter().map(|row| row.iter().map(|d| -0.5 * (d / unit).powi(2)).collect()).collect();
    for row in &mut rows {
        let mean = row.iter().sum::<f64>() / n as f64;
        row.iter_mut().for_each(|x| *x -= mean);
    }
    for object in 0..n {
        let mean = rows.iter().map(|row| row[object]).sum::<f64>() / k as f64;
        rows.iter_mut().for_each(|row| row[object] -= mean);
    }
    rows
}

/// The scale `c` that minimises `sum (d - c r)^2` over the distances `d` to pivots: `sum d r / sum
/// r^2`. Zero if all objects coincide.
fn fitting_scale(distances: &PivotDistances, points: &[Point]) -> f64 {
    let (mut products, mut squares) = (0.0, 0.0);
    for (&pivot, row) in distances.pivots.iter().zip(&distances.rows) {
        let [x, y] = points[pivot as usize];
        for (point, d) in points.iter().zip(row) {
            let r = (point[0] - x).hypot(point[1] - y);
            products += d * r;
            squares += r * r;
        }
    }
    if squares > 0.0 { products / squares } else { 0.0 }
}

#[cfg(test)]
mod tests;
