//! Street blocks: a grid of streets around square buildings.

use crate::floor_plan::FloorPlan;
use crate::geometry::Rect;

/// `k x k` buildings of side `b` with streets of width `s` between and around them.
///
/// The free area `(k b + (k + 1) s)^2 - k^2 b^2` cannot meet the wanted area for every `b` and `s`: `k` is
/// taken so that it comes near, and then both are scaled by one factor.
pub(super) fn plan(area: f64, street: f64, building: f64) -> FloorPlan {
    let free = |k: f64| (k * building + (k + 1.0) * street).powi(2) - (k * building).powi(2);
    let mut count = 1;
    while free(f64::from(count) + 0.5) < area {
        count += 1;
    }
    let scale = (area / free(f64::from(count))).sqrt();
    let (street, building) = (scale * street, scale * building);
    let start = |index: u32| f64::from(index) * (street + building);
    let end = |index: u32| start(index) + street;
    let side = end(count);
    let mut tiles = Vec::new();
    for row in 0..=count {
        tiles.push(Rect { min: [0.0, start(row)], max: [side, end(row)] });
        for column in (0..=count).filter(|_| row < count) {
            tiles.push(Rect { min: [start(column), end(row)], max: [end(column), start(row + 1)] });
        }
    }
    FloorPlan::new(tiles, Vec::new())
}
