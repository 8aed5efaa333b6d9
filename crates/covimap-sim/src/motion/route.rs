//! The way to a goal: straight within a tile, else through the fewest patches.

use std::collections::VecDeque;

use super::bearing;
use super::patches::{Doorway, Patches};
use crate::floor_plan::FloorPlan;
use crate::geometry::{Point, Rect};

/// Leads to one goal at a time.
pub(super) struct Route {
    tiles: Vec<Rect>,
    patches: Patches,
    goal: Point,
    /// A tile with the goal in it.
    goal_tile: Option<Rect>,
    /// For each patch that the present search reached, the doorway towards the goal.
    onward: Vec<Option<Doorway>>,
    /// The patches reached.
    reached: Vec<usize>,
}

impl Route {
    pub(super) fn new(plan: &FloorPlan, patches: Patches) -> Self {
        let onward = vec![None; patches.len()];
        Self {
            tiles: plan.tiles().to_vec(),
            patches,
            goal: [0.0; 2],
            goal_tile: None,
            onward,
            reached: Vec::new(),
        }
    }

    /// Sets the next goal, a place on the floor.
    pub(super) fn set_goal(&mut self, goal: Point) {
        self.goal = goal;
        self.goal_tile = self.tiles.iter().copied().find(|tile| tile.contains(goal));
        self.forget_search();
    }

    /// The goal, if one was set.
    pub(super) fn goal(&self) -> Option<Point> {
        self.goal_tile.map(|_| self.goal)
    }

    /// The direction to go in from a place on the floor.
    pub(super) fn direction(&mut self, from: Point) -> f64 {
        if self.goal_tile.is_some_and(|tile| tile.contains(from)) {
            return bearing(from, self.goal);
        }
        let here = self.patches.at(from);
        if self.onward[here].is_none() {
            self.search(here);
        }
        let Some(doorway) = self.onward[here] else { return bearing(from, self.goal) };
        bearing(from, self.patches.behind(&doorway, doorway.passage.nearest_to(from)))
    }

    fn forget_search(&mut self) {
        for patch in self.reached.drain(..) {
            self.onward[patch] = None;
        }
    }

    /// Breadth-first from the goal until the search comes to where the robot is.
    fn search(&mut self, here: usize) {
        self.forget_search();
        let mut queue = VecDeque::from([self.patches.at(self.goal)]);
        while let Some(patch) = queue.pop_front() {
            if patch == here {
                return;
            }
            for doorway in self.patches.doorways(patch) {
                if self.onward[doorway.to].is_none() {
                    self.onward[doorway.to] = Some(Doorway { to: patch, passage: doorway.passage });
                    self.reached.push(doorway.to);
                    queue.push_back(doorway.to);
                }
            }
        }
    }
}
