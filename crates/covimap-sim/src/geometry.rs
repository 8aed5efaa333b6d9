//! Points, rectangles and segments of the plane, in metres.

use serde::Serialize;

/// A place, `[x, y]` in metres.
pub type Point = [f64; 2];

/// Where the robot stands and which way it looks.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Pose {
    /// Place, metres.
    pub at: Point,
    /// Direction of its nose, radians from the x axis, counter-clockwise.
    pub heading: f64,
}

/// A rectangle with sides along the axes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Rect {
    /// Lower left corner.
    pub min: Point,
    /// Upper right corner.
    pub max: Point,
}

impl Rect {
    /// Width times height, square metres.
    #[must_use]
    pub fn area(&self) -> f64 {
        (self.max[0] - self.min[0]) * (self.max[1] - self.min[1])
    }

    /// Whether the point lies in the rectangle or on its edge.
    #[must_use]
    pub fn contains(&self, point: Point) -> bool {
        (0..2).all(|axis| (self.min[axis]..=self.max[axis]).contains(&point[axis]))
    }

    /// The smallest rectangle around both.
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        Self {
            min: [self.min[0].min(other.min[0]), self.min[1].min(other.min[1])],
            max: [self.max[0].max(other.max[0]), self.max[1].max(other.max[1])],
        }
    }
}

/// A straight piece of wall, or of a robot's way, from `a` to `b`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Segment {
    /// One end.
    pub a: Point,
    /// The other end.
    pub b: Point,
}

impl Segment {
    /// Whether the two segments have a point in common; touching counts, overlapping in a line does not.
    #[must_use]
    pub fn crosses(&self, other: &Self) -> bool {
        let beside = |s: &Self, t: &Self| turn(s.a, s.b, t.a) * turn(s.a, s.b, t.b);
        let (first, second) = (beside(self, other), beside(other, self));
        first <= 0.0 && second <= 0.0 && (first < 0.0 || second < 0.0)
    }

    /// Distance between the ends.
    #[must_use]
    pub fn length(&self) -> f64 {
        (self.b[0] - self.a[0]).hypot(self.b[1] - self.a[1])
    }

    /// The point that far from `a` in the direction of `b`; `a` if both ends are one point.
    #[must_use]
    pub fn point_at(&self, distance: f64) -> Point {
        let length = self.length();
        let share = if length > 0.0 { distance / length } else { 0.0 };
        [0, 1].map(|axis| self.a[axis] + share * (self.b[axis] - self.a[axis]))
    }

    /// The point of the segment that is nearest to the given one.
    #[must_use]
    pub fn nearest_to(&self, point: Point) -> Point {
        let along = [self.b[0] - self.a[0], self.b[1] - self.a[1]];
        let offset = [point[0] - self.a[0], point[1] - self.a[1]];
        let length2 = along[0] * along[0] + along[1] * along[1];
        if length2 == 0.0 {
            return self.a;
        }
        let share = ((offset[0] * along[0] + offset[1] * along[1]) / length2).clamp(0.0, 1.0);
        [self.a[0] + share * along[0], self.a[1] + share * along[1]]
    }

    /// Distance from the point to the nearest point of the segment.
    #[must_use]
    pub fn distance_to_point(&self, point: Point) -> f64 {
        let nearest = self.nearest_to(point);
        let rest = [point[0] - nearest[0], point[1] - nearest[1]];
        (rest[0] * rest[0] + rest[1] * rest[1]).sqrt()
    }

    /// Distance between the nearest points of the two segments, 0 if they cross.
    #[must_use]
    pub fn distance_to(&self, other: &Self) -> f64 {
        if self.crosses(other) {
            return 0.0;
        }
        let from_ends = self.distance_to_point(other.a).min(self.distance_to_point(other.b));
        from_ends.min(other.distance_to_point(self.a)).min(other.distance_to_point(self.b))
    }
}

/// Twice the signed area of the triangle: positive if `c` lies to the left of the way from `a` to `b`.
fn turn(a: Point, b: Point, c: Point) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn segment(a: Point, b: Point) -> Segment {
        Segment { a, b }
    }

    #[test]
    fn segments_cross_touch_or_miss() {
        let wall = segment([0.0, 0.0], [2.0, 0.0]);
        assert!(wall.crosses(&segment([1.0, -1.0], [1.0, 1.0])));
        assert!(wall.crosses(&segment([1.0, 0.0], [1.0, 1.0])), "touching counts");
        assert!(wall.crosses(&segment([2.0, -1.0], [2.0, 1.0])), "so does touching an end");
        assert!(!wall.crosses(&segment([2.1, -1.0], [2.1, 1.0])));
        assert!(!wall.crosses(&segment([1.0, 0.1], [1.0, 1.0])));
        assert!(!wall.crosses(&segment([0.5, 0.0], [1.5, 0.0])), "along the wall");
    }

    #[test]
    fn distances_are_those_of_hand_calculation() {
        let wall = segment([0.0, 0.0], [3.0, 4.0]);
        assert!((wall.length() - 5.0).abs() < 1e-12);
        // Beside the middle, (1.5, 2) + 2 * (-0.8, 0.6); before the start; on a point.
        assert!((wall.distance_to_point([-0.1, 3.2]) - 2.0).abs() < 1e-12);
        assert!((wall.distance_to_point([-1.0, 0.0]) - 1.0).abs() < 1e-12);
        assert!((segment([1.0, 1.0], [1.0, 1.0]).distance_to_point([4.0, 5.0]) - 5.0).abs() < 1e-12);
        assert_eq!(wall.point_at(2.5), [1.5, 2.0]);
        assert_eq!(segment([1.0, 2.0], [1.0, 2.0]).point_at(0.0), [1.0, 2.0]);
        // Parallel at distance 2, crossing, and one that ends 1 m short.
        let parallel = segment([-1.6, 1.2], [1.4, 5.2]);
        assert!((wall.distance_to(&parallel) - 2.0).abs() < 1e-12);
        assert!(wall.distance_to(&segment([3.0, 0.0], [0.0, 4.0])) == 0.0);
        assert!((wall.distance_to(&segment([3.0, 5.0], [3.0, 9.0])) - 1.0).abs() < 1e-12);
    }
}
