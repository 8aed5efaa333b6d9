//! First orientations, which must be right nearly everywhere: no later step changes handedness.
//!
//! # Algorithm
//! 1. Nodes are merged by votes that count as far as short cycles bear them out, so that early
//!    merges, which rest on single edges, follow right ones.
//! 2. Node by node, a node follows the votes of its neighbours where these agree better.
//! 3. Edges that agree with the outcome hold fragments together, each edge on a cycle of such
//!    edges: a branch that hangs on one wrong edge is a fragment of its own. The fragments are
//!    merged anew, now by the plain votes of all edges between them.
//!
//! Steps 2 and 3 are repeated while the agreement of the edges grows.

use super::bridges::bridges;
use super::cycles::credibility;
use super::merging::{Tally, merged};
use super::orientation::{Orientation, Vote};
use crate::laplacian::components;

/// Most repetitions; two or three are the rule.
const MAX_ROUNDS: usize = 20;
/// An edge agrees if the cosine of the angle that it is off is at least this.
const AGREES: f64 = 0.9;

/// The orientations of `n` nodes, seen from node 0, in a graph of votes that is connected.
///
/// Votes of the right handedness connect the graph as well.
pub(super) fn settle(n: usize, votes: &[Vote]) -> Vec<Orientation> {
    let credible = votes.iter().zip(credibility(n, votes));
    let mut best =
        merged(n, credible.map(|(vote, credible)| Vote { weight: vote.weight * credible, ..*vote }));
    for _ in 0..MAX_ROUNDS {
        let next = merged_fragments(votes, &revised(votes, best.clone()));
        if agreement(votes, &next) <= agreement(votes, &best) {
            break;
        }
        best = next;
    }
    let first_from_root = best.first().map_or(Orientation::IDENTITY, |first| first.inverse());
    best.iter().map(|&node| first_from_root.after(node)).collect()
}

/// Step 2.
fn revised(votes: &[Vote], mut nodes: Vec<Orientation>) -> Vec<Orientation> {
    let mut incident = vec![Vec::new(); nodes.len()];
    for vote in votes {
        incident[vote.a as usize].push(Vote {
            a: vote.b,
            b: vote.a,
            a_from_b: vote.a_from_b.inverse(),
            ..*vote
        });
        incident[vote.b as usize].push(*vote);
    }
    for (node, votes) in incident.iter().enumerate() {
        let mut tally = Tally::default();
        for vote in votes {
            let a_from_b = nodes[vote.a as usize].after(vote.a_from_b);
            tally.add(Tally::of(&Vote { a_from_b, ..*vote }));
        }
        let before = nodes[node];
        let agreed = agreement(votes, &nodes);
        nodes[node] = tally.winner();
        if agreement(votes, &nodes) <= agreed {
            nodes[node] = before;
        }
    }
    nodes
}

/// Step 3.
fn merged_fragments(votes: &[Vote], nodes: &[Orientation]) -> Vec<Orientation> {
    let (fragment, count) = fragments(votes, nodes);
    let between = votes.iter().filter(|vote| fragment[vote.a as usize] != fragment[vote.b as usize]);
    let corrections = merged(
        count,
        between.map(|vote| Vote {
            a: fragment[vote.a as usize],
            b: fragment[vote.b as usize],
            a_from_b: vote.left_over(nodes),
            weight: vote.weight,
        }),
    );
    nodes.iter().zip(&fragment).map(|(node, &own)| corrections[own as usize].after(*node)).collect()
}

/// Fragment of each node, and the number of fragments.
fn fragments(votes: &[Vote], nodes: &[Orientation]) -> (Vec<u32>, usize) {
    let agrees = |vote: &&Vote| {
        let left = vote.left_over(nodes);
        !left.mirrored && left.rotation.re >= AGREES
    };
    let ends: Vec<(u32, u32)> = votes.iter().filter(agrees).map(|vote| (vote.a, vote.b)).collect();
    let bridge = bridges(nodes.len(), &ends);
    let on_cycles = ends.iter().zip(bridge).filter(|&(_, bridge)| !bridge).map(|(&end, _)| end);
    let (fragment, sizes) = components(nodes.len(), on_cycles);
    (fragment, sizes.len())
}

/// Sum of the weights of the votes of the right handedness, times the cosine of the angle that
/// they are off, as far as it is positive.
fn agreement(votes: &[Vote], nodes: &[Orientation]) -> f64 {
    let gain = |vote: &Vote| {
        let left = vote.left_over(nodes);
        if left.mirrored { 0.0 } else { vote.weight * left.rotation.re.max(0.0) }
    };
    votes.iter().map(gain).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::synchronise::orientation::fixtures::{close, turned};

    #[test]
    fn agreeing_edges_outvote_a_heavier_wrong_one() {
        // Nodes 0, 1, 2 all face one another; only the heaviest edge, 0-3, says that 3 is
        // mirrored, against 1-3 and 2-3. A maximum spanning tree would believe it.
        let edge = |a, b, mirrored, weight| Vote { a, b, a_from_b: turned(0.0, mirrored), weight };
        let votes = [
            edge(0, 1, false, 2.0),
            edge(0, 2, false, 2.0),
            edge(1, 2, false, 2.0),
            edge(0, 3, true, 1.2),
            edge(1, 3, false, 1.0),
            edge(2, 3, false, 1.0),
        ];
        assert!(settle(4, &votes).iter().all(|&node| close(node, Orientation::IDENTITY)));
    }

    #[test]
    fn a_branch_that_hangs_on_a_wrong_edge_is_turned_as_a_whole() {
        // Two squares with diagonals, in one frame but for node orientations that a wrong edge,
        // 0-4, has turned; 1-5, 2-6 and 3-7 know better. No cycle of the wrong start shows it.
        let mut votes = Vec::new();
        for base in [0, 4] {
            for a in 0..4 {
                for b in a + 1..4 {
                    votes.push(Vote {
                        a: base + a,
                        b: base + b,
                        a_from_b: Orientation::IDENTITY,
                        weight: 1.0,
                    });
                }
            }
        }
        let bond = |k, a_from_b| Vote { a: k, b: k + 4, a_from_b, weight: 1.0 };
        votes.push(bond(0, turned(2.0, true)));
        votes.extend((1..4).map(|k| bond(k, Orientation::IDENTITY)));
        let mut start = vec![Orientation::IDENTITY; 8];
        start[4..].fill(turned(2.0, true));
        let mended = merged_fragments(&votes, &start);
        assert!(mended.iter().all(|&node| close(mended[0].inverse().after(node), Orientation::IDENTITY)));
        assert!((agreement(&votes, &start) - 13.0).abs() < 1e-12);
        assert!((agreement(&votes, &mended) - 15.0).abs() < 1e-12);
    }

    #[test]
    fn orientations_are_seen_from_the_first_node() {
        let votes = [
            Vote { a: 1, b: 0, a_from_b: turned(0.5, true), weight: 1.0 },
            Vote { a: 2, b: 1, a_from_b: turned(0.2, false), weight: 3.0 },
        ];
        let found = settle(3, &votes);
        assert!(close(found[0], Orientation::IDENTITY));
        assert!(close(found[1], turned(0.5, true)));
        assert!(close(found[2], turned(0.5, true).after(turned(-0.2, false))));
    }

    #[test]
    fn no_node_and_one_node() {
        assert!(settle(0, &[]).is_empty());
        assert!(close(settle(1, &[])[0], Orientation::IDENTITY));
    }
}
