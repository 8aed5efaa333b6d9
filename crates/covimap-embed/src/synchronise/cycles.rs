//! How far each edge can be believed, from the short cycles that it lies on.
//!
//! Along a cycle of right edges the orientations compose to the identity. What they compose to in
//! fact is the inconsistency `d` of the cycle: `|angle| / pi`, or 1 if it mirrors. The corruption
//! of an edge is the mean over its cycles, each weighted by how little corrupted its other edges
//! are:
//!
//! `s_e = (q s_0 + sum_c q_c d_c) / (q + sum_c q_c)`,
//! `q_c = min(1, min_f w_f / w_e) exp(-beta sum_f s_f)` over the edges `f != e` of `c`,
//!
//! iterated from plain means while `beta` grows. A right edge needs one right cycle to be cleared.
//! An edge without cycles, or with corrupted and weak ones only, is neither cleared nor convicted:
//! its corruption is `s_0`.
//!
//! # References
//! G. Lerman, Y. Shi, "Robust group synchronization via cycle-edge message passing", Found. Comput.
//! Math. 22, 2022.

use std::f64::consts::PI;

use super::orientation::{Orientation, Vote};

/// Most cycles looked at for one edge.
const MAX_CYCLES: usize = 12;
/// `beta` of each round.
const SHARPNESS: [f64; 6] = [1.0, 2.0, 4.0, 8.0, 16.0, 32.0];
/// `s_0`.
const UNKNOWN: f64 = 0.25;
/// `q`.
const DOUBT: f64 = 0.05;

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
        let of = |edge: usize| {
            let (mut sum, mut weights) = (DOUBT * UNKNOWN, DOUBT);
            for cycle in cycles.of(edge) {
                let others = || cycle.others[..cycle.length].iter().map(|&other| other as usize);
                let weakest =
                    others().fold(votes[edge].weight, |least, other| least.min(votes[other].weight));
                let corrupted: f64 = others().map(|other| corruption[other]).sum();
                let weight = weakest / votes[edge].weight * (-sharpness * corrupted).exp();
                sum += weight * cycle.inconsistency;
                weights += weight;
            }
            sum / weights
        };
        corruption = (0..votes.len()).map(of).collect();
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

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Complex;

    fn edge(a: u32, b: u32, angle: f64, mirrored: bool) -> Vote {
        let a_from_b = Orientation { rotation: Complex::from_polar(1.0, angle), mirrored };
        Vote { a, b, a_from_b, weight: 1.0 }
    }

    #[test]
    fn a_wrong_edge_is_convicted_and_its_neighbours_cleared() {
        // All nodes face one way, but for the edge 0-1 of five nodes that all see one another.
        for (angle, mirrored) in [(1.5, false), (0.0, true)] {
            let ends = (0..5).flat_map(|a| (a + 1..5).map(move |b| (a, b)));
            let mut votes: Vec<Vote> = ends.map(|(a, b)| edge(a, b, 0.0, false)).collect();
            votes[0] = edge(0, 1, angle, mirrored);
            let credible = credibility(5, &votes);
            assert!(credible[0] < 1e-6, "{}", credible[0]);
            assert!(credible[1..].iter().all(|&c| c > 0.9), "{credible:?}");
        }
    }

    #[test]
    fn cycles_of_two_three_and_four_edges_are_seen_and_longer_ones_not() {
        let unknown = (-32.0 * UNKNOWN).exp();
        for length in 2..6 {
            let ring = |mirrors: u32| -> Vec<Vote> {
                (0..length).map(|k| edge(k, (k + 1) % length, 0.0, k < mirrors)).collect()
            };
            // Two reflections cancel. One does not, and nothing tells which edge is wrong.
            let (right, wrong) =
                (credibility(length as usize, &ring(2)), credibility(length as usize, &ring(1)));
            assert!(right.iter().all(|&c| (c > 10.0 * unknown) == (length < 5)), "{length} {right:?}");
            assert!(wrong.iter().all(|&c| c > 0.5 * unknown && c < 2.0 * unknown), "{length} {wrong:?}");
        }
    }

    #[test]
    fn weak_edges_convict_nobody() {
        // The strong edge 0-1 against three paths of edges that say next to nothing.
        let mut votes = vec![edge(0, 1, 0.0, true)];
        for middle in 2..5 {
            votes.extend([edge(0, middle, 0.0, false), edge(middle, 1, 0.0, false)]);
        }
        votes[1..].iter_mut().for_each(|vote| vote.weight = 1e-6);
        assert!((credibility(5, &votes)[0].ln() + 32.0 * UNKNOWN).abs() < 0.01);
    }
}
