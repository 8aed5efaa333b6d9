//! Ranges: how far the landmarks seen are, but for noise.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use crate::geometry::{Point, Pose};

/// Shortest range that is told, metres: a log knows none of 0.
const SHORTEST: f64 = 1e-6;

/// Measures distances.
pub(super) struct Ranging {
    /// Standard deviation of the logarithm of a range.
    pub noise: f64,
    /// Where the landmarks stand.
    pub landmarks: Vec<Point>,
    pub rng: ChaCha8Rng,
}

impl Ranging {
    /// `d exp(noise z)`, metres, for a standard normal `z`. Two random numbers, whatever the noise.
    pub(super) fn measure(&mut self, pose: Pose, number: u32) -> f64 {
        let [x, y] = self.landmarks[number as usize];
        let distance = (x - pose.at[0]).hypot(y - pose.at[1]);
        let [u, v]: [f64; 2] = self.rng.random();
        // Box and Muller; 1 - u is not 0.
        let normal = (-2.0 * (1.0 - u).ln()).sqrt() * (std::f64::consts::TAU * v).cos();
        (distance * (self.noise * normal).exp()).max(SHORTEST)
    }
}
