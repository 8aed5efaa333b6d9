//! The floor in patches, and which leads to which: the map that motions plan on.

use crate::error::SimError;
use crate::floor_plan::FloorPlan;
use crate::geometry::{Point, Rect, Segment};
use crate::grid::BoxGrid;

/// Longest side of a patch, metres: what is seen from a few places in it covers it. Corridors up to this width
/// are not cut lengthwise, so that their patches are a row and a patrol goes from end to end.
const PATCH: f64 = 1.7;

/// What an opening must be wider than twice the clearance, metres: equal lengths differ by rounding.
const ROUNDING: f64 = 1e-9;

/// How far behind an opening the robot aims, so that it really goes through, metres.
const BEHIND: f64 = 0.2;

/// A way from a patch to its neighbour.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Doorway {
    /// The neighbour.
    pub to: usize,
    /// The part of the opening that the robot's middle can pass.
    pub passage: Segment,
}

/// Patches of floor and the doorways between them.
pub(super) struct Patches {
    plan: FloorPlan,
    doorways: Vec<Vec<Doorway>>,
    by_place: BoxGrid<usize>,
}

impl Patches {
    /// Cuts the floor into patches. Openings not wider than twice the clearance lead nowhere.
    ///
    /// # Errors
    /// [`SimError::OutOfReach`] if some patches cannot be reached.
    pub(super) fn new(plan: &FloorPlan, clearance: f64) -> Result<Self, SimError> {
        let plan = plan.refined(PATCH);
        let mut doorways = vec![Vec::new(); plan.tiles().len()];
        for portal in plan.portals() {
            let width = portal.opening.length();
            if width > 2.0 * clearance + ROUNDING {
                let passage = Segment {
                    a: portal.opening.point_at(clearance),
                    b: portal.opening.point_at(width - clearance),
                };
                let [first, second] = portal.tiles;
                doorways[first].push(Doorway { to: second, passage });
                doorways[second].push(Doorway { to: first, passage });
            }
        }
        let boxes: Vec<(Rect, usize)> = plan.tiles().iter().copied().zip(0..).collect();
        let by_place = BoxGrid::new(plan.bounds(), PATCH, &boxes);
        let patches = Self { plan, doorways, by_place };
        let cut_off = patches.len() - patches.reachable();
        if cut_off > 0 {
            return Err(SimError::OutOfReach { cut_off, patches: patches.len(), clearance });
        }
        Ok(patches)
    }

    pub(super) fn len(&self) -> usize {
        self.doorways.len()
    }

    /// The floor of a patch.
    pub(super) fn tile(&self, patch: usize) -> Rect {
        self.plan.tiles()[patch]
    }

    /// The ways out of a patch.
    pub(super) fn doorways(&self, patch: usize) -> &[Doorway] {
        &self.doorways[patch]
    }

    /// The way from one patch to another, if they are neighbours.
    pub(super) fn doorway(&self, from: usize, to: usize) -> Option<Doorway> {
        self.doorways[from].iter().copied().find(|doorway| doorway.to == to)
    }

    /// The patch under a place of the floor.
    pub(super) fn at(&self, place: Point) -> usize {
        let under = self.by_place.near(place).iter().find(|&&patch| self.plan.tiles()[patch].contains(place));
        *under.expect("robots and goals stay on the floor (bug in covimap)")
    }

    /// A place to aim at when passing a doorway at the given point: a little behind it.
    pub(super) fn behind(&self, doorway: &Doorway, at: Point) -> Point {
        let axis = usize::from(doorway.passage.a[0] < doorway.passage.b[0]);
        let Rect { min, max } = self.tile(doorway.to);
        let mut aim = at;
        aim[axis] += BEHIND * ((min[axis] + max[axis]) / 2.0 - at[axis]).signum();
        aim
    }

    /// Number of patches that can be reached from the first.
    fn reachable(&self) -> usize {
        let mut reached = vec![false; self.len()];
        reached[0] = true;
        let mut open = vec![0];
        let mut count = 0;
        while let Some(patch) = open.pop() {
            count += 1;
            for doorway in &self.doorways[patch] {
                if !std::mem::replace(&mut reached[doorway.to], true) {
                    open.push(doorway.to);
                }
            }
        }
        count
    }
}
