//! Contest: which way large parts of the map lie, decided by the stress along their borders.
//!
//! The evidence of single seams and pieces is wrong now and then, and where the robot has been little it is wrong in
//! many places that adjoin: a whole part of the map, beyond a line of twisted streets, then lies mirrored or not by the
//! balance of a few doubtful votes. How much a piece counts over a seam tips it. No sum of such votes is to be trusted
//! with that, but the stress along the whole border tells.
//!
//! # Algorithm
//! The sides of all regions are synchronised with several weights of pieces. The first result is the holder. In turn,
//! each of the others is a challenger: the regions of which it says otherwise than the holder fall into connected
//! parts. The border of a part, which is all pieces that it divides, is brought to least stress as both lay it out,
//! lifted and polished once more. If the two end near each other, the same is asked of all pieces that the border
//! reaches into: they vary less. If the challenger ends lower, the holder takes the part over.
//!
//! # Complexity
//! A synchronisation and a stitching of `O(n)` landmarks for each challenger, and twice the polish and lift of the
//! pieces at borders.

use covimap_embed::Point;
use petgraph::unionfind::UnionFind;
use rayon::prelude::*;

use super::witnesses::Witnesses;
use super::{PIECE, Trial};
use crate::stitch::Patchwork;
use crate::{MapError, RegionCover};

/// Evidence of a piece for how two of its regions lie to each other, of the holder and of the challengers: more than
/// seams of small regions have, which lie twisted now and then.
const EVIDENCE: [f64; 3] = [100.0, 1000.0, 10.0];
/// Logarithm of the ratio of two stresses of a border that decides. With the chances of the lift the stress of one and
/// the same border varies by half of this.
const CLEAR: f64 = 0.04;
/// Challengers.
pub(super) const CHALLENGES: usize = EVIDENCE.len() - 1;

/// Who and what takes part.
pub(super) struct Contest<'a> {
    pub trial: Trial<'a>,
    pub cover: &'a RegionCover,
    /// The maps of the regions of `cover`.
    pub patchwork: &'a Patchwork<'a>,
    pub pieces: &'a RegionCover,
    /// The maps of the pieces.
    pub of_pieces: &'a Patchwork<'a>,
    pub witnesses: &'a Witnesses,
}

impl Contest<'_> {
    /// Which regions lie mirrored, and the pieces stitched accordingly.
    pub fn settled(&self) -> Result<(Vec<bool>, Vec<Point>), MapError> {
        let laid_out = |evidence: &f64| {
            let sides = self.patchwork.sides(|a, b| evidence * self.witnesses.votes(a, b))?;
            let points = self.stitched(&sides)?;
            Ok((sides, points))
        };
        let all: Vec<_> = EVIDENCE.par_iter().map(laid_out).collect::<Result<_, MapError>>()?;
        let mut all = all.into_iter();
        let (mut sides, mut points) = all.next().expect("somebody holds (bug in covimap)");
        for (others, other_points) in all {
            let parts = self.parts_that_differ(&sides, &others);
            let wins = |part: &Vec<u32>| self.is_better(part, &points, &other_points);
            let won: Vec<bool> = parts.par_iter().map(wins).collect::<Result<_, _>>()?;
            let taken = parts.iter().zip(&won).filter(|(_, won)| **won).flat_map(|(part, _)| part);
            taken.for_each(|&region| sides[region as usize] ^= true);
            if won.contains(&true) {
                points = self.stitched(&sides)?;
            }
            self.trial.surveyor.observer.advanced(self.pieces.regions().len() as u64);
        }
        Ok((sides, points))
    }

    fn stitched(&self, sides: &[bool]) -> Result<Vec<Point>, MapError> {
        let sides = self.witnesses.pieces_by(self.cover, sides, self.pieces.regions().len());
        Ok(self.of_pieces.stitched_by(&sides)?.points)
    }

    /// The connected parts, no smaller than a piece, by which two opinions on the sides of regions differ; what is
    /// beyond them has the same sides, or all opposite ones.
    fn parts_that_differ(&self, one: &[bool], other: &[bool]) -> Vec<Vec<u32>> {
        let regions = self.cover.regions();
        let landmarks = |region: u32| regions[region as usize].core.len();
        let differ = |region: u32| one[region as usize] != other[region as usize];
        let all = 0..regions.len() as u32;
        let apart: usize = all.clone().filter(|&region| differ(region)).map(landmarks).sum();
        let most = 2 * apart > self.cover.core_of().len();
        let among = |region: u32| differ(region) != most;
        let mut joined = UnionFind::<u32>::new(regions.len());
        for (a, b) in self.patchwork.neighbours().filter(|&(a, b)| among(a) && among(b)) {
            joined.union(a, b);
        }
        let mut members: Vec<(u32, u32)> =
            all.filter(|&region| among(region)).map(|region| (joined.find(region), region)).collect();
        members.sort_unstable();
        let parts =
            members.chunk_by(|a, b| a.0 == b.0).map(|part| part.iter().map(|&(_, region)| region).collect());
        parts
            .filter(|part: &Vec<u32>| part.iter().map(|&region| landmarks(region)).sum::<usize>() >= PIECE[0])
            .collect()
    }

    /// Whether the border of a part ends with less stress from the layout `other` than from `one`.
    fn is_better(&self, part: &[u32], one: &[Point], other: &[Point]) -> Result<bool, MapError> {
        let divided = self.witnesses.divided_by(part, self.pieces.regions().len());
        let border = self.members(divided.into_iter());
        if border.is_empty() {
            return Ok(false);
        }
        let gain = |members: &[u32]| {
            let stress = |layout| Ok::<_, MapError>(self.trial.least_stressed(members, &[layout])?.stress1);
            Ok::<_, MapError>((stress(one)? / stress(other)?).ln())
        };
        let close = gain(&border)?;
        if close.abs() >= CLEAR {
            return Ok(close > 0.0);
        }
        let mut reached = vec![false; self.pieces.regions().len()];
        border.iter().for_each(|&member| reached[self.pieces.core_of()[member as usize] as usize] = true);
        let around = self.members((0..reached.len()).filter(|&piece| reached[piece]));
        Ok(gain(&around)? > 0.0)
    }

    /// The landmarks of some pieces, ascending.
    fn members(&self, pieces: impl Iterator<Item = usize>) -> Vec<u32> {
        let of_piece = |piece: usize| &self.pieces.regions()[piece].members;
        let mut members: Vec<u32> = pieces.flat_map(of_piece).copied().collect();
        members.sort_unstable();
        members.dedup();
        members
    }
}

#[cfg(test)]
mod tests;
