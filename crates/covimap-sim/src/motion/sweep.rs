//! Boustrophedon sweep: to and fro in parallel lanes, as the ox ploughs, tile by tile.

use super::route::Route;
use super::{Pilot, Walker};
use crate::floor_plan::FloorPlan;
use crate::geometry::{Point, Pose, Rect};

/// On its way along the lanes; after the last one it starts again.
pub(super) struct Sweep {
    route: Route,
    goals: Vec<Point>,
    next: usize,
}

impl Sweep {
    pub(super) fn new(route: Route, goals: Vec<Point>) -> Self {
        Self { route, goals, next: 0 }
    }
}

impl Pilot for Sweep {
    fn next(&mut self, from: Pose, walker: &mut Walker<'_>) -> Pose {
        if self.route.goal().is_none_or(|goal| walker.has_arrived(from.at, goal)) {
            self.route.set_goal(self.goals[self.next]);
            self.next = (self.next + 1) % self.goals.len();
        }
        walker.step(from, self.route.direction(from.at))
    }
}

/// The ends of all lanes in the order of the sweep; from tile to tile it goes depth first.
pub(super) fn goals(plan: &FloorPlan, lane: f64) -> Vec<Point> {
    let mut neighbours = vec![Vec::new(); plan.tiles().len()];
    for portal in plan.portals() {
        let [first, second] = portal.tiles;
        neighbours[first].push(second);
        neighbours[second].push(first);
    }
    let mut goals = Vec::new();
    let mut swept = vec![false; plan.tiles().len()];
    let mut open = vec![0];
    while let Some(tile) = open.pop() {
        if !std::mem::replace(&mut swept[tile], true) {
            goals.extend(lane_ends(plan.tiles()[tile], lane));
            open.extend(neighbours[tile].iter().rev().filter(|&&next| !swept[next]));
        }
    }
    goals
}

/// The ends of the lanes in one tile: along its longer side, at most `lane` apart, half a lane from the walls.
fn lane_ends(tile: Rect, lane: f64) -> Vec<Point> {
    let size = [0, 1].map(|axis| tile.max[axis] - tile.min[axis]);
    let along = usize::from(size[1] > size[0]);
    let across = 1 - along;
    let count = (size[across] / lane).ceil().max(1.0) as usize;
    let inset = (lane / 2.0).min(size[along] / 2.0);
    let ends = [tile.min[along] + inset, tile.max[along] - inset];
    let point = |index: usize, end: f64| {
        let mut point = tile.min;
        point[along] = end;
        point[across] += (index as f64 + 0.5) * size[across] / count as f64;
        point
    };
    (0..count)
        .flat_map(|index| {
            let [first, second] = if index % 2 == 0 { ends } else { [ends[1], ends[0]] };
            [point(index, first), point(index, second)]
        })
        .collect()
}
