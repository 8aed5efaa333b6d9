//! Walls with a door.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use crate::error::SimError;
use crate::geometry::Segment;

/// The two pieces of a wall beside a door of the given width, which stands at a random place.
///
/// # Errors
/// [`SimError::DoorTooWide`] if the wall is shorter than the door.
pub(super) fn with_door(wall: Segment, door: f64, rng: &mut ChaCha8Rng) -> Result<[Segment; 2], SimError> {
    let length = wall.length();
    if door > length {
        return Err(SimError::DoorTooWide { door, wall: length });
    }
    let start = rng.random::<f64>() * (length - door);
    let (left, right) = (wall.point_at(start), wall.point_at(start + door));
    Ok([Segment { a: wall.a, b: left }, Segment { a: right, b: wall.b }])
}
