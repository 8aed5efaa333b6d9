//! Scattered places: no way at all, as from photographs taken here and there.

use super::{Pilot, Walker};
use crate::geometry::Pose;

/// Every pose is independent of the last.
pub(super) struct Scatter;

impl Pilot for Scatter {
    fn next(&mut self, _from: Pose, walker: &mut Walker<'_>) -> Pose {
        walker.start()
    }
}
