//! First orientations, by merging the nodes that their edges agree on most.
//!
//! Every node starts as a cluster. Between two clusters all edges vote for the orientation of one
//! seen from the other: a vote is a complex number, its angle the rotation and its size the
//! weight, and mirrored and unmirrored votes are added up apart. The pair of clusters with the
//! largest
//!
//! `max(|z_plain|, |z_mirrored|)^2 / sum of weights`
//!
//! is merged as the larger sum says, and its votes about third clusters are added up in the common
//! frame. Votes that contradict each other cancel, so that doubtful merges wait until more edges
//! speak. Without the adding up this would be a maximum spanning tree, which a single wrong edge
//! turns in a whole branch.
//!
//! `O(m log^2 n)` for `m` edges: the cluster with fewer neighbours joins the other.

use std::cmp::{Ordering, Reverse};
use std::collections::{BTreeMap, BinaryHeap};

use nalgebra::Complex;

use super::bridges::bridges;
use super::cycles::credibility;
use crate::laplacian::components;

const MAX_ROUNDS: usize = 20;
const AGREES: f64 = 0.9;

/// A rotation of the plane, or a rotation after mirroring the y axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Orientation {
    /// Unit complex number.
    pub(super) rotation: Complex<f64>,
    pub(super) mirrored: bool,
}

impl Orientation {
    pub(super) const IDENTITY: Self = Self { rotation: Complex::ONE, mirrored: false };

    /// First `first`, then `self`.
    pub(super) fn after(self, first: Self) -> Self {
        let turn = if self.mirrored { first.rotation.conj() } else { first.rotation };
        Self { rotation: self.rotation * turn, mirrored: self.mirrored != first.mirrored }
    }

    pub(super) fn inverse(self) -> Self {
        if self.mirrored { self } else { Self { rotation: self.rotation.conj(), ..self } }
    }
}

/// `a_from_b` with a weight `> 0`.
#[derive(Clone, Copy)]
pub(super) struct Vote {
    pub(super) a: u32,
    pub(super) b: u32,
    pub(super) a_from_b: Orientation,
    pub(super) weight: f64,
}

impl Vote {
    /// What separates the orientations of the two nodes from the vote: the identity if they agree.
    fn left_over(&self, nodes: &[Orientation]) -> Orientation {
        nodes[self.a as usize].after(self.a_from_b).after(nodes[self.b as usize].inverse())
    }
}

/// The orientations of `n` nodes, seen from node 0, in a graph of votes that is connected.
pub(super) fn settle(n: usize, votes: &[Vote]) -> Vec<Orientation> {
    let credible = votes.iter().zip(credibility(n, votes));
    let mut best =
        merged(n, credible.map(|(vote, credible)| Vote { weight: vote.weight * credible, ..*vote }));
    let mut best_agreement = agreement(votes, &best);
    for _ in 0..MAX_ROUNDS {
        let (fragment, count) = fragments(votes, &best);
        let between = votes.iter().filter(|vote| fragment[vote.a as usize] != fragment[vote.b as usize]);
        let corrections = merged(
            count,
            between.map(|vote| Vote {
                a: fragment[vote.a as usize],
                b: fragment[vote.b as usize],
                a_from_b: vote.left_over(&best),
                weight: vote.weight,
            }),
        );
        let next: Vec<_> =
            best.iter().zip(&fragment).map(|(node, &f)| corrections[f as usize].after(*node)).collect();
        let next_agreement = agreement(votes, &next);
        if next_agreement <= best_agreement {
            break;
        }
        (best, best_agreement) = (next, next_agreement);
    }
    let first_from_root = best.first().map_or(Orientation::IDENTITY, |first| first.inverse());
    best.iter().map(|&node| first_from_root.after(node)).collect()
}

/// Sum of the weights of the votes that agree with the orientations, less for larger angles.
fn agreement(votes: &[Vote], nodes: &[Orientation]) -> f64 {
    votes
        .iter()
        .map(|vote| {
            let left = vote.left_over(nodes);
            if left.mirrored { 0.0 } else { vote.weight * left.rotation.re.max(0.0) }
        })
        .sum()
}

fn fragments(votes: &[Vote], nodes: &[Orientation]) -> (Vec<u32>, usize) {
    let agrees = |vote: &&Vote| {
        let left = vote.left_over(nodes);
        !left.mirrored && left.rotation.re >= AGREES
    };
    let ends: Vec<(u32, u32)> = votes.iter().filter(agrees).map(|vote| (vote.a, vote.b)).collect();
    let bridge = bridges(nodes.len(), &ends);
    let solid = ends.iter().zip(bridge).filter(|&(_, bridge)| !bridge).map(|(&end, _)| end);
    let (fragment, sizes) = components(nodes.len(), solid);
    (fragment, sizes.len())
}

fn merged(n: usize, votes: impl Iterator<Item = Vote>) -> Vec<Orientation> {
    let mut clusters = Clusters::new(n, votes);
    let mut merges = Vec::with_capacity(n.saturating_sub(1));
    while let Some(merge) = clusters.best_merge() {
        clusters.apply(&merge);
        merges.push(merge);
    }
    let mut root_from_node = vec![Orientation::IDENTITY; n];
    for Merge { into, from, into_from } in merges.iter().rev() {
        root_from_node[*from as usize] = root_from_node[*into as usize].after(*into_from);
    }
    root_from_node
}

/// The votes for the orientation of one cluster seen from another.
#[derive(Clone, Copy, Default)]
struct Tally {
    plain: Complex<f64>,
    mirrored: Complex<f64>,
    weight: f64,
}

impl Tally {
    fn add(&mut self, other: Self) {
        self.plain += other.plain;
        self.mirrored += other.mirrored;
        self.weight += other.weight;
    }

    fn of(vote: &Vote) -> Self {
        let z = vote.a_from_b.rotation * vote.weight;
        let none = Complex::ZERO;
        let (plain, mirrored) = if vote.a_from_b.mirrored { (none, z) } else { (z, none) };
        Self { plain, mirrored, weight: vote.weight }
    }

    /// The same votes with the roles of the clusters exchanged.
    fn reversed(self) -> Self {
        Self { plain: self.plain.conj(), ..self }
    }

    /// The votes of `turn` after what was voted for.
    fn turned(self, turn: Orientation) -> Self {
        let Self { plain, mirrored, weight } = self;
        if turn.mirrored {
            Self { plain: turn.rotation * mirrored.conj(), mirrored: turn.rotation * plain.conj(), weight }
        } else {
            Self { plain: turn.rotation * plain, mirrored: turn.rotation * mirrored, weight }
        }
    }

    fn score(&self) -> f64 {
        self.plain.norm_sqr().max(self.mirrored.norm_sqr()) / self.weight
    }

    fn winner(&self) -> Orientation {
        let mirrored = self.mirrored.norm_sqr() > self.plain.norm_sqr();
        let sum = if mirrored { self.mirrored } else { self.plain };
        // Votes that cancel exactly leave any rotation as good as any other.
        let rotation = if sum == Complex::ZERO { Complex::ONE } else { sum / sum.norm() };
        Orientation { rotation, mirrored }
    }
}

/// Cluster `from` joins cluster `into`.
struct Merge {
    into: u32,
    from: u32,
    into_from: Orientation,
}

/// A possible merge; the greatest has the highest score, then the smallest clusters.
#[derive(PartialEq)]
struct Candidate {
    score: f64,
    pair: Reverse<(u32, u32)>,
}

impl Eq for Candidate {}

impl PartialOrd for Candidate {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Candidate {
    fn cmp(&self, other: &Self) -> Ordering {
        self.score.total_cmp(&other.score).then(self.pair.cmp(&other.pair))
    }
}

struct Clusters {
    /// `neighbours[a][b]`: the votes on b seen from a. Both directions are kept; a cluster that
    /// has joined another has none.
    neighbours: Vec<BTreeMap<u32, Tally>>,
    queue: BinaryHeap<Candidate>,
}

impl Clusters {
    fn new(n: usize, votes: impl Iterator<Item = Vote>) -> Self {
        let mut neighbours = vec![BTreeMap::<u32, Tally>::new(); n];
        for vote in votes {
            let tally = Tally::of(&vote);
            neighbours[vote.a as usize].entry(vote.b).or_default().add(tally);
            neighbours[vote.b as usize].entry(vote.a).or_default().add(tally.reversed());
        }
        let mut clusters = Self { neighbours, queue: BinaryHeap::new() };
        for a in 0..n as u32 {
            let later: Vec<u32> = clusters.neighbours[a as usize].range(a + 1..).map(|(&b, _)| b).collect();
            later.into_iter().for_each(|b| clusters.enqueue(a, b));
        }
        clusters
    }

    fn enqueue(&mut self, a: u32, b: u32) {
        let (a, b) = (a.min(b), a.max(b));
        let score = self.neighbours[a as usize][&b].score();
        self.queue.push(Candidate { score, pair: Reverse((a, b)) });
    }

    /// The best merge that is still as it was queued.
    fn best_merge(&mut self) -> Option<Merge> {
        while let Some(Candidate { score, pair: Reverse((a, b)) }) = self.queue.pop() {
            let Some(tally) = self.neighbours[a as usize].get(&b) else { continue };
            if tally.score().total_cmp(&score).is_ne() {
                continue;
            }
            let (into, from) = if self.neighbours[a as usize].len() < self.neighbours[b as usize].len() {
                (b, a)
            } else {
                (a, b)
            };
            return Some(Merge { into, from, into_from: self.neighbours[into as usize][&from].winner() });
        }
        None
    }

    fn apply(&mut self, merge: &Merge) {
        let Merge { into, from, into_from } = *merge;
        self.neighbours[into as usize].remove(&from);
        for (third, tally) in std::mem::take(&mut self.neighbours[from as usize]) {
            let of_third = &mut self.neighbours[third as usize];
            of_third.remove(&from);
            if third == into {
                continue;
            }
            let turned = tally.turned(into_from);
            of_third.entry(into).or_default().add(turned.reversed());
            self.neighbours[into as usize].entry(third).or_default().add(turned);
            self.enqueue(into, third);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn turned(angle: f64, mirrored: bool) -> Orientation {
        Orientation { rotation: Complex::from_polar(1.0, angle), mirrored }
    }

    fn close(a: Orientation, b: Orientation) -> bool {
        a.mirrored == b.mirrored && (a.rotation - b.rotation).norm() < 1e-12
    }

    #[test]
    fn tallies_turn_and_reverse_as_the_orientations_they_stand_for() {
        let (x, y) = (turned(0.7, true), turned(-1.9, false));
        for (first, second) in [(x, x), (x, y), (y, x), (y, y)] {
            let vote = Vote { a: 0, b: 1, a_from_b: first, weight: 2.0 };
            assert!(close(Tally::of(&vote).reversed().winner(), first.inverse()));
            assert!(close(Tally::of(&vote).turned(second).winner(), second.after(first)));
            assert!(close(second.inverse().after(second), Orientation::IDENTITY));
        }
    }

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
        let found = settle(4, &votes);
        assert!(found.iter().all(|&node| close(node, Orientation::IDENTITY)));
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
