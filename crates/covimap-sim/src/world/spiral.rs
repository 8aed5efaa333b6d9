//! A spiral: one long corridor that winds around its inner end.

use crate::floor_plan::FloorPlan;
use crate::geometry::{Point, Rect};

/// The four directions, counter-clockwise.
const DIRECTIONS: [Point; 4] = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]];

/// A corridor of the given width along legs of length `1, 1, 2, 2, 3, 3, ...` times `width + wall`.
///
/// The last leg ends where the wanted area is reached: a middle line of length `l` gives `width (l + width)`.
/// An area of less than two squares of that width gets a narrower corridor, one leg of two squares.
pub(super) fn plan(area: f64, width: f64, wall: f64) -> FloorPlan {
    let width = width.min((area / 2.0).sqrt());
    let half = width / 2.0;
    let mut remaining = area / width - width;
    let mut corner = [0.0; 2];
    let mut tiles = Vec::new();
    let mut leg = 0_u32;
    loop {
        let direction = DIRECTIONS[leg as usize % 4];
        let full = f64::from(leg / 2 + 1) * (width + wall);
        // A rest shorter than the corridor is wide would not reach past the corner; it goes to this leg.
        let last = remaining < full + width;
        let length = if last { remaining } else { full };
        let next = [corner[0] + length * direction[0], corner[1] + length * direction[1]];
        tiles.push(leg_tile(corner, next, direction, half, last));
        if last {
            return FloorPlan::new(tiles, Vec::new());
        }
        remaining -= length;
        corner = next;
        leg += 1;
    }
}

/// The leg with the square around its first corner; the square around its end belongs to the next leg.
fn leg_tile(from: Point, to: Point, direction: Point, half: f64, last: bool) -> Rect {
    let mut tile = Rect { min: [0.0; 2], max: [0.0; 2] };
    for axis in 0..2 {
        let (low, high) = (from[axis].min(to[axis]) - half, from[axis].max(to[axis]) + half);
        // Towards the next leg the tile ends where that leg's own edge lies.
        tile.max[axis] = if direction[axis] > 0.0 && !last { to[axis] - half } else { high };
        tile.min[axis] = if direction[axis] < 0.0 && !last { to[axis] + half } else { low };
    }
    tile
}
