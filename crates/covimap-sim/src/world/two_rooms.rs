//! Two rooms joined by one door.

use rand_chacha::ChaCha8Rng;

use super::doors::with_door;
use crate::error::SimError;
use crate::floor_plan::FloorPlan;
use crate::geometry::{Rect, Segment};

/// Two equal square rooms side by side; the door stands at a random place in the wall between them.
pub(super) fn plan(area: f64, door: f64, rng: &mut ChaCha8Rng) -> Result<FloorPlan, SimError> {
    let side = (area / 2.0).sqrt();
    let tiles =
        vec![Rect { min: [0.0, 0.0], max: [side, side] }, Rect { min: [side, 0.0], max: [2.0 * side, side] }];
    let wall = Segment { a: [side, 0.0], b: [side, side] };
    Ok(FloorPlan::new(tiles, with_door(wall, door, rng)?.to_vec()))
}
