//! Local maps: every region solved by itself.
//!
//! Inside a region nearly every landmark was seen with nearly every other, or is one landmark
//! away from it, so that path lengths are fair guesses of the distances that are unknown. They
//! serve for the start only; the map itself is fitted to known distances.

use covimap_embed::{DistanceMatrix, EmbedError, PairDistances, Point, StopRule, classical_scaling, smacof};

use crate::{LinkGraph, Region};

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

/// Classical scaling of the shortest-path lengths of a connected pair list.
pub(crate) fn path_scaling(pairs: &PairDistances) -> Result<Vec<Point>, EmbedError> {
    let paths = DistanceMatrix::from_pairs(pairs).metric_closure();
    Ok(classical_scaling(&paths.map(|length| length * length)?)?.points)
}

#[cfg(test)]
mod tests;
