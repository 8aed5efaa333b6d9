//! Local maps: every region solved by itself.
//!
//! Inside a region nearly every landmark was seen with nearly every other, or is one landmark
//! away from it, so that path lengths are fair guesses of the distances that are unknown. They
//! serve for the start only; the map itself is fitted to known distances.

use covimap_embed::{DistanceMatrix, EmbedError, PairDistances, Point, StopRule, classical_scaling, smacof};

use crate::{LinkGraph, Region, RegionCover};

/// A region's own map, in a frame of its own.
#[derive(Debug, Clone, PartialEq)]
pub struct LocalMap {
    /// Position of each member of the region, in the order of `Region::members`.
    pub points: Vec<Point>,
    /// Stress-1 over the links inside the region.
    pub stress1: f64,
}

/// Maps one region: classical scaling of path lengths, then SMACOF over the links.
pub(crate) fn solve(graph: &LinkGraph, region: &Region, stop: StopRule) -> Result<LocalMap, EmbedError> {
    let pairs = graph.restricted_to(&region.members).to_pairs();
    let start = path_scaling(&pairs)?;
    let solved = smacof(&pairs, &start, stop)?;
    Ok(LocalMap { points: solved.points, stress1: solved.stress1 })
}

/// Maps a region anew by other distances of its links, from the map it has.
pub(crate) fn solve_again(
    pairs: &PairDistances,
    map: &LocalMap,
    stop: StopRule,
) -> Result<LocalMap, EmbedError> {
    let solved = smacof(pairs, &map.points, stop)?;
    Ok(LocalMap { points: solved.points, stress1: solved.stress1 })
}

/// Distance of two landmarks in the local maps of their cores, the mean where both know it; `None` if neither does.
pub(crate) fn length(cover: &RegionCover, maps: &[LocalMap], ends: [u32; 2]) -> Option<f64> {
    let own = |region: u32| {
        let members = &cover.regions()[region as usize].members;
        let [a, b] = ends.map(|end| members.binary_search(&end).ok());
        let points = &maps[region as usize].points;
        let ([ax, ay], [bx, by]) = (points[a?], points[b?]);
        Some((ax - bx).hypot(ay - by))
    };
    let [a, b] = ends.map(|end| own(cover.core_of()[end as usize]));
    match (a, b) {
        (Some(a), Some(b)) => Some(0.5 * (a + b)),
        _ => a.or(b),
    }
}

/// Classical scaling of the shortest-path lengths of a connected pair list.
pub(crate) fn path_scaling(pairs: &PairDistances) -> Result<Vec<Point>, EmbedError> {
    let paths = DistanceMatrix::from_pairs(pairs).metric_closure();
    Ok(classical_scaling(&paths.map(|length| length * length)?)?.points)
}

#[cfg(test)]
mod tests;
