//! A robot's body: one step in about the wanted direction, round whatever is in the way.

use std::f64::consts::{FRAC_PI_4, FRAC_PI_8, PI};

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use crate::error::SimError;
use crate::geometry::{Point, Pose, Segment};
use crate::grid::{BoxGrid, PointGrid, wall_grid};
use crate::landmarks::FreeSpace;
use crate::spec::StepSpec;
use crate::world::World;

/// Directions to try when the way is blocked, as if from eight proximity sensors around the body: multiples
/// of 45 degrees, small ones first, both sides.
const TURNS: [f64; 7] = [1.0, -1.0, 2.0, -2.0, 3.0, -3.0, 4.0];

/// Draws for a free place before the world counts as full.
const MOST_DRAWS: usize = 10_000;

/// Takes steps that keep clear of walls and of solid landmarks.
pub(crate) struct Walker<'w> {
    space: FreeSpace<'w>,
    walls: BoxGrid<Segment>,
    /// Middles of solid landmarks.
    solids: Option<PointGrid>,
    /// Least distance from the middle of a solid landmark.
    keep_off: f64,
    step: StepSpec,
    rng: ChaCha8Rng,
}

impl<'w> Walker<'w> {
    pub(crate) fn new(world: &'w World, step: StepSpec, rng: ChaCha8Rng) -> Result<Self, SimError> {
        let bounds = world.plan().bounds();
        let keep_off = step.clearance + world.diameter() / 2.0;
        let mut walker = Self {
            space: FreeSpace::new(world.plan()),
            walls: wall_grid(world.plan().walls(), bounds, step.longest + step.clearance),
            solids: (world.diameter() > 0.0)
                .then(|| PointGrid::new(world.landmarks(), bounds, step.longest + keep_off)),
            keep_off,
            step,
            rng: rng.clone(),
        };
        let free = (0..MOST_DRAWS).any(|_| walker.draw_free().is_some());
        walker.rng = rng;
        if free { Ok(walker) } else { Err(SimError::NoFreePlace { clearance: step.clearance }) }
    }

    /// The walk's random numbers, for motions that choose at random.
    pub(super) fn rng(&mut self) -> &mut ChaCha8Rng {
        &mut self.rng
    }

    /// Whether the goal is as near as a step, or as an obstacle on it or a corner around it may keep the robot.
    pub(super) fn has_arrived(&self, at: Point, goal: Point) -> bool {
        (goal[0] - at[0]).hypot(goal[1] - at[1]) < self.step.longest.max(2.0 * self.keep_off)
    }

    /// A random free place.
    pub(super) fn place(&mut self) -> Point {
        // The constructor has seen that there are free places.
        loop {
            if let Some(at) = self.draw_free() {
                return at;
            }
        }
    }

    /// A random free place and direction.
    pub(crate) fn start(&mut self) -> Pose {
        Pose { at: self.place(), heading: self.rng.random_range(0.0..2.0 * PI) }
    }

    /// One step: the direction is uniform within the turn limit of the wanted one, the length uniform.
    ///
    /// If that way is blocked the robot turns by the least multiple of 45 degrees that frees it, give or take
    /// 22.5 degrees, to a random side first. If no direction is free it stays and turns round.
    pub(crate) fn step(&mut self, from: Pose, wanted: f64) -> Pose {
        let mut uniform = |low: f64, high: f64| low + (high - low) * self.rng.random::<f64>();
        let heading = wanted + uniform(-self.step.turn.rad(), self.step.turn.rad());
        let length = uniform(self.step.shortest, self.step.longest);
        let jitter = uniform(-FRAC_PI_8, FRAC_PI_8);
        let side = if self.rng.random::<bool>() { FRAC_PI_4 } else { -FRAC_PI_4 };
        let headings = std::iter::once(heading).chain(TURNS.map(|turn| heading + jitter + turn * side));
        for heading in headings {
            let at = [from.at[0] + length * heading.cos(), from.at[1] + length * heading.sin()];
            if self.is_free(from.at, at) {
                return Pose { at, heading: heading.rem_euclid(2.0 * PI) };
            }
        }
        Pose { at: from.at, heading: (heading + PI).rem_euclid(2.0 * PI) }
    }

    fn draw_free(&mut self) -> Option<Point> {
        let at = self.space.draw(&mut self.rng);
        self.is_free(at, at).then_some(at)
    }

    /// Whether the straight way between the two places keeps clear of everything.
    pub(crate) fn is_free(&self, from: Point, to: Point) -> bool {
        let way = Segment { a: from, b: to };
        if self.walls.near(from).iter().any(|wall| wall.distance_to(&way) <= self.step.clearance) {
            return false;
        }
        let mut free = true;
        if let Some(solids) = &self.solids {
            solids.for_each_within(from, self.step.longest + self.keep_off, |found| {
                let middle = [from[0] + found.offset[0], from[1] + found.offset[1]];
                free &= way.distance_to_point(middle) > self.keep_off;
            });
        }
        free
    }
}
