//! A few pieces of a large component, on which a curve is learnt as well as on the whole: it has few
//! parameters, and all of them are matters of neighbours.

use std::collections::VecDeque;

use covimap_embed::{Pair, PairDistances, Point};

use crate::LinkGraph;

/// Components of up to so many landmarks are one piece, whole.
const WHOLE: usize = 10_000;
/// Pieces that a larger component is sampled by, together of that size.
const PIECES: usize = 4;

/// The landmarks of the pieces and the links among them.
pub(super) struct Pieces {
    /// Ascending.
    members: Vec<u32>,
    /// Place among the members of every landmark; `u32::MAX` outside.
    place: Vec<u32>,
    /// Places in the list of all links, ascending.
    pub links: Vec<usize>,
}

impl Pieces {
    /// The pieces of a connected graph, each grown from a landmark by breadth first. Numbers follow the time at which
    /// landmarks were first seen, so that seeds of evenly spread numbers lie apart.
    pub fn of(graph: &LinkGraph, pairs: &PairDistances) -> Self {
        let n = graph.landmarks();
        let members = if n <= WHOLE { (0..n as u32).collect() } else { grow(graph, WHOLE / PIECES) };
        let mut place = vec![u32::MAX; n];
        for (k, &member) in (0..).zip(&members) {
            place[member as usize] = k;
        }
        let inside = |pair: &Pair| [pair.i, pair.j].iter().all(|&end| place[end as usize] != u32::MAX);
        let links = (0..).zip(pairs.pairs()).filter(|(_, pair)| inside(pair)).map(|(k, _)| k).collect();
        Self { members, place, links }
    }

    /// The links of the pieces as a scaling problem of their own, measured anew.
    pub fn pairs(&self, all: &PairDistances, measure: impl Fn(usize, &Pair) -> Pair) -> PairDistances {
        let within = |&link: &usize| {
            let pair = measure(link, &all.pairs()[link]);
            let [i, j] = [pair.i, pair.j].map(|end| self.place[end as usize]);
            Pair { i, j, ..pair }
        };
        PairDistances::new(self.members.len(), self.links.iter().map(within).collect())
            .expect("distances of counts are finite and weights positive (bug in covimap)")
    }

    /// The points of the pieces.
    pub fn take(&self, points: &[Point]) -> Vec<Point> {
        self.members.iter().map(|&member| points[member as usize]).collect()
    }

    /// Puts the points of the pieces back among all.
    pub fn put_back(&self, own: &[Point], points: &mut [Point]) {
        for (&member, &point) in self.members.iter().zip(own) {
            points[member as usize] = point;
        }
    }
}

/// [`PIECES`] disjoint pieces of at most `size` landmarks, ascending.
fn grow(graph: &LinkGraph, size: usize) -> Vec<u32> {
    let n = graph.landmarks();
    let mut taken = vec![false; n];
    for piece in 0..PIECES {
        let seed = piece * n / PIECES;
        if taken[seed] {
            continue;
        }
        let mut left = size - 1;
        taken[seed] = true;
        let mut front = VecDeque::from([seed as u32]);
        while let Some(landmark) = front.pop_front().filter(|_| left > 0) {
            for link in graph.of(landmark) {
                if left > 0 && !std::mem::replace(&mut taken[link.to as usize], true) {
                    left -= 1;
                    front.push_back(link.to);
                }
            }
        }
    }
    (0..n as u32).filter(|&landmark| taken[landmark as usize]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixtures::{log_of, looks, scattered};
    use crate::{CoVisibility, Silent};

    fn strip(landmarks: usize) -> LinkGraph {
        let length = landmarks as f64 / 8.0;
        let truth = scattered(landmarks, [length, 1.0], 3);
        let log = log_of(&looks(&truth, [length, 1.0], 0.6, 20 * landmarks));
        LinkGraph::from_counts(&CoVisibility::count(&log, &Silent).unwrap())
    }

    #[test]
    fn a_small_graph_is_one_piece() {
        let graph = strip(40);
        let pairs = graph.to_pairs();
        let pieces = Pieces::of(&graph, &pairs);
        assert_eq!(pieces.members.len(), graph.landmarks());
        assert_eq!(pieces.links.len(), pairs.pairs().len());
        assert_eq!(pieces.pairs(&pairs, |_, pair| *pair), pairs);
    }

    #[test]
    fn pieces_are_connected_of_their_size_and_apart() {
        let graph = strip(400);
        let members = grow(&graph, 25);
        assert!(members.is_sorted());
        assert_eq!(members.len(), 4 * 25);
        let parts = graph.restricted_to(&members).components();
        assert!(parts.len() <= PIECES, "{parts:?}");
        assert!(parts.iter().all(|part| part.len() >= 25), "{parts:?}");
    }

    #[test]
    fn points_are_taken_and_put_back() {
        let graph = strip(40);
        let mut pieces = Pieces::of(&graph, &graph.to_pairs());
        pieces.members = vec![1, 3];
        let mut points = vec![[0.0, 1.0], [1.0, 2.0], [2.0, 3.0], [3.0, 4.0]];
        assert_eq!(pieces.take(&points), [[1.0, 2.0], [3.0, 4.0]]);
        pieces.put_back(&[[5.0; 2], [6.0; 2]], &mut points);
        assert_eq!(points, [[0.0, 1.0], [5.0; 2], [2.0, 3.0], [6.0; 2]]);
    }
}
