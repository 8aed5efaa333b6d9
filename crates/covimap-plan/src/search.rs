//! Shortest paths by A*, on whatever can be walked over; and the traits by which other planners take part.
//!
//! A planner of somebody else can walk over our map: it asks a [`SearchGraph`] for the roads from a
//! landmark. And it can find ways for us: what implements [`RouteSearch`] is given a graph and two landmarks, and
//! [`crate::Roads::route_by`] makes a [`crate::Route`] of the landmarks it comes back with.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use covimap_map::LandmarkId;

/// A graph over landmarks that a search can walk over.
pub trait SearchGraph {
    /// One more than the highest number of a landmark.
    fn landmarks(&self) -> usize;

    /// The landmarks that can be reached from one by a single road, and what that costs: finite, `>= 0`.
    fn roads_from(&self, from: LandmarkId) -> impl Iterator<Item = (LandmarkId, f64)>;

    /// A cost that no way between the two falls below, for searches that are drawn to their goal: at most
    /// the cost of a road plus the bound from its end. 0 is always right.
    fn at_least(&self, from: LandmarkId, to: LandmarkId) -> f64;
}

/// A search for a cheapest way.
pub trait RouteSearch<G: SearchGraph> {
    /// The landmarks of a way, both ends included; none if there is no way.
    fn search(&self, graph: &G, from: LandmarkId, to: LandmarkId) -> Option<Vec<LandmarkId>>;
}

/// The A* search of Hart, Nilsson and Raphael (1968). Finds a cheapest way; of equally cheap ones always the
/// same.
///
/// `O((n + m) log n)` time at worst for `m` roads, and 12 bytes a landmark.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct AStar;

impl<G: SearchGraph> RouteSearch<G> for AStar {
    fn search(&self, graph: &G, from: LandmarkId, to: LandmarkId) -> Option<Vec<LandmarkId>> {
        let mut reached = Reached::new(graph.landmarks());
        let mut open = BinaryHeap::new();
        reached.improve(from, from, 0.0);
        open.push(Open { bound: graph.at_least(from, to), cost: 0.0, at: from });
        while let Some(Open { cost, at, .. }) = open.pop() {
            if at == to {
                return Some(reached.way(from, to));
            }
            if cost > reached.costs[at.index()] {
                // Reached for less since.
                continue;
            }
            for (next, step) in graph.roads_from(at) {
                let cost = cost + step;
                if reached.improve(next, at, cost) {
                    open.push(Open { bound: cost + graph.at_least(next, to), cost, at: next });
                }
            }
        }
        None
    }
}

/// The landmarks reached so far.
struct Reached {
    /// Number of the landmark before, plus 1; 0 for a landmark that is not reached. Zeros come from the system for
    /// nothing, so that a short way in a large map does not pay for the whole map.
    before: Vec<u32>,
    costs: Vec<f64>,
}

impl Reached {
    fn new(landmarks: usize) -> Self {
        Self { before: vec![0; landmarks], costs: vec![0.0; landmarks] }
    }

    /// Notes a cost, if it is the first or the least.
    fn improve(&mut self, at: LandmarkId, before: LandmarkId, cost: f64) -> bool {
        let better = self.before[at.index()] == 0 || cost < self.costs[at.index()];
        if better {
            self.before[at.index()] = before.0 + 1;
            self.costs[at.index()] = cost;
        }
        better
    }

    fn way(&self, from: LandmarkId, to: LandmarkId) -> Vec<LandmarkId> {
        let mut way = vec![to];
        let mut at = to;
        while at != from {
            at = LandmarkId(self.before[at.index()] - 1);
            way.push(at);
        }
        way.reverse();
        way
    }
}

/// A landmark that is to be looked at.
struct Open {
    /// A way over it costs no less.
    bound: f64,
    cost: f64,
    at: LandmarkId,
}

impl Ord for Open {
    /// The least bound is the greatest entry; then the one that is further on its way, then the lower number.
    fn cmp(&self, other: &Self) -> Ordering {
        let least = other.bound.total_cmp(&self.bound);
        least.then(self.cost.total_cmp(&other.cost)).then(other.at.cmp(&self.at))
    }
}

impl PartialOrd for Open {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Open {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Open {}

#[cfg(test)]
mod tests;
