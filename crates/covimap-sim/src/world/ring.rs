//! A ring: a corridor around a square block, and a horseshoe: the same with one side missing.

use crate::floor_plan::FloorPlan;
use crate::geometry::Rect;

/// Outer side over corridor width.
const SIDE_IN_WIDTHS: f64 = 5.0;

/// The corridor around a block: outer side `s`, corridor `w = s / 5`, area `4 w (s - w) = 16 s^2 / 25`.
pub(super) fn ring(area: f64) -> FloorPlan {
    let width = (area / (4.0 * (SIDE_IN_WIDTHS - 1.0))).sqrt();
    FloorPlan::new(around_block(width, 4), Vec::new())
}

/// The corridor without its right side, a letter C: area `w (3 s - 2 w) = 13 s^2 / 25`.
pub(super) fn horseshoe(area: f64) -> FloorPlan {
    let width = (area / (3.0 * SIDE_IN_WIDTHS - 2.0)).sqrt();
    FloorPlan::new(around_block(width, 3), Vec::new())
}

/// The first `sides` of: bottom, top, left, right.
fn around_block(width: f64, sides: usize) -> Vec<Rect> {
    let side = SIDE_IN_WIDTHS * width;
    let inner = side - width;
    let mut tiles = vec![
        Rect { min: [0.0, 0.0], max: [side, width] },
        Rect { min: [0.0, inner], max: [side, side] },
        Rect { min: [0.0, width], max: [width, inner] },
        Rect { min: [inner, width], max: [side, inner] },
    ];
    tiles.truncate(sides);
    tiles
}
