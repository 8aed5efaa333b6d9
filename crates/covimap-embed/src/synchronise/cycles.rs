//! How far each edge can be believed, from the short cycles that it lies on.
//!
//! Along a cycle of right edges the orientations compose to the identity. What they compose to in
//! fact is the inconsistency `d` of the cycle: `|angle| / pi`, or 1 if it mirrors. The corruption
//! of an edge is the mean over its cycles, each weighted by how little corrupted its other edges
//! are:
//!
//! `s_e = sum_c exp(-beta sum_(f in c, f != e) s_f) d_c / sum_c exp(-beta sum_(f in c, f != e) s_f)`
//!
//! iterated from plain means while `beta` grows. A right edge needs one right cycle to be cleared.
//!
//! # References
//! G. Lerman, Y. Shi, "Robust group synchronization via cycle-edge message passing", Found. Comput.
//! Math. 22, 2022.

use std::f64::consts::PI;

use super::voting::{Orientation, Vote};

/// Most cycles looked at for one edge.
const MAX_CYCLES: usize = 12;
/// `beta` of each round.
const SHARPNESS: [f64; 6] = [1.0, 2.0, 4.0, 8.0, 16.0, 32.0];
/// Corruption of an edge that lies on no short cycle: neither cleared nor convicted.
const UNKNOWN: f64 = 0.25;

/// A cycle through some edge: its other two or three edges and what it composes to.
struct Cycle {
    others: [u32; 3],
    length: usize,
    inconsistency: f64,
}

/// `exp(-beta s)` of every edge, `beta` at its largest.
pub(super) fn credibility(nodes: usize, votes: &[Vote]) -> Vec<f64> {
    let cycles = Cycles::new(nodes, votes);
    let mut corruption = vec![0.0; votes.len()];
    for sharpness in std::iter::once(0.0).chain(SHARPNESS) {
        corruption = (0..votes.len())
            .map(|edge| {
                let (mut sum, mut weights) = (0.0, 0.0);
                for cycle in cycles.of(edge) {
                    let others: f64 =
                        cycle.others[..cycle.length].iter().map(|&f| corruption[f as usize]).sum();
                    let weight = (-sharpness * others).exp();
                    sum += weight * cycle.inconsistency;
                    weights += weight;
                }
                if weights > 0.0 { sum / weights } else { UNKNOWN }
            })
            .collect();
    }
    let sharpest = SHARPNESS[SHARPNESS.len() - 1];
    corruption.into_iter().map(|s| (-sharpest * s).exp()).collect()
}

/// The short cycles of all edges.
struct Cycles {
    starts: Vec<usize>,
    cycles: Vec<Cycle>,
}

impl Cycles {
    fn new(nodes: usize, votes: &[Vote]) -> Self {
        let steps = Steps::new(nodes, votes);
        let mut cycles = Vec::new();
        let mut starts = vec![0];
        for (edge, vote) in votes.iter().enumerate() {
            steps.cycles_of(edge as u32, vote, &mut cycles);
            starts.push(cycles.len());
        }
        Self { starts, cycles }
    }

    fn of(&self, edge: usize) -> &[Cycle] {
        &self.cycles[self.starts[edge]..self.starts[edge + 1]]
    }
}

/// One step along an edge.
#[derive(Clone, Copy)]
struct Step {
    to: u32,
    edge: u32,
    /// Orientation of the node reached, seen from the node left.
    turn: Orientation,
}

/// The steps from each node, by the node they reach.
struct Steps {
    from: Vec<Vec<Step>>,
}

impl Steps {
    fn new(nodes: usize, votes: &[Vote]) -> Self {
        let mut from = vec![Vec::new(); nodes];
        for (edge, vote) in votes.iter().enumerate() {
            let edge = edge as u32;
            from[vote.a as usize].push(Step { to: vote.b, edge, turn: vote.a_from_b });
            from[vote.b as usize].push(Step { to: vote.a, edge, turn: vote.a_from_b.inverse() });
        }
        from.iter_mut().for_each(|steps| steps.sort_unstable_by_key(|step| (step.to, step.edge)));
        Self { from }
    }

    fn between(&self, from: u32, to: u32) -> &[Step] {
        let steps = &self.from[from as usize];
        let start = steps.partition_point(|step| step.to < to);
        let count = steps[start..].partition_point(|step| step.to == to);
        &steps[start..start + count]
    }

    /// Appends the cycles of two, three and, if there are too few, four edges through `edge`.
    fn cycles_of(&self, edge: u32, vote: &Vote, cycles: &mut Vec<Cycle>) {
        let limit = cycles.len() + MAX_CYCLES;
        let back = vote.a_from_b.inverse();
        let mut close = |path: Orientation, others: &[u32]| {
            let left = back.after(path);
            let inconsistency = if left.mirrored { 1.0 } else { left.rotation.arg().abs() / PI };
            let mut padded = [0; 3];
            padded[..others.len()].copy_from_slice(others);
            cycles.push(Cycle { others: padded, length: others.len(), inconsistency });
            cycles.len() == limit
        };
        for step in self.between(vote.a, vote.b).iter().filter(|step| step.edge != edge) {
            if close(step.turn, &[step.edge]) {
                return;
            }
        }
        let out = || self.from[vote.a as usize].iter().filter(|step| step.to != vote.b);
        for first in out() {
            for last in self.between(first.to, vote.b) {
                if close(first.turn.after(last.turn), &[first.edge, last.edge]) {
                    return;
                }
            }
        }
        for first in out() {
            let onward = self.from[first.to as usize].iter();
            for second in onward.filter(|step| step.to != vote.a && step.to != vote.b) {
                for last in self.between(second.to, vote.b) {
                    let path = first.turn.after(second.turn).after(last.turn);
                    if close(path, &[first.edge, second.edge, last.edge]) {
                        return;
                    }
                }
            }
        }
    }
}
