//! One seed, several independent streams of random numbers.
//!
//! Each purpose draws from its own ChaCha8 stream, so that another sensor leaves the walk as it was, and
//! another walk leaves the world as it was.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

/// What random numbers are drawn for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Stream {
    /// Doors and branches of the floor.
    Floor = 0,
    /// Places of the landmarks.
    Landmarks = 1,
    /// The robot's way.
    Motion = 2,
    /// Traits of single landmarks: detectability, thresholds.
    Traits = 3,
    /// Whether a landmark in view is recognised.
    Sensing = 4,
    /// Recognition errors.
    Errors = 5,
    /// Noise of ranges.
    Ranges = 6,
}

/// The generator for one purpose under one seed.
pub(crate) fn stream(seed: u64, purpose: Stream) -> ChaCha8Rng {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream(purpose as u64);
    rng
}
