//! Recognition by distance, with a soft edge; walls block sight.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use crate::geometry::{Pose, Segment};
use crate::grid::{PointGrid, WallGrid};
use crate::spec::RangeSpec;
use crate::world::World;

/// Beyond `range + CUT * edge` the chance is below `detection / 2900` and taken as 0.
const CUT: f64 = 8.0;

/// Recognises a landmark in sight at distance `d` with probability `detection / (1 + exp((d - range) / edge))`.
pub(crate) struct RangeSensor {
    spec: RangeSpec,
    reach: f64,
    landmarks: PointGrid,
    walls: WallGrid,
    rng: ChaCha8Rng,
}

impl RangeSensor {
    pub(crate) fn new(world: &World, spec: RangeSpec, rng: ChaCha8Rng) -> Self {
        let bounds = world.plan().bounds();
        let reach = spec.range + CUT * spec.edge;
        Self {
            spec,
            reach,
            landmarks: PointGrid::new(world.landmarks(), bounds, reach),
            walls: WallGrid::new(world.plan().walls(), bounds, reach),
            rng,
        }
    }

    /// Appends the numbers of the recognised landmarks.
    pub(crate) fn sense(&mut self, pose: Pose, seen: &mut Vec<u32>) {
        let Self { spec, reach, landmarks, walls, rng } = self;
        let near = walls.near(pose.at);
        landmarks.for_each_within(pose.at, *reach, |number, offset, distance2| {
            let chance = spec.detection / (1.0 + ((distance2.sqrt() - spec.range) / spec.edge).exp());
            if rng.random::<f64>() >= chance {
                return;
            }
            let target = [pose.at[0] + offset[0], pose.at[1] + offset[1]];
            let sight = Segment { a: pose.at, b: target };
            if !near.iter().any(|wall| wall.crosses(&sight)) {
                seen.push(number);
            }
        });
    }
}
