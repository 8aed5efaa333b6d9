//! Recognition by distance, with a soft edge; walls block sight.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::Sensor;
use crate::angle::wrap;
use crate::geometry::{Point, Pose, Segment};
use crate::grid::{BoxGrid, PointGrid, wall_grid};
use crate::world::World;

/// Beyond `range + CUT * edge` the chance is below `detection / 2900` and taken as 0.
const CUT: f64 = 8.0;

/// The curve of the chance to recognise a landmark over its distance.
#[derive(Debug, Clone, Copy)]
pub(super) struct RangeCurve {
    /// Distance of half the chance, metres.
    pub range: f64,
    /// Softness, metres.
    pub edge: f64,
    /// Chance close by.
    pub detection: f64,
}

impl RangeCurve {
    /// `detection / (1 + exp((d - range) / edge))`
    pub(super) fn chance(&self, distance: f64) -> f64 {
        self.detection / (1.0 + ((distance - self.range) / self.edge).exp())
    }

    /// Distance from which on nothing is recognised.
    pub(super) fn reach(&self) -> f64 {
        self.range + CUT * self.edge
    }
}

/// Recognises what is near and in sight.
pub(super) struct RangeSensor {
    curve: RangeCurve,
    half_view: f64,
    /// By landmark.
    detectability: Vec<f64>,
    landmarks: PointGrid,
    walls: BoxGrid<Segment>,
    rng: ChaCha8Rng,
}

impl RangeSensor {
    /// A sensor that looks `half_view` radians to either side.
    pub(super) fn new(
        world: &World,
        curve: RangeCurve,
        half_view: f64,
        detectability: Vec<f64>,
        rng: ChaCha8Rng,
    ) -> Self {
        let bounds = world.plan().bounds();
        Self {
            curve,
            half_view,
            detectability,
            landmarks: PointGrid::new(world.landmarks(), bounds, curve.reach()),
            walls: wall_grid(world.plan().walls(), bounds, curve.reach()),
            rng,
        }
    }
}

impl Sensor for RangeSensor {
    fn sense(&mut self, pose: Pose, seen: &mut Vec<u32>) {
        let Self { curve, half_view, detectability, landmarks, walls, rng } = self;
        let walls = walls.near(pose.at);
        landmarks.for_each_within(pose.at, curve.reach(), |found| {
            let chance = detectability[found.number as usize] * curve.chance(found.distance2.sqrt());
            if rng.random::<f64>() >= chance || !is_in_view(pose, found.offset, *half_view) {
                return;
            }
            let target = [pose.at[0] + found.offset[0], pose.at[1] + found.offset[1]];
            let sight = Segment { a: pose.at, b: target };
            if !walls.iter().any(|wall| wall.crosses(&sight)) {
                seen.push(found.number);
            }
        });
    }
}

/// Whether the middle of the landmark lies in the field of view.
fn is_in_view(pose: Pose, offset: Point, half_view: f64) -> bool {
    half_view >= std::f64::consts::PI || wrap(offset[1].atan2(offset[0]) - pose.heading).abs() <= half_view
}
