//! A robot's body: one step in about the wanted direction, round whatever is in the way.

use std::f64::consts::{FRAC_PI_4, PI};

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use crate::geometry::{Point, Pose, Segment};
use crate::grid::{PointGrid, WallGrid};
use crate::landmarks::FreeSpace;
use crate::spec::StepSpec;
use crate::world::World;

/// Turns to try when the way is blocked, in eighths of a full turn: small ones first, both sides.
const TURNS: [f64; 8] = [0.0, 1.0, -1.0, 2.0, -2.0, 3.0, -3.0, 4.0];

/// Takes steps that keep clear of walls and landmarks.
pub(crate) struct Walker<'w> {
    world: &'w World,
    walls: WallGrid,
    obstacles: Option<PointGrid>,
    step: StepSpec,
    rng: ChaCha8Rng,
}

impl<'w> Walker<'w> {
    pub(crate) fn new(world: &'w World, step: StepSpec, rng: ChaCha8Rng) -> Self {
        let bounds = world.plan().bounds();
        let walls = WallGrid::new(world.plan().walls(), bounds, step.longest + step.clearance);
        let obstacles = (world.diameter() > 0.0).then(|| {
            PointGrid::new(world.landmarks(), bounds, step.longest + step.clearance + world.diameter() / 2.0)
        });
        Self { world, walls, obstacles, step, rng }
    }

    /// A random free place and direction.
    pub(crate) fn start(&mut self) -> Pose {
        let space = FreeSpace::new(self.world.plan());
        loop {
            let at = space.draw(&mut self.rng);
            if self.is_free(at, at) {
                return Pose { at, heading: self.rng.random_range(-PI..PI) };
            }
        }
    }

    /// One step: the direction is uniform within the turn limit of the wanted one, the length uniform.
    ///
    /// If that way is blocked the robot turns by the least multiple of 45 degrees that frees it, to a random
    /// side first. If no direction is free it stays and turns round.
    pub(crate) fn step(&mut self, from: Pose, wanted: f64) -> Pose {
        let mut uniform = |low: f64, high: f64| low + (high - low) * self.rng.random::<f64>();
        let heading = wanted + uniform(-self.step.turn, self.step.turn);
        let length = uniform(self.step.shortest, self.step.longest);
        let side = if self.rng.random::<bool>() { FRAC_PI_4 } else { -FRAC_PI_4 };
        for turn in TURNS {
            let heading = heading + turn * side;
            let at = [from.at[0] + length * heading.cos(), from.at[1] + length * heading.sin()];
            if self.is_free(from.at, at) {
                return Pose { at, heading: heading.rem_euclid(2.0 * PI) };
            }
        }
        Pose { at: from.at, heading: (heading + PI).rem_euclid(2.0 * PI) }
    }

    /// Whether the way between the two places keeps clear of everything.
    fn is_free(&self, from: Point, to: Point) -> bool {
        let way = Segment { a: from, b: to };
        let clearance = self.step.clearance;
        self.walls.near(from).iter().all(|wall| wall.distance_to(&way) >= clearance)
            && self.obstacles.as_ref().is_none_or(|obstacles| {
                let keep = clearance + self.world.diameter() / 2.0;
                let mut free = true;
                obstacles.for_each_within(from, self.step.longest + keep, |_, offset, _| {
                    let centre = [from[0] + offset[0], from[1] + offset[1]];
                    free &= way.distance_to_point(centre) >= keep;
                });
                free
            })
    }
}
