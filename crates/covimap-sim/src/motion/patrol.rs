//! Patrolling: always on to the neighbouring patch that was left longest ago.
//!
//! On any floor this local rule comes past everywhere again and again: along a corridor it goes from end to
//! end, in a tree it goes into every branch. In each patch the robot calls at a few random places before it
//! goes on, so that corners and dead ends are seen too.

use rand::RngExt;

use super::patches::{Doorway, Patches};
use super::{Pilot, Walker, bearing};
use crate::geometry::{Point, Pose};

/// Places to call at in a patch before going on.
const CALLS: u32 = 3;

/// Remembers when it was in which patch.
pub(super) struct Patrol {
    patches: Patches,
    /// For each patch the number of the last visit to it; 0 for none.
    last_visit: Vec<u64>,
    visits: u64,
    /// The patch that the robot is to be in.
    here: Option<usize>,
    errand: Errand,
}

/// What the robot is about.
#[derive(Clone, Copy)]
enum Errand {
    /// It goes to a place in its patch; so many more follow.
    Call { place: Point, more: u32 },
    /// It leaves its patch by a doorway, and aims at a point of it.
    Leave { doorway: Doorway, point: Point },
}

impl Patrol {
    pub(super) fn new(patches: Patches) -> Self {
        let last_visit = vec![0; patches.len()];
        let errand = Errand::Call { place: [0.0; 2], more: 0 };
        Self { patches, last_visit, visits: 0, here: None, errand }
    }

    /// Notes the visit.
    fn enter(&mut self, patch: usize, walker: &mut Walker<'_>) {
        self.visits += 1;
        self.last_visit[patch] = self.visits;
        self.here = Some(patch);
        self.errand = self.call(patch, CALLS - 1, walker);
    }

    fn call(&self, patch: usize, more: u32, walker: &mut Walker<'_>) -> Errand {
        let tile = self.patches.tile(patch);
        let place = [0, 1].map(|axis| walker.rng().random_range(tile.min[axis]..=tile.max[axis]));
        Errand::Call { place, more }
    }

    /// Chooses the doorway to the neighbour left longest ago; of those not visited yet a random one. On a
    /// floor of one patch there is none.
    fn leave(&self, patch: usize, walker: &mut Walker<'_>) -> Option<Errand> {
        let doorways = self.patches.doorways(patch);
        let first = walker.rng().random_range(0..doorways.len().max(1));
        let turns = (0..doorways.len()).map(|turn| doorways[(first + turn) % doorways.len()]);
        let doorway = turns.min_by_key(|doorway| self.last_visit[doorway.to])?;
        let share: f64 = walker.rng().random();
        Some(Errand::Leave { doorway, point: doorway.passage.point_at(share * doorway.passage.length()) })
    }

    /// Sees whether the robot has changed patches or arrived at a place, and what it is about next.
    fn plan(&mut self, at: Point, walker: &mut Walker<'_>) {
        let patch = self.patches.at(at);
        let is_near = |&here: &usize| here == patch || self.patches.doorway(patch, here).is_some();
        let Some(here) = self.here.filter(is_near) else { return self.enter(patch, walker) };
        match self.errand {
            Errand::Leave { doorway, .. } if doorway.to == patch => self.enter(patch, walker),
            Errand::Call { place, more } if walker.has_arrived(at, place) => {
                let leave = if more == 0 { self.leave(here, walker) } else { None };
                self.errand = leave.unwrap_or_else(|| self.call(here, more.saturating_sub(1), walker));
            }
            _ => {}
        }
    }

    /// Where to aim at. A robot that has strayed goes back first, or it would soon turn round for good: what
    /// lies ahead of a patch that it comes back to was visited last.
    fn aim(&self, at: Point) -> Point {
        let patch = self.patches.at(at);
        let back = self.here.filter(|&here| here != patch).and_then(|here| self.patches.doorway(patch, here));
        match (back, self.errand) {
            (Some(back), _) => self.patches.behind(&back, back.passage.nearest_to(at)),
            (None, Errand::Call { place, .. }) => place,
            (None, Errand::Leave { doorway, point }) => self.patches.behind(&doorway, point),
        }
    }
}

impl Pilot for Patrol {
    fn next(&mut self, from: Pose, walker: &mut Walker<'_>) -> Pose {
        self.plan(from.at, walker);
        walker.step(from, bearing(from.at, self.aim(from.at)))
    }
}
