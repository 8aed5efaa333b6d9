//! Delaunay edges of a set of points: who is next to whom.
//!
//! The triangulation itself is `spade`'s, with exact predicates. What this module adds is a
//! definite answer for every input.
//!
//! - *Scale.* Coordinates are brought near 1 by a power of two, and a far-off origin is moved
//!   close; both steps are exact, so the edges are those of the points as given.
//! - *Coincident points.* The lowest-numbered one stands for its place; the copies form a path
//!   that starts at it, in the order of their numbers. `n >= 3` points still have at most `3n - 6` edges.
//! - *Collinear points* give the path along the line.
//! - *Cocircular points* (a regular grid) have several valid triangulations. One of them is
//!   returned, always the same for the same input; that of a turned copy may differ.
//!
//! # Complexity
//! `O(n log n)` time, `O(n)` memory.
//!
//! # References
//! B. Delaunay, *Sur la sphère vide*, 1934. J. R. Shewchuk, *Adaptive precision floating-point
//! arithmetic and fast robust geometric predicates*, 1997.

use covimap_embed::Point;
use spade::{DelaunayTriangulation, Point2, Triangulation};

use crate::MapError;

/// Coordinates below this share of the largest are zero to spade's predicates.
const NEGLIGIBLE: f64 = 1e-40;

/// The Delaunay edges `(i, j)`, `i < j`, ascending.
///
/// # Errors
/// [`MapError::NotFinite`] for the first point with a coordinate that is NaN or infinite.
pub fn delaunay_edges(points: &[Point]) -> Result<Vec<(u32, u32)>, MapError> {
    if let Some(index) = points.iter().position(|point| !point.iter().all(|v| v.is_finite())) {
        return Err(MapError::NotFinite { index, position: points[index] });
    }
    let points = normalised(points);
    let mut order: Vec<u32> = (0..points.len()).map(number).collect();
    order.sort_unstable_by(|&a, &b| {
        let (p, q) = (points[a as usize], points[b as usize]);
        p[0].total_cmp(&q[0]).then(p[1].total_cmp(&q[1])).then(a.cmp(&b))
    });
    let mut edges = Vec::with_capacity(3 * points.len());
    let mut places = Vec::with_capacity(points.len());
    for twins in order.chunk_by(|&a, &b| points[a as usize] == points[b as usize]) {
        places.push(twins[0]);
        edges.extend(twins.windows(2).map(|pair| (pair[0], pair[1])));
    }
    // In the order given: the choice among cocircular points then does not depend on the frame.
    places.sort_unstable();
    edges.extend(triangulated(&points, &places));
    edges.sort_unstable();
    Ok(edges)
}

/// Edges between distinct points.
fn triangulated(points: &[Point], places: &[u32]) -> Vec<(u32, u32)> {
    let vertices = places.iter().map(|&i| points[i as usize]).map(|[x, y]| Point2::new(x, y)).collect();
    let triangulation = DelaunayTriangulation::<Point2<f64>>::bulk_load_stable(vertices)
        .expect("coordinates are normalised (bug in covimap)");
    assert_eq!(triangulation.num_vertices(), places.len(), "places are distinct (bug in covimap)");
    triangulation
        .undirected_edges()
        .map(|edge| edge.vertices().map(|vertex| places[vertex.fix().index()]))
        .map(|[a, b]| (a.min(b), a.max(b)))
        .collect()
}

/// The same points with coordinates in `[-1, 1]`, moved to the origin where they are far from it.
fn normalised(points: &[Point]) -> Vec<Point> {
    let shift = [0, 1].map(|axis| {
        let (low, high) = points.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), point| {
            (low.min(point[axis]), high.max(point[axis]))
        });
        // All values within a factor of 2 of each other: their differences are exact (Sterbenz).
        let far = (low > 0.0 && high <= 2.0 * low) || (high < 0.0 && low >= 2.0 * high);
        if far { low } else { 0.0 }
    });
    let moved = points.iter().map(|point| [point[0] - shift[0], point[1] - shift[1]]);
    let largest = moved.clone().flatten().fold(0.0, |largest: f64, v| largest.max(v.abs()));
    // Two factors, since the inverse of a subnormal number is infinite.
    let exponent = if largest > 0.0 { -(largest.log2().floor() as i32 + 1) } else { 0 };
    let scale = [exponent / 2, exponent - exponent / 2].map(|e| 2f64.powi(e));
    let scaled = |v: f64| {
        let v = v * scale[0] * scale[1];
        if v.abs() < NEGLIGIBLE { 0.0 } else { v }
    };
    moved.map(|point| point.map(scaled)).collect()
}

fn number(index: usize) -> u32 {
    u32::try_from(index).expect("fewer than 2^32 points (bug in covimap)")
}

#[cfg(test)]
mod tests;
