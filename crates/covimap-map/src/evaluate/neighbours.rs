//! Nearest neighbours, found along the Delaunay graph.
//!
//! Every point other than `p` has a Delaunay neighbour that is nearer to `p` (a copy has one that
//! is as near). Followed backwards, this means that the nearest points of `p` can be gathered one after the other, always taking
//! the nearest among the Delaunay neighbours of those taken so far. The search adapts to any
//! density and needs no index of its own.
//!
//! # Complexity
//! `O(n k log k)` for the bounded degrees that all but contrived point sets have.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use covimap_embed::Point;
use rayon::prelude::*;
use rustc_hash::FxHashSet;

/// How many neighbours are near.
const NEAR: usize = 10;
/// Distances that differ by less than this share are equal.
const TIE: f64 = 1e-9;

/// The `min(10, n - 1)` nearest other points of every point.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct NearestNeighbours {
    k: usize,
    /// `k` a point, nearest first; equally near ones in the order in which the search meets them.
    nearest: Vec<u32>,
}

impl NearestNeighbours {
    /// Searches `points` along their Delaunay `edges`.
    pub fn of(points: &[Point], edges: &[(u32, u32)]) -> Self {
        let k = NEAR.min(points.len().saturating_sub(1));
        let graph = Adjacency::of(points.len(), edges);
        let nearest = (0..points.len() as u32)
            .into_par_iter()
            .map_init(Search::default, |search, from| search.nearest(points, &graph, from, k))
            .flatten_iter()
            .collect();
        Self { k, nearest }
    }

    /// Neighbours of a point, nearest first.
    pub fn row(&self, point: usize) -> &[u32] {
        &self.nearest[self.k * point..self.k * (point + 1)]
    }

    /// Sum over points of the share of `found` that is among the nearest, `self` being those among
    /// the points `at`. One as near as the last of them is among them.
    pub fn recall(&self, at: &[Point], found: &Self) -> f64 {
        let hits: usize = (0..at.len())
            .into_par_iter()
            .map(|i| {
                let reach = |j: u32| squared(at[i], at[j as usize]);
                let last = self.row(i).last().map_or(0.0, |&j| reach(j)) * (1.0 + TIE).powi(2);
                found.row(i).iter().filter(|&&j| reach(j) <= last).count()
            })
            .sum();
        hits as f64 / self.k as f64
    }
}

#[derive(Default)]
struct Search {
    /// Candidates, nearest on top. Squared distances are not negative, so their bits are in their order.
    open: BinaryHeap<Reverse<(u64, u32)>>,
    seen: FxHashSet<u32>,
}

impl Search {
    fn nearest(&mut self, points: &[Point], graph: &Adjacency, from: u32, k: usize) -> Vec<u32> {
        self.open.clear();
        self.seen.clear();
        self.seen.insert(from);
        let mut taken = Vec::with_capacity(k);
        let mut at = from;
        while taken.len() < k {
            for &next in graph.row(at) {
                if self.seen.insert(next) {
                    let distance = squared(points[from as usize], points[next as usize]);
                    self.open.push(Reverse((distance.to_bits(), next)));
                }
            }
            let Reverse((_, nearest)) =
                self.open.pop().expect("Delaunay graphs are connected (bug in covimap)");
            taken.push(nearest);
            at = nearest;
        }
        taken
    }
}

fn squared(a: Point, b: Point) -> f64 {
    (a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2)
}

/// Both directions of every edge, by point.
struct Adjacency {
    starts: Vec<usize>,
    targets: Vec<u32>,
}

impl Adjacency {
    fn of(n: usize, edges: &[(u32, u32)]) -> Self {
        let both = || edges.iter().flat_map(|&(a, b)| [(a, b), (b, a)]);
        let mut starts = vec![0; n + 1];
        both().for_each(|(from, _)| starts[from as usize + 1] += 1);
        (0..n).for_each(|i| starts[i + 1] += starts[i]);
        let mut free = starts.clone();
        let mut targets = vec![0; 2 * edges.len()];
        for (from, to) in both() {
            targets[free[from as usize]] = to;
            free[from as usize] += 1;
        }
        Self { starts, targets }
    }

    fn row(&self, point: u32) -> &[u32] {
        &self.targets[self.starts[point as usize]..self.starts[point as usize + 1]]
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::delaunay_edges;

    fn of(points: &[Point]) -> NearestNeighbours {
        NearestNeighbours::of(points, &delaunay_edges(points).unwrap())
    }

    fn distances(points: &[Point], i: usize, row: impl IntoIterator<Item = u32>) -> Vec<f64> {
        row.into_iter().map(|j| squared(points[i], points[j as usize])).collect()
    }

    fn check_against_all(points: &[Point]) {
        let near = of(points);
        for i in 0..points.len() {
            let others = (0..points.len() as u32).filter(|&j| j as usize != i);
            let mut all = distances(points, i, others);
            all.sort_by(f64::total_cmp);
            let mut row = near.row(i).to_vec();
            assert_eq!(distances(points, i, row.iter().copied()), all[..near.k]);
            row.sort_unstable();
            row.dedup();
            assert_eq!(row.len(), near.k);
            assert!(!row.contains(&(i as u32)));
        }
    }

    proptest! {
        #[test]
        fn agrees_with_sorting_all_distances(
            points in prop::collection::vec([0.0..1.0f64, 0.0..1.0f64], 1..80)
        ) {
            check_against_all(&points);
        }

        #[test]
        fn ties_and_copies_are_searched_too(
            points in prop::collection::vec([0i32..5, 0i32..5], 1..60)
        ) {
            check_against_all(&points.iter().map(|p| p.map(f64::from)).collect::<Vec<_>>());
        }
    }

    #[test]
    fn points_in_one_place_and_on_a_line() {
        check_against_all(&[[2.0, 2.0]; 30]);
        check_against_all(&(0..30).map(|i| [f64::from(i), 2.0 * f64::from(i)]).collect::<Vec<_>>());
    }

    #[test]
    fn recall_by_hand() {
        // Places 0, 1, 2, 4 on a line; landmarks 0 and 3 are both 2 away from landmark 2.
        let truth = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [4.0, 0.0]];
        let near = NearestNeighbours { k: 2, nearest: vec![1, 2, 0, 2, 1, 0, 2, 1] };
        // Landmark 0 finds 1 but 3 instead of 2: one. Landmark 1: both. Landmark 2 finds 3, as near as 0:
        // both. Landmark 3 finds 1 but 0 instead of 2: one. Six of eight, times the four landmarks.
        let found = NearestNeighbours { k: 2, nearest: vec![1, 3, 0, 2, 3, 1, 0, 1] };
        assert_eq!(near.recall(&truth, &found), 3.0);
        assert_eq!(near.recall(&truth, &near), 4.0);
    }
}
