//! Orientations by merging the nodes that their edges agree on most.
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

use super::orientation::{Orientation, Vote};

/// The orientations of `n` nodes of a connected graph, in the frame of one of them.
pub(super) fn merged(n: usize, votes: impl Iterator<Item = Vote>) -> Vec<Orientation> {
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
pub(super) struct Tally {
    plain: Complex<f64>,
    mirrored: Complex<f64>,
    plain_weight: f64,
    mirrored_weight: f64,
}

impl Tally {
    pub(super) fn of(vote: &Vote) -> Self {
        let z = vote.a_from_b.rotation * vote.weight;
        if vote.a_from_b.mirrored {
            Self { mirrored: z, mirrored_weight: vote.weight, ..Self::default() }
        } else {
            Self { plain: z, plain_weight: vote.weight, ..Self::default() }
        }
    }

    pub(super) fn add(&mut self, other: Self) {
        self.plain += other.plain;
        self.mirrored += other.mirrored;
        self.plain_weight += other.plain_weight;
        self.mirrored_weight += other.mirrored_weight;
    }

    /// The same votes with the roles of the clusters exchanged.
    fn reversed(self) -> Self {
        Self { plain: self.plain.conj(), ..self }
    }

    /// The votes of `turn` after what was voted for.
    fn turned(self, turn: Orientation) -> Self {
        if turn.mirrored {
            Self {
                plain: turn.rotation * self.mirrored.conj(),
                mirrored: turn.rotation * self.plain.conj(),
                plain_weight: self.mirrored_weight,
                mirrored_weight: self.plain_weight,
            }
        } else {
            Self { plain: turn.rotation * self.plain, mirrored: turn.rotation * self.mirrored, ..self }
        }
    }

    fn score(&self) -> f64 {
        let largest = self.plain.norm_sqr().max(self.mirrored.norm_sqr());
        largest / (self.plain_weight + self.mirrored_weight)
    }

    /// A handedness that at least one edge votes for.
    pub(super) fn winner(&self) -> Orientation {
        let plain = (self.plain.norm_sqr(), self.plain_weight);
        let mirrored = (self.mirrored.norm_sqr(), self.mirrored_weight) > plain;
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
    use crate::synchronise::orientation::fixtures::{close, turned};

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
    fn votes_that_cancel_leave_their_handedness() {
        // The one says ahead, the other back: no rotation, but both mirror.
        let vote = |angle| Vote { a: 0, b: 1, a_from_b: turned(angle, true), weight: 1.0 };
        let back = Vote { a_from_b: Orientation { rotation: -Complex::ONE, mirrored: true }, ..vote(0.0) };
        let mut tally = Tally::of(&vote(0.0));
        tally.add(Tally::of(&back));
        assert_eq!((tally.score(), tally.winner()), (0.0, turned(0.0, true)));
    }

    #[test]
    fn the_order_of_merges_does_not_show_where_all_votes_agree() {
        // A ring of seven with its second neighbours, each node turned by its number.
        let truth = |k: u32| turned(f64::from(k), k.is_multiple_of(3));
        let votes = (0..7).flat_map(|a| [1, 2].map(|step| (a, (a + step) % 7)));
        let votes = votes.map(|(a, b)| Vote {
            a,
            b,
            a_from_b: truth(a).inverse().after(truth(b)),
            weight: 1.0 + f64::from(a * b % 5),
        });
        let found = merged(7, votes);
        for (k, &node) in found.iter().enumerate() {
            let expected = truth(0).inverse().after(truth(k as u32));
            assert!(close(found[0].inverse().after(node), expected));
        }
    }
}
