//! Normal equations of one point of the plane.

use covimap_embed::Point;

/// A symmetric matrix `xx, xy, yy` and a right side.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Normal {
    pub matrix: [f64; 3],
    pub side: Point,
}

impl Normal {
    /// Adds the wish to go `by` along the unit vector.
    pub fn add(&mut self, [x, y]: Point, by: f64, weight: f64) {
        let terms = [x * x, x * y, y * y];
        self.matrix.iter_mut().zip(terms).for_each(|(sum, term)| *sum += weight * term);
        self.side = [self.side[0] + weight * by * x, self.side[1] + weight * by * y];
    }

    /// The inverse with this share of the trace added to both axes; nothing for an empty matrix.
    pub fn inverse(&self, ridge: f64) -> [f64; 3] {
        let ridge = ridge * (self.matrix[0] + self.matrix[2]);
        let [xx, xy, yy] = [self.matrix[0] + ridge, self.matrix[1], self.matrix[2] + ridge];
        let determinant = xx * yy - xy * xy;
        if determinant > 0.0 { [yy, -xy, xx].map(|c| c / determinant) } else { [0.0; 3] }
    }
}

/// A symmetric matrix times a vector.
pub(super) fn times([xx, xy, yy]: [f64; 3], [x, y]: Point) -> Point {
    [xx * x + xy * y, xy * x + yy * y]
}

pub(super) fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

pub(super) fn add(a: Point, b: Point) -> Point {
    [a[0] + b[0], a[1] + b[1]]
}

pub(super) fn sub(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1]]
}

pub(super) fn length([x, y]: Point) -> f64 {
    // Much of the time is spent here, and `hypot` takes three times as long.
    (x * x + y * y).sqrt()
}
