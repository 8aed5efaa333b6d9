//! Shape: path lengths as a weak pull, where the links leave the shape of a map free.
//!
//! A short log, or one made along roads, links every landmark to a handful of others. Many maps fit such
//! links alike, folded ones as well as open ones, and stitching decides by chance: most of the map lies
//! beyond hinges. That two landmarks were never seen together says little, but how far apart they are *along
//! the links* is a fair guess in a map that lies open. So the map begins with pivot scaling of the lengths of
//! paths, in which nothing is folded, and the stress of the links is joined by a second sum over pairs of a
//! landmark and a pivot that are not linked,
//!
//! `sum_links w_ij (r_ij - d_ij)^2 + pull sum_far v_ip (r_ip - l_ip)^2`,  `v_ip = s / l_ip^2`,  (1)
//!
//! `l` the length of the shortest path, `s` such that `sum v l^2 = sum w d^2`: with a pull of 1 both sums
//! weigh relative errors alike.
//!
//! Around a corner or a hole paths are too long, and the pull would bend a map whose links are rigid.
//! It is used only where most sides are guesses *and* landmarks have few links.
//!
//! # Complexity
//! `O(p (n + m) log n)` for `p = 40` pivots and `m` links, and a polish with `p n` more pairs.

use std::borrow::Cow;

use covimap_embed::{
    Pair, PairDistances, PivotDistances, Point, ShortestPaths, StopRule, newton, pivot_scaling,
};

use crate::stitch::Stitched;
use crate::{LinkGraph, MapError, RegionCover};

/// Links a landmark from which on links alone make the map.
const ENOUGH_LINKS: usize = 10;
/// Most landmarks: the second sum fills in the factors of the polish.
pub(crate) const MOST_LANDMARKS: usize = 10_000;
/// Most pivots.
const PIVOTS: usize = 40;
/// Pull under which the start from paths is settled.
const FIRST_PULL: f64 = 100.0;

/// What the stress of a component is made of, and where its minimisation begins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Shape {
    /// The pull of eq. (1); 0 for the links alone, from the stitched map.
    pub pull: f64,
}

impl Shape {
    /// The links alone.
    pub const FREE: Self = Self { pull: 0.0 };

    /// The links alone, unless they are few and less than half of the landmarks are in the largest branch.
    pub fn of(graph: &LinkGraph, cover: &RegionCover, stitched: &Stitched) -> Self {
        let n = graph.landmarks();
        let sure = cover.core_of().iter().filter(|&&region| stitched.branch_of[region as usize] == 0).count();
        let few = graph.link_count() < ENOUGH_LINKS * n;
        Self { pull: if few && 2 * sure < n && n <= MOST_LANDMARKS { 1.0 } else { 0.0 } }
    }

    /// The terms of eq. (1).
    pub fn terms<'a>(&self, links: &'a PairDistances) -> Result<Cow<'a, PairDistances>, MapError> {
        if self.pull == 0.0 {
            return Ok(Cow::Borrowed(links));
        }
        with_paths(links, &paths(links)?, self.pull).map(Cow::Owned)
    }

    /// Where to begin.
    pub fn start(&self, links: &PairDistances, stitched: Vec<Point>) -> Result<Vec<Point>, MapError> {
        if self.pull == 0.0 {
            return Ok(stitched);
        }
        let paths = paths(links)?;
        let stop = StopRule { max_iterations: 60, tolerance: 1e-6 };
        Ok(newton(&with_paths(links, &paths, FIRST_PULL)?, &pivot_scaling(&paths), stop)?.points)
    }
}

/// The paths from the pivots.
fn paths(links: &PairDistances) -> Result<PivotDistances, MapError> {
    Ok(PivotDistances::max_min(&ShortestPaths::new(links), PIVOTS)?)
}

/// The links, and for every pivot the paths to landmarks that it is not linked to: both sums of eq. (1).
pub(crate) fn with_paths(
    links: &PairDistances,
    paths: &PivotDistances,
    pull: f64,
) -> Result<PairDistances, MapError> {
    let n = links.objects();
    let mut far: Vec<Pair> = Vec::with_capacity(n * paths.pivots().len());
    for (&pivot, row) in paths.pivots().iter().zip(paths.rows()) {
        for (other, &distance) in (0..n as u32).zip(row).filter(|&(other, _)| other != pivot) {
            far.push(Pair { i: pivot.min(other), j: pivot.max(other), distance, weight: 1.0 });
        }
    }
    let ends = |pair: &Pair| (pair.i, pair.j);
    far.retain(|pair| links.pairs().binary_search_by_key(&ends(pair), ends).is_err());
    far.sort_by_key(ends);
    far.dedup_by_key(|pair| ends(pair));
    let size: f64 = links.pairs().iter().map(|pair| pair.weight * pair.distance * pair.distance).sum();
    let share = pull * size / far.len() as f64;
    far.iter_mut().for_each(|pair| pair.weight = share / (pair.distance * pair.distance));
    far.extend_from_slice(links.pairs());
    far.sort_by_key(ends);
    Ok(PairDistances::new(n, far)?)
}

#[cfg(test)]
mod tests;
