//! Recognition by the visual angle of the part of a cylinder that shows.
//!
//! A cylinder of radius `r` at distance `d` fills the bearings `beta +- asin(r / d)`. Cylinders are taken from
//! near to far; what the nearer ones fill already is hidden. For equal discs that do not overlap this order is
//! exact: of two discs on a line of sight the one with the nearer middle is met first. A cylinder whose middle
//! is behind a wall neither shows nor hides anything.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::Sensor;
use super::arcs::Arcs;
use crate::geometry::{Pose, Segment};
use crate::grid::{BoxGrid, Found, PointGrid, wall_grid};
use crate::world::World;

/// Measures how much of each cylinder shows.
pub(super) struct Camera {
    landmarks: PointGrid,
    walls: BoxGrid<Segment>,
    radius: f64,
    reach: f64,
    half_view: f64,
    near: Vec<Found>,
    hidden: Arcs,
}

impl Camera {
    /// A camera that looks `half_view` radians to either side and leaves out what shows less than `least`
    /// radians at any rate: all that is farther off than `r / sin(least / 2)`.
    pub(super) fn new(world: &World, half_view: f64, least: f64) -> Self {
        let bounds = world.plan().bounds();
        let radius = world.diameter() / 2.0;
        let diagonal = (bounds.max[0] - bounds.min[0]).hypot(bounds.max[1] - bounds.min[1]);
        let reach = if least > 0.0 { diagonal.min(radius / (least / 2.0).sin()) } else { diagonal };
        Self {
            landmarks: PointGrid::new(world.landmarks(), bounds, reach),
            walls: wall_grid(world.plan().walls(), bounds, reach),
            radius,
            reach,
            half_view,
            near: Vec::new(),
            hidden: Arcs::default(),
        }
    }

    /// The cylinders around the pose from near to far, and the angle of each that shows, radians.
    pub(super) fn look(&mut self, pose: Pose) -> impl Iterator<Item = (u32, f64)> {
        let Self { landmarks, walls, radius, reach, half_view, near, hidden } = self;
        near.clear();
        let walls = walls.near(pose.at);
        landmarks.for_each_within(pose.at, *reach, |found| {
            let middle = [pose.at[0] + found.offset[0], pose.at[1] + found.offset[1]];
            let sight = Segment { a: pose.at, b: middle };
            if !walls.iter().any(|wall| wall.crosses(&sight)) {
                near.push(found);
            }
        });
        near.sort_unstable_by(|a, b| a.distance2.total_cmp(&b.distance2).then(a.number.cmp(&b.number)));
        hidden.reset_outside(*half_view);
        near.iter().map(move |found| {
            let bearing = found.offset[1].atan2(found.offset[0]) - pose.heading;
            let half = (*radius / found.distance2.sqrt()).min(1.0).asin();
            let shows = hidden.uncovered(bearing, half);
            hidden.cover(bearing, half);
            (found.number, shows)
        })
    }
}

/// Threshold and detectability of one landmark.
#[derive(Debug, Clone, Copy)]
pub(super) struct Limits {
    /// Visual angle to be reached, radians.
    pub threshold: f64,
    /// Factor of the chance to be recognised.
    pub detectability: f64,
}

/// Recognises what shows enough of itself.
pub(super) struct VisualAngle {
    pub camera: Camera,
    /// Of the logistic curve, per radian; a sharp threshold without.
    pub steepness: Option<f64>,
    /// By landmark.
    pub limits: Vec<Limits>,
    pub rng: ChaCha8Rng,
}

impl Sensor for VisualAngle {
    fn sense(&mut self, pose: Pose, seen: &mut Vec<u32>) {
        for (number, shows) in self.camera.look(pose) {
            let Limits { threshold, detectability } = self.limits[number as usize];
            let chance = detectability * chance(shows, threshold, self.steepness);
            if self.rng.random::<f64>() < chance {
                seen.push(number);
            }
        }
    }
}

/// Chance that a landmark is recognised of which this much shows: the paper's eq. (14), or its sharp limit.
/// What is hidden altogether never is.
pub(super) fn chance(shows: f64, threshold: f64, steepness: Option<f64>) -> f64 {
    match steepness {
        _ if shows <= 0.0 => 0.0,
        None => f64::from(u8::from(shows > threshold)),
        Some(steepness) => 1.0 / (1.0 + (-steepness * (shows - threshold)).exp()),
    }
}
