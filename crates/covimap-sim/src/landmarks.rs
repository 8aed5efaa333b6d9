//! Places for landmarks: uniform over the free space, apart from each other.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use crate::error::SimError;
use crate::floor_plan::FloorPlan;
use crate::geometry::Point;
use crate::spec::WorldSpec;

/// Draws places that are uniform over the area of a floor.
pub(crate) struct FreeSpace<'p> {
    plan: &'p FloorPlan,
    /// Area of all tiles up to and with each.
    reached: Vec<f64>,
}

impl<'p> FreeSpace<'p> {
    pub(crate) fn new(plan: &'p FloorPlan) -> Self {
        let running = |sum: &mut f64, area: f64| {
            *sum += area;
            Some(*sum)
        };
        let reached = plan.tiles().iter().map(|tile| tile.area()).scan(0.0, running).collect();
        Self { plan, reached }
    }

    pub(crate) fn draw(&self, rng: &mut ChaCha8Rng) -> Point {
        let total = self.reached.last().copied().unwrap_or(0.0);
        let target = rng.random::<f64>() * total;
        let tile = self.reached.partition_point(|&area| area <= target).min(self.reached.len() - 1);
        let rect = self.plan.tiles()[tile];
        [0, 1].map(|axis| rect.min[axis] + rng.random::<f64>() * (rect.max[axis] - rect.min[axis]))
    }
}

/// Places all landmarks.
pub(crate) fn place(
    spec: &WorldSpec,
    plan: &FloorPlan,
    rng: &mut ChaCha8Rng,
) -> Result<Vec<Point>, SimError> {
    let space = FreeSpace::new(plan);
    Ok((0..spec.landmarks).map(|_| space.draw(rng)).collect())
}
