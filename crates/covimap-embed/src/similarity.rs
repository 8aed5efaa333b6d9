//! Similarity transforms of the plane, with or without a reflection.

use crate::Point;

/// `x -> scale * R x + shift`, where `R` is a rotation, or a rotation after mirroring the y axis.
///
/// Name values `target_from_source`: `global_from_local.apply(point_in_local)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Similarity {
    /// Cosine of the rotation angle.
    pub cos: f64,
    /// Sine of the rotation angle.
    pub sin: f64,
    /// Whether the y axis is mirrored before the rotation.
    pub mirrored: bool,
    /// Scale, `> 0`.
    pub scale: f64,
    /// Shift, applied last.
    pub shift: Point,
}

impl Similarity {
    /// The transform that leaves every point where it is.
    pub const IDENTITY: Self = Self { cos: 1.0, sin: 0.0, mirrored: false, scale: 1.0, shift: [0.0; 2] };

    /// The image of a point.
    #[must_use]
    pub fn apply(&self, point: Point) -> Point {
        let y = if self.mirrored { -point[1] } else { point[1] };
        [
            self.scale * (self.cos * point[0] - self.sin * y) + self.shift[0],
            self.scale * (self.sin * point[0] + self.cos * y) + self.shift[1],
        ]
    }

    /// The transform that first applies `first`, then `self`.
    #[must_use]
    pub fn after(&self, first: &Self) -> Self {
        let turn = if self.mirrored { -first.sin } else { first.sin };
        Self {
            cos: self.cos * first.cos - self.sin * turn,
            sin: self.sin * first.cos + self.cos * turn,
            mirrored: self.mirrored != first.mirrored,
            scale: self.scale * first.scale,
            shift: self.apply(first.shift),
        }
    }

    /// The transform that undoes `self`.
    #[must_use]
    pub fn inverse(&self) -> Self {
        // Mirrored: (s R M)^-1 = M R' / s = R M / s, the same angle; else the opposite angle.
        let sin = if self.mirrored { self.sin } else { -self.sin };
        let linear = Self { sin, scale: 1.0 / self.scale, shift: [0.0; 2], ..*self };
        let moved = linear.apply(self.shift);
        Self { shift: [-moved[0], -moved[1]], ..linear }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(a: Point, b: Point) -> bool {
        (a[0] - b[0]).hypot(a[1] - b[1]) < 1e-12
    }

    #[test]
    fn inverse_and_composition_agree_with_applying_one_after_the_other() {
        for (mirrored_a, mirrored_b) in [(false, false), (false, true), (true, false), (true, true)] {
            let a = Similarity { cos: 0.6, sin: 0.8, mirrored: mirrored_a, scale: 2.0, shift: [1.0, -3.0] };
            let b = Similarity { cos: -0.28, sin: 0.96, mirrored: mirrored_b, scale: 0.5, shift: [4.0, 0.5] };
            let p = [0.7, -1.1];
            assert!(close(a.after(&b).apply(p), a.apply(b.apply(p))));
            assert!(close(a.inverse().apply(a.apply(p)), p));
            assert!(close(a.apply(a.inverse().apply(p)), p));
        }
    }
}
