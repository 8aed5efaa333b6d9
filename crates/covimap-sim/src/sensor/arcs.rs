//! Unions of arcs of the horizon, exactly: what nearer things hide of farther ones.

use std::f64::consts::PI;

use crate::angle::wrap;

/// Less than this is rounding, radians.
const NOTHING: f64 = 1e-12;

/// A part of the horizon: disjoint intervals of bearings in `[-pi, pi]`, ascending.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Arcs {
    parts: Vec<(f64, f64)>,
}

impl Arcs {
    /// Makes it everything outside a field of view that reaches `half` to either side of bearing 0.
    pub(super) fn reset_outside(&mut self, half: f64) {
        self.parts.clear();
        if half < PI {
            self.parts.extend([(-PI, -half), (half, PI)]);
        }
    }

    /// How much of the arc from `middle - half` to `middle + half` lies outside; exactly 0 if nothing does.
    pub(super) fn uncovered(&self, middle: f64, half: f64) -> f64 {
        let pieces = split(middle, half);
        let covered = pieces.iter().flat_map(|&(low, high)| {
            self.parts.iter().map(move |part| (part.1.min(high) - part.0.max(low)).max(0.0))
        });
        let rest = 2.0 * half - covered.sum::<f64>();
        if rest < NOTHING { 0.0 } else { rest }
    }

    /// Adds the arc from `middle - half` to `middle + half`.
    pub(super) fn cover(&mut self, middle: f64, half: f64) {
        for piece in split(middle, half) {
            if piece.0 < piece.1 {
                self.insert(piece);
            }
        }
    }

    fn insert(&mut self, (mut low, mut high): (f64, f64)) {
        let first = self.parts.partition_point(|part| part.1 < low);
        let end = self.parts.partition_point(|part| part.0 <= high);
        if first < end {
            low = low.min(self.parts[first].0);
            high = high.max(self.parts[end - 1].1);
        }
        self.parts.splice(first..end, [(low, high)]);
    }
}

/// The arc as two intervals within `[-pi, pi]`; the second is empty unless the arc goes across the back.
fn split(middle: f64, half: f64) -> [(f64, f64); 2] {
    let middle = wrap(middle);
    let (low, high) = (middle - half, middle + half);
    if low < -PI {
        [(-PI, high), (low + 2.0 * PI, PI)]
    } else if high > PI {
        [(low, PI), (-PI, high - 2.0 * PI)]
    } else {
        [(low, high), (0.0, 0.0)]
    }
}
