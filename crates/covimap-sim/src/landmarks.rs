//! Places for landmarks: at random over the free space, denser to one side if wanted, apart from each other.

use std::collections::HashMap;

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use crate::error::SimError;
use crate::floor_plan::FloorPlan;
use crate::geometry::{Point, Rect, Segment};
use crate::grid::{BoxGrid, wall_grid};
use crate::spec::WorldSpec;

/// Draws for one landmark before the floor counts as full.
const MOST_DRAWS: usize = 10_000;

/// Draws places that are uniform over the area of a floor.
pub(crate) struct FreeSpace<'p> {
    plan: &'p FloorPlan,
    /// Area of all tiles up to and with each.
    reached: Vec<f64>,
}

impl<'p> FreeSpace<'p> {
    pub(crate) fn new(plan: &'p FloorPlan) -> Self {
        let running = |sum: &mut f64, tile: &Rect| {
            *sum += tile.area();
            Some(*sum)
        };
        Self { plan, reached: plan.tiles().iter().scan(0.0, running).collect() }
    }

    pub(crate) fn draw(&self, rng: &mut ChaCha8Rng) -> Point {
        let last = self.reached.len() - 1;
        let target = rng.random::<f64>() * self.reached[last];
        let tile = self.reached.partition_point(|&area| area <= target).min(last);
        let rect = self.plan.tiles()[tile];
        [0, 1].map(|axis| rect.min[axis] + rng.random::<f64>() * (rect.max[axis] - rect.min[axis]))
    }
}

/// Places all landmarks one after another, each where it keeps its gap to walls and to those before it.
///
/// Expected time `O(n)` as long as the floor is not nearly full.
pub(crate) fn place(
    spec: &WorldSpec,
    plan: &FloorPlan,
    rng: &mut ChaCha8Rng,
) -> Result<Vec<Point>, SimError> {
    let space = FreeSpace::new(plan);
    let bounds = plan.bounds();
    let mut gaps = Gaps::new(spec, plan, bounds);
    let mut places = Vec::with_capacity(spec.landmarks);
    while places.len() < spec.landmarks {
        let fits = |rng: &mut ChaCha8Rng| {
            let at = space.draw(rng);
            (rng.random::<f64>() < relative_density(spec.contrast, bounds, at) && gaps.are_kept(at, &places))
                .then_some(at)
        };
        let found = std::iter::repeat_with(|| fits(rng)).take(MOST_DRAWS).find_map(|at| at);
        let at = found.ok_or(SimError::Crowded {
            placed: places.len(),
            wanted: spec.landmarks,
            gap: spec.min_gap,
        })?;
        gaps.take(at, places.len());
        places.push(at);
    }
    Ok(places)
}

/// Density at a place over the greatest density: `contrast^(s - 1)` or, for a contrast below 1, `contrast^s`,
/// where `s` goes from 0 at the left end to 1 at the right.
fn relative_density(contrast: f64, bounds: Rect, at: Point) -> f64 {
    let share = (at[0] - bounds.min[0]) / (bounds.max[0] - bounds.min[0]);
    contrast.powf(share) / contrast.max(1.0)
}

/// Sees to the least gap between landmarks, and to walls.
struct Gaps {
    /// Least distance of a middle from a wall.
    from_wall: f64,
    walls: Option<BoxGrid<Segment>>,
    /// Least distance of two middles; squares of this side hold few of them.
    apart: f64,
    by_square: HashMap<[i64; 2], Vec<usize>>,
}

impl Gaps {
    fn new(spec: &WorldSpec, plan: &FloorPlan, bounds: Rect) -> Self {
        let from_wall = spec.min_gap + spec.diameter / 2.0;
        Self {
            from_wall,
            walls: (from_wall > 0.0).then(|| wall_grid(plan.walls(), bounds, from_wall)),
            apart: spec.min_gap + spec.diameter,
            by_square: HashMap::new(),
        }
    }

    fn square(&self, at: Point) -> [i64; 2] {
        at.map(|coordinate| (coordinate / self.apart).floor() as i64)
    }

    fn are_kept(&self, at: Point, places: &[Point]) -> bool {
        let Some(walls) = &self.walls else { return true };
        if walls.near(at).iter().any(|wall| wall.distance_to_point(at) < self.from_wall) {
            return false;
        }
        let [column, row] = self.square(at);
        let around = (-1..=1).flat_map(|dx| (-1..=1).map(move |dy| [column + dx, row + dy]));
        around.filter_map(|square| self.by_square.get(&square)).flatten().all(|&other| {
            let other = places[other];
            (at[0] - other[0]).hypot(at[1] - other[1]) >= self.apart
        })
    }

    fn take(&mut self, at: Point, number: usize) {
        if self.walls.is_some() {
            self.by_square.entry(self.square(at)).or_default().push(number);
        }
    }
}
