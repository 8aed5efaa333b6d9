//! From counts to distances: the weighted graph that regions, local maps and polish work on.
//!
//! Two landmarks that were seen together are *linked*; two that never were are simply unknown to
//! each other, which is not a distance. A link has
//!
//! - a distance `d_ij = sqrt(-alpha ln f_ij)`, the paper's eq. (10) without its clamps, of the
//!   shrunken frequency `f_ij = (n_ij + 1/2) / (n_i + n_j - n_ij + 1)`, which lies strictly
//!   between 0 and 1, so that `d_ij > 0`;
//! - a weight `sqrt(n_ij)`: pairs seen together often are known better, but a slow robot repeats
//!   itself, so that the information grows more slowly than the count.

use covimap_embed::{Pair, PairDistances};
use petgraph::graph::UnGraph;
use rayon::prelude::*;

use crate::{CoVisibility, HonestLinks, LandmarkId};

/// The paper's `alpha_2`; it sets the unit of the map.
pub(crate) const ALPHA: f64 = 0.3;

/// Landmarks whose links are one parallel task.
const ROWS: usize = 1 << 13;

/// One end of a link, as stored in the row of the other end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Link {
    /// The landmark at the other end.
    pub to: u32,
    /// Distance in map units, `> 0`.
    pub distance: f64,
    /// Weight in the stress, `> 0`.
    pub weight: f64,
}

/// The links of all landmarks, one ascending row a landmark.
#[derive(Debug, Clone, PartialEq)]
pub struct LinkGraph {
    starts: Vec<usize>,
    links: Vec<Link>,
}

impl LinkGraph {
    /// The link of every pair that was seen together.
    #[must_use]
    pub fn from_counts(counts: &CoVisibility) -> Self {
        Self::from_counts_where(counts, |_, _| true)
    }

    /// The links that are kept.
    #[must_use]
    pub fn from_honest(counts: &CoVisibility, honest: &HonestLinks) -> Self {
        Self::from_counts_where(counts, |landmark, place| honest.keeps(landmark, place))
    }

    /// The links of which `keep(i, place in the row of i)` is true; it must be symmetric.
    fn from_counts_where(counts: &CoVisibility, keep: impl Fn(LandmarkId, usize) -> bool + Sync) -> Self {
        let rows: Vec<Vec<Link>> = (0..counts.landmarks() as u32)
            .into_par_iter()
            .map(|i| {
                let (partners, together) = counts.row(LandmarkId(i));
                let n_i = counts.sightings()[i as usize];
                let link = |(&to, &both): (&u32, &u32)| {
                    link(to, f64::from(n_i), f64::from(counts.sightings()[to as usize]), f64::from(both))
                };
                let kept = |&(place, _): &(usize, _)| keep(LandmarkId(i), place);
                let pairs = partners.iter().zip(together);
                pairs.enumerate().filter(kept).map(|(_, pair)| link(pair)).collect()
            })
            .collect();
        Self::from_rows(rows)
    }

    pub(crate) fn from_rows(rows: Vec<Vec<Link>>) -> Self {
        let mut starts = Vec::with_capacity(rows.len() + 1);
        starts.push(0);
        let mut links = Vec::with_capacity(rows.iter().map(Vec::len).sum());
        for row in rows {
            links.extend(row);
            starts.push(links.len());
        }
        Self { starts, links }
    }

    /// Number of landmarks.
    #[must_use]
    pub fn landmarks(&self) -> usize {
        self.starts.len() - 1
    }

    /// Number of links.
    #[must_use]
    pub fn link_count(&self) -> usize {
        self.links.len() / 2
    }

    /// The links of one landmark, ascending.
    #[must_use]
    pub fn of(&self, landmark: u32) -> &[Link] {
        &self.links[self.starts[landmark as usize]..self.starts[landmark as usize + 1]]
    }

    /// The part of the graph on `members` (ascending), renumbered by their places in it.
    #[must_use]
    pub fn restricted_to(&self, members: &[u32]) -> Self {
        // So many landmarks of the whole come before a member, at most, that are none.
        let missing = self.landmarks() - members.len();
        let rows = |some: &[u32]| {
            let (mut lengths, mut links) = (Vec::with_capacity(some.len()), Vec::new());
            for &member in some {
                // Both lists ascend: walk them together.
                let mut place = 0;
                let before = links.len();
                for link in self.of(member) {
                    let to = link.to as usize;
                    let within = place.max(to.saturating_sub(missing))..members.len().min(to + 1);
                    place = within.start + members[within].partition_point(|&other| other < link.to);
                    if members.get(place) == Some(&link.to) {
                        links.push(Link { to: place as u32, ..*link });
                    }
                }
                lengths.push(links.len() - before);
            }
            (lengths, links)
        };
        let parts: Vec<_> = members.par_chunks(ROWS).map(rows).collect();
        let mut part =
            Self { starts: vec![0], links: Vec::with_capacity(parts.iter().map(|part| part.1.len()).sum()) };
        for (lengths, links) in parts {
            let first = part.links.len();
            part.starts.extend(lengths.iter().scan(first, |end, length| {
                *end += length;
                Some(*end)
            }));
            part.links.extend(links);
        }
        part
    }

    /// The links as a weighted scaling problem.
    #[must_use]
    pub fn to_pairs(&self) -> PairDistances {
        self.collect_pairs(|_, link| (link.distance, link.weight))
    }

    /// The linked pairs `i < j` with the distance and weight that `measure(i, j)` gives them:
    /// a distance `>= 0` and a weight `> 0`, both finite.
    pub(crate) fn to_pairs_with(&self, measure: impl Fn(u32, u32) -> (f64, f64)) -> PairDistances {
        self.collect_pairs(|i, link| measure(i, link.to))
    }

    fn collect_pairs(&self, measure: impl Fn(u32, &Link) -> (f64, f64)) -> PairDistances {
        let mut pairs = Vec::with_capacity(self.link_count());
        for i in 0..self.landmarks() as u32 {
            for link in self.of(i).iter().filter(|link| link.to > i) {
                let (distance, weight) = measure(i, link);
                pairs.push(Pair { i, j: link.to, distance, weight });
            }
        }
        PairDistances::new(self.landmarks(), pairs).expect("links form a valid pair list (bug in covimap)")
    }

    /// The graph for petgraph's algorithms: node k is landmark k, edges carry the distance.
    #[must_use]
    pub fn to_petgraph(&self) -> UnGraph<(), f64> {
        let mut graph = UnGraph::with_capacity(self.landmarks(), self.link_count());
        for _ in 0..self.landmarks() {
            graph.add_node(());
        }
        for i in 0..self.landmarks() as u32 {
            for link in self.of(i).iter().filter(|link| link.to > i) {
                graph.add_edge(i.into(), link.to.into(), link.distance);
            }
        }
        graph
    }

    /// The landmarks of each connected component, ascending; the largest component first, equal
    /// ones by their first landmark.
    #[must_use]
    pub fn components(&self) -> Vec<Vec<u32>> {
        let mut found = vec![false; self.landmarks()];
        let mut components = Vec::new();
        for first in 0..self.landmarks() as u32 {
            if found[first as usize] {
                continue;
            }
            found[first as usize] = true;
            let mut members = vec![first];
            let mut next = 0;
            while next < members.len() {
                for link in self.of(members[next]) {
                    if !std::mem::replace(&mut found[link.to as usize], true) {
                        members.push(link.to);
                    }
                }
                next += 1;
            }
            members.sort_unstable();
            components.push(members);
        }
        components.sort_by_key(|members| (std::cmp::Reverse(members.len()), members[0]));
        components
    }
}

fn link(to: u32, n_i: f64, n_j: f64, both: f64) -> Link {
    let frequency = (both + 0.5) / (n_i + n_j - both + 1.0);
    Link { to, distance: (-ALPHA * frequency.ln()).sqrt(), weight: both.sqrt() }
}

#[cfg(test)]
mod tests;
