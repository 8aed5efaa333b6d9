//! FastMap: two projections, each onto the line through two far objects.
//!
//! With `a` and `b` far apart, the coordinate of object `i` along the line `ab` follows from the
//! law of cosines,
//!
//! `x_i = (d_ai^2 + d_ab^2 - d_bi^2) / (2 d_ab)`,  (1)
//!
//! and what is left for the second axis is the distance across that line,
//!
//! `d'_ij^2 = d_ij^2 - (x_i - x_j)^2`,  (2)
//!
//! taken as zero where it would be negative. The method needs a dozen rows of distances and
//! `O(n)` steps: the fastest start there is, exact for points of the plane, and the roughest one
//! otherwise, since each axis rests on two objects.
//!
//! # References
//! C. Faloutsos, K.-I. Lin, "FastMap: a fast algorithm for indexing, data-mining and visualization
//! of traditional and multimedia datasets", SIGMOD 1995.

use crate::pivot::{checked_row, farthest};
use crate::{DistanceRows, EmbedError, Point};

/// Times that the far pair is improved by going to the object farthest from the last.
const HOPS: usize = 3;
/// A squared extent below this share of that of the first axis is zero.
const FLAT: f64 = 1e-12;

/// Places objects in the plane by eqs. (1) and (2). The first pivot of the first axis is the
/// origin; the first coordinate of the second pivot is positive.
///
/// Objects on a line get second coordinates of zero.
///
/// # Errors
/// [`EmbedError::BadDistance`] for a distance that is negative or NaN;
/// [`EmbedError::UnknownDistance`] for an infinite one: take one component at a time.
///
/// # Examples
/// ```
/// use covimap_embed::{DistanceMatrix, fastmap};
///
/// let points = [[0.0, 0.0], [3.0, 0.0], [3.0, 4.0], [0.0, 1.0]] as [[f64; 2]; 4];
/// let distance = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
/// let matrix = DistanceMatrix::from_fn(4, |i, j| distance(points[i], points[j]))?;
/// let placed = fastmap(&matrix)?;
/// assert!((distance(placed[1], placed[3]) - 10.0_f64.sqrt()).abs() < 1e-12);
/// # Ok::<(), covimap_embed::EmbedError>(())
/// ```
pub fn fastmap(distances: &impl DistanceRows) -> Result<Vec<Point>, EmbedError> {
    let mut points = vec![[0.0; 2]; distances.objects()];
    if points.is_empty() {
        return Ok(points);
    }
    let mut extent = 0.0;
    for axis in 0..2 {
        // Squares of what the axes so far leave of the distances, eq. (2).
        let left = |object: usize| -> Result<Vec<f64>, EmbedError> {
            let row = checked_row(distances, object)?;
            let left = |(point, d): (&Point, f64)| {
                let across = if axis == 0 { 0.0 } else { point[0] - points[object][0] };
                (d * d - across * across).max(0.0)
            };
            Ok(points.iter().zip(row).map(left).collect())
        };
        let mut from_a = left(0)?;
        let mut b = farthest(&from_a);
        let mut from_b = left(b)?;
        for _ in 1..HOPS {
            from_a = from_b;
            b = farthest(&from_a);
            from_b = left(b)?;
        }
        let apart = from_a[b];
        extent = apart.max(extent);
        if apart <= FLAT * extent {
            break;
        }
        let along: Vec<f64> = from_a
            .iter()
            .zip(&from_b)
            .map(|(to_a, to_b)| (to_a + apart - to_b) / (2.0 * apart.sqrt()))
            .collect();
        points.iter_mut().zip(along).for_each(|(point, x)| point[axis] = x);
    }
    Ok(points)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Correspondence, DistanceMatrix, ProcrustesOptions, procrustes};

    fn matrix_of(points: &[Point]) -> DistanceMatrix {
        let distance = |i: usize, j: usize| (points[i][0] - points[j][0]).hypot(points[i][1] - points[j][1]);
        DistanceMatrix::from_fn(points.len(), distance).unwrap()
    }

    #[test]
    fn points_of_the_plane_come_back() {
        let points: Vec<Point> = (0..40).map(|k| [f64::from(k * k % 17), f64::from(k * 5 % 23)]).collect();
        let placed = fastmap(&matrix_of(&points)).unwrap();
        let pair = |(&source, &target)| Correspondence { source, target, weight: 1.0 };
        let pairs: Vec<_> = placed.iter().zip(&points).map(pair).collect();
        let fit = procrustes(&pairs, ProcrustesOptions { scale: false, ..Default::default() }).unwrap();
        assert!(fit.rmse < 1e-12, "{}", fit.rmse);
    }

    #[test]
    fn a_table_that_is_not_flat_is_placed_by_the_formulas() {
        // All three distances of 0, 1, 2 are 2; object 3 is 1 from each of them: no such points.
        let table = DistanceMatrix::from_fn(4, |_, j| if j == 3 { 1.0 } else { 2.0 }).unwrap();
        // From 0 the farthest is 1, and back: the axis runs from 0 to 1. Objects 2 and 3 are in the
        // middle, (4 + 4 - 4) / 4 = 1 and (1 + 4 - 1) / 4 = 1. Across it 2 is sqrt(3) from 0 and 1,
        // and 3 is 0 from them: x = 0 for 0, 1 and 3 would be sqrt(3) from 2, but d_23^2 = 1:
        // (3 + 3 - 1) / (2 sqrt(3)) from 2.
        let placed = fastmap(&table).unwrap();
        let along: Vec<f64> = placed.iter().map(|point| point[0]).collect();
        assert_eq!(along, [0.0, 2.0, 1.0, 1.0]);
        let across = |i: usize, j: usize| (placed[i][1] - placed[j][1]).abs();
        assert!(across(0, 1) < 1e-15 && (across(0, 2) - f64::sqrt(3.0)).abs() < 1e-15);
        let third = (0.0 + 3.0 - 1.0) / (2.0 * f64::sqrt(3.0));
        assert!((across(0, 3) - third).abs() < 1e-15, "{placed:?}");
    }

    #[test]
    fn degenerate_sets() {
        assert!(fastmap(&matrix_of(&[])).unwrap().is_empty());
        assert_eq!(fastmap(&matrix_of(&[[5.0, 5.0]])).unwrap(), [[0.0; 2]]);
        assert_eq!(fastmap(&matrix_of(&[[5.0, 5.0]; 3])).unwrap(), [[0.0; 2]; 3]);
        let line = fastmap(&matrix_of(&[[0.1, 0.1], [0.2, 0.2], [0.7, 0.7]])).unwrap();
        assert!(line.iter().all(|point| point[1] == 0.0));
        assert!((line[0][0] - line[2][0]).abs() > 0.8);
    }

    #[test]
    fn an_unknown_distance_is_refused() {
        let unknown = DistanceMatrix::from_fn(3, |_, j| if j == 2 { f64::INFINITY } else { 1.0 }).unwrap();
        assert!(matches!(fastmap(&unknown), Err(EmbedError::UnknownDistance { i: 0, j: 2 })));
    }
}
