//! Recognition errors: sightings that are lost, and sightings of the wrong landmark.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use crate::spec::ErrorSpec;

/// Spoils lists of seen landmarks.
pub(super) struct Errors {
    pub spec: ErrorSpec,
    /// Number of landmarks in the world.
    pub landmarks: u32,
    pub rng: ChaCha8Rng,
}

impl Errors {
    /// Loses each sighting with the one probability; turns what is left into a random other landmark with
    /// the other, seen from as far. Three random numbers a sighting, whatever the rates: a higher rate spoils the same
    /// sightings and more.
    pub(super) fn apply(&mut self, sightings: &mut Vec<(u32, f64)>) {
        let Self { spec, landmarks, rng } = self;
        sightings.retain_mut(|(number, _)| {
            let [lost, mistaken, other]: [f64; 3] = rng.random();
            if mistaken < spec.mistaken && *landmarks > 1 {
                *number = another(*number, *landmarks, other);
            }
            lost >= spec.missed
        });
    }
}

/// A landmark that is not `number`, chosen by a share in `[0, 1)`; all others are as likely.
fn another(number: u32, landmarks: u32, share: f64) -> u32 {
    let other = (share * f64::from(landmarks - 1)) as u32;
    if other < number { other } else { other + 1 }
}
