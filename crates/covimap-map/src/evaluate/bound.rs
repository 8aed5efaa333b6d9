//! How well a log could be mapped at best.
//!
//! A landmark that is seen with chance `p v(d)` from the distance `d`, `v(d) = 1 / (1 + exp((d - R) / s))`, betrays
//! its place where the chance is neither near 0 nor near `p`. Looks from known places all around it carry the
//! Fisher information
//!
//! `F = n_i / 2 * J / Q`, `J = int P'^2 / (P (1 - P)) r dr`, `Q = int P r dr`  (1)
//!
//! about each coordinate, `n_i` being the number of sightings. For an edge that is narrow against the range,
//! `Q = p R^2 / 2`, and with `dv = -v (1 - v) dr / s`
//!
//! `J = R / s * I(p)`, `I(p) = int_0^1 p (1 - v) / (1 - p v) dv = 1 + (1 - p) / p * ln(1 - p)`.  (2)
//!
//! The Cramer-Rao bound on the distance of an estimate from the true place is then
//!
//! `E |x - x_i|^2 >= 2 / F = 2 p R s / (I(p) n_i)`.  (3)
//!
//! It is a bound for *known* places of observation, in sight from all sides. The places are unknown, of course:
//! at best the error is one to two times that. Walls around a landmark cost more.
//!
//! Landmarks that stand at random, `1 / a^2` in a unit of area, have about `1.9 r / a` of their Delaunay edges wrong if
//! each is off by `r` (measured by simulation; the nearest neighbour is at `a / 2` in the mean).

use serde::Serialize;

/// Share of Delaunay edges that differ, for each unit of error over the spacing of the landmarks.
const DELAUNAY_SLOPE: f64 = 1.9;

/// What could be reached if the places of all steps were known, eq. (3).
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Bound {
    /// Root mean square distance from the true places, in the unit of the truth.
    pub rmse: f64,
    /// Delaunay error to expect from that.
    pub delaunay_error: f64,
}

/// Sums over landmarks that make a [`Bound`].
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct BoundSum {
    landmarks: f64,
    squares: f64,
    delaunay: f64,
}

impl BoundSum {
    /// Adds landmarks `(detectability, sightings)` of a chart whose sensor has this range and edge, in the
    /// unit of the truth, as has the mean distance of nearest neighbours.
    pub fn add(&mut self, range: f64, edge: f64, nearest: f64, landmarks: impl Iterator<Item = (f64, u32)>) {
        for (p, sightings) in landmarks {
            let square = expected_square(range, edge, p, f64::from(sightings));
            self.landmarks += 1.0;
            self.squares += square;
            self.delaunay += DELAUNAY_SLOPE * square.sqrt() / (2.0 * nearest);
        }
    }

    /// The bound; `None` for no landmarks, or where landmarks stand in one place.
    pub fn bound(self) -> Option<Bound> {
        let [square, delaunay] = [self.squares, self.delaunay].map(|sum| sum / self.landmarks);
        (square.is_finite() && delaunay.is_finite())
            .then(|| Bound { rmse: square.sqrt(), delaunay_error: delaunay.min(2.0) })
    }
}

/// Eq. (3).
fn expected_square(range: f64, edge: f64, p: f64, sightings: f64) -> f64 {
    let information = 1.0 + (1.0 - p) / p * (1.0 - p).ln();
    2.0 * p * range * edge / (information * sightings)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_information_of_the_edge_is_that_of_the_integral() {
        // Eq. (1) by the midpoint rule over r, for a narrow edge.
        let (range, edge) = (1.0, 0.005);
        for p in [0.3, 0.5, 0.9, 0.99] {
            let (mut q, mut j) = (0.0, 0.0);
            let dr = 1e-5;
            for k in 0..120_000 {
                let r = (f64::from(k) + 0.5) * dr;
                let v = 1.0 / (1.0 + ((r - range) / edge).exp());
                let (chance, slope) = (p * v, p * v * (1.0 - v) / edge);
                q += chance * r * dr;
                j += slope * slope / (chance * (1.0 - chance)) * r * dr;
            }
            let wanted = 2.0 / (100.0 / 2.0 * j / q);
            let found = expected_square(range, edge, p, 100.0);
            assert!((found / wanted - 1.0).abs() < 0.01, "{p}: {found} for {wanted}");
        }
    }

    #[test]
    fn a_bound_by_hand() {
        // I(1/2) = 1 - ln 2 = .306853; two landmarks: 2 * .5 * 2 * .1 / (.306853 * n) = .651778 / n.
        let mut sum = BoundSum::default();
        assert_eq!(sum.bound(), None);
        sum.add(2.0, 0.1, 0.5, [(0.5, 100), (0.5, 400)].into_iter());
        let bound = sum.bound().unwrap();
        // sqrt((.00651778 + .00162945) / 2), and 1.9 / (2 * .5) * (.0807328 + .0403664) / 2.
        assert!((bound.rmse - 0.063_824).abs() < 1e-5, "{bound:?}");
        assert!((bound.delaunay_error - 0.115_044).abs() < 1e-5, "{bound:?}");
    }

    #[test]
    fn landmarks_in_one_place_have_no_bound_and_none_is_worse_than_chance() {
        let bound = |nearest| {
            let mut sum = BoundSum::default();
            sum.add(1.0, 0.1, nearest, std::iter::once((0.9, 1)));
            sum.bound()
        };
        assert_eq!(bound(0.0), None);
        assert!((bound(1e-3).unwrap().delaunay_error - 2.0).abs() < 1e-15);
    }
}
