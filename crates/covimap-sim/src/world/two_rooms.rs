//! Two rooms joined by one door.

use rand_chacha::ChaCha8Rng;

use super::office::wall_with_door;
use crate::floor_plan::FloorPlan;
use crate::geometry::{Rect, Segment};

/// Two equal square rooms side by side; the door stands at a random place in the wall between them.
pub(super) fn plan(area: f64, door: f64, rng: &mut ChaCha8Rng) -> FloorPlan {
    let side = (area / 2.0).sqrt();
    let tiles =
        vec![Rect { min: [0.0, 0.0], max: [side, side] }, Rect { min: [side, 0.0], max: [2.0 * side, side] }];
    let wall = Segment { a: [side, 0.0], b: [side, side] };
    FloorPlan::new(tiles, &wall_with_door(wall, door, rng))
}
