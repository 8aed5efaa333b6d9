//! A square hall: convex, no inner walls.

use crate::floor_plan::FloorPlan;
use crate::geometry::Rect;

/// One square of the given area.
pub(super) fn plan(area: f64) -> FloorPlan {
    let side = area.sqrt();
    FloorPlan::new(vec![Rect { min: [0.0; 2], max: [side; 2] }], Vec::new())
}
