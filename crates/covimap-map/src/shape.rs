//! Shape: path lengths as a weak pull, where the links alone leave the shape of a map free.
//!
//! A short log, or one made along roads, links every landmark to a handful of others. Many maps fit such
//! links alike: folded ones as well as open ones. That two landmarks were never seen together says little,
//! but how far apart they are *along the links* is a fair guess in a map that lies open. So the stress of
//! the links is joined by a second sum over pairs of a landmark and a pivot that are not linked,
//!
//! `sum_links w_ij (r_ij - d_ij)^2 + pull sum_far v_ip (r_ip - l_ip)^2`,  `v_ip = s / l_ip^2`,  (1)
//!
//! `l` the length of the shortest path, `s` such that `sum v l^2 = sum w d^2`: with a pull of 1 both sums
//! weigh relative errors alike. Around a corner or a hole paths are too long, so that the pull bends a map
//! whose links are rigid; whether it is wanted must come from the log.
//!
//! # Choice
//! By links that are held out. Each of [`FOLDS`] times a tenth of the links, none of a spanning tree, is left
//! out, the map is made from the others under every candidate, and the stress of those left out is summed
//! up. Candidates are pulls of 0, 0.1 and 1, from the stitched start and from pivot scaling of the path
//! lengths, which is open but crude. The plain map stays unless another one predicts clearly better.
//!
//! Where landmarks have many links, the plain map always won in trials (hall, office, corridors), so that
//! components of [`ENOUGH_LINKS`] links a landmark are not put to the question; nor are very large ones.

use std::borrow::Cow;

use covimap_embed::{
    Pair, PairDistances, PivotDistances, Point, ShortestPaths, StopRule, newton, pivot_scaling,
};
use petgraph::unionfind::UnionFind;
use rayon::prelude::*;

use crate::component::stitched;
use crate::{AutoParams, Link, LinkGraph, MapError, Observer, Silent};

/// Links a landmark from which on links alone fix the shape.
const ENOUGH_LINKS: usize = 10;
/// Fewest and most landmarks for which the choice is made.
const SIZES: std::ops::RangeInclusive<usize> = 8..=2000;
/// Most pivots of the second sum, and of the start from paths.
const PIVOTS: usize = 40;
/// Times that links are held out.
const FOLDS: u64 = 5;
/// One link of so many is held out at a time.
const HELD_OUT: u64 = 10;
/// Pulls that are tried besides none.
const PULLS: [f64; 2] = [0.1, 1.0];
/// Pull under which the start from paths is settled before its own is set.
const FIRST_PULL: f64 = 100.0;
/// Share of the plain map's stress over held-out links below which another one is taken.
const CLEARLY: f64 = 0.9;

/// How a component is started and what its stress is made of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Shape {
    /// Whether to start from path lengths instead of the stitched map.
    from_paths: bool,
    /// The pull of eq. (1).
    pub pull: f64,
}

impl Shape {
    /// The links alone, from the stitched map.
    const PLAIN: Self = Self { from_paths: false, pull: 0.0 };

    /// The terms of eq. (1).
    pub fn terms<'a>(&self, links: &'a PairDistances) -> Result<Cow<'a, PairDistances>, MapError> {
        if self.pull == 0.0 { Ok(Cow::Borrowed(links)) } else { with_paths(links, self.pull).map(Cow::Owned) }
    }

    /// Where to begin.
    pub fn start(&self, links: &PairDistances, stitched: Vec<Point>) -> Result<Vec<Point>, MapError> {
        if !self.from_paths {
            return Ok(stitched);
        }
        let open = pivot_scaling(&PivotDistances::max_min(&ShortestPaths::new(links), PIVOTS)?);
        let stop = StopRule { max_iterations: 60, tolerance: 1e-6 };
        Ok(newton(&with_paths(links, FIRST_PULL)?, &open, stop)?.points)
    }
}

/// The shape that predicts held-out links best.
pub(crate) fn choose(
    graph: &LinkGraph,
    params: &AutoParams,
    observer: &dyn Observer,
) -> Result<Shape, MapError> {
    let n = graph.landmarks();
    let complete = graph.link_count() == n * (n - 1) / 2;
    if !SIZES.contains(&n) || complete || graph.link_count() >= ENOUGH_LINKS * n {
        return Ok(Shape::PLAIN);
    }
    let shape = |from_paths| PULLS.map(|pull| Shape { from_paths, pull });
    let paths_alone = Shape { from_paths: true, pull: 0.0 };
    let candidates: Vec<Shape> =
        [Shape::PLAIN, paths_alone].into_iter().chain(shape(false)).chain(shape(true)).collect();
    let spanning = spanning_tree(graph);
    let misses: Vec<Vec<f64>> = (0..FOLDS)
        .into_par_iter()
        .map(|fold| {
            if observer.interrupted() {
                return Err(MapError::Interrupted);
            }
            held_out_stress(graph, &spanning, fold, &candidates, params)
        })
        .collect::<Result<_, MapError>>()?;
    let total = |k: usize| misses.iter().map(|fold| fold[k]).sum::<f64>();
    let best = (0..candidates.len()).min_by(|&a, &b| total(a).total_cmp(&total(b))).unwrap_or(0);
    Ok(if total(best) < CLEARLY * total(0) { candidates[best] } else { Shape::PLAIN })
}

/// Stress of the links of a fold under each candidate, which sees the other links only.
fn held_out_stress(
    graph: &LinkGraph,
    spanning: &[(u32, u32)],
    fold: u64,
    candidates: &[Shape],
    params: &AutoParams,
) -> Result<Vec<f64>, MapError> {
    let held_out = |i: u32, j: u32| {
        let link = (i.min(j), i.max(j));
        mixed(link) % HELD_OUT == fold && spanning.binary_search(&link).is_err()
    };
    let rest = graph.without(held_out);
    let links = rest.to_pairs();
    let (.., map) = stitched(&rest, params, &Silent)?;
    let stress = |shape: &Shape| {
        let start = shape.start(&links, map.points.clone())?;
        let points = newton(&*shape.terms(&links)?, &start, params.polish_stop.rule())?.points;
        let miss = |i: u32, link: &Link| {
            let (here, there) = (points[i as usize], points[link.to as usize]);
            link.weight * ((here[0] - there[0]).hypot(here[1] - there[1]) - link.distance).powi(2)
        };
        let of = |i: u32| {
            let links = graph.of(i).iter().filter(|link| link.to > i && held_out(i, link.to));
            links.map(|link| miss(i, link)).sum::<f64>()
        };
        Ok((0..graph.landmarks() as u32).map(of).sum())
    };
    candidates.iter().map(stress).collect()
}

/// Numbers that spread links over the folds (Steele, Lea, Flood, "Fast splittable pseudorandom number
/// generators", 2014).
fn mixed((i, j): (u32, u32)) -> u64 {
    let mut z = (u64::from(i) << 32 | u64::from(j)).wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ z >> 31
}

/// Links that hold a connected graph together, the heaviest ones, ascending.
fn spanning_tree(graph: &LinkGraph) -> Vec<(u32, u32)> {
    let links = |i: u32| graph.of(i).iter().filter(move |link| link.to > i).map(move |link| (i, *link));
    let mut links: Vec<_> = (0..graph.landmarks() as u32).flat_map(links).collect();
    links.sort_by(|a, b| b.1.weight.total_cmp(&a.1.weight).then((a.0, a.1.to).cmp(&(b.0, b.1.to))));
    let mut parts = UnionFind::<u32>::new(graph.landmarks());
    let mut tree: Vec<_> =
        links.iter().filter(|(i, link)| parts.union(*i, link.to)).map(|(i, link)| (*i, link.to)).collect();
    tree.sort_unstable();
    tree
}

/// The links, and for every pivot the landmarks that it is not linked to.
fn with_paths(links: &PairDistances, pull: f64) -> Result<PairDistances, MapError> {
    let n = links.objects();
    let paths = PivotDistances::max_min(&ShortestPaths::new(links), PIVOTS)?;
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
