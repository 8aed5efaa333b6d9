//! Witnesses: what the maps of pieces tell of the regions that lie in them.

use covimap_embed::{Correspondence, Point, ProcrustesOptions, Reflection, procrustes};
use rayon::prelude::*;

use crate::local_map::LocalMap;
use crate::{Region, RegionCover};

/// How regions lie in pieces: the pieces that hold the core of each region, ascending, and whether its map lies
/// mirrored in theirs.
pub(super) struct Witnesses(Vec<Vec<(u32, bool)>>);

impl Witnesses {
    pub fn new(cover: &RegionCover, maps: &[LocalMap], pieces: &RegionCover, best: &[LocalMap]) -> Self {
        let mut pieces_of = vec![Vec::new(); cover.core_of().len()];
        for (piece, region) in pieces.regions().iter().enumerate() {
            region.members.iter().for_each(|&member| pieces_of[member as usize].push(piece));
        }
        let in_piece = |region: &Region, map: &LocalMap, piece: usize| {
            let members = &pieces.regions()[piece].members;
            if region.core.iter().any(|member| members.binary_search(member).is_err()) {
                return None;
            }
            let pair = |(member, &source): (&u32, &Point)| {
                let place = members.binary_search(member).ok()?;
                Some(Correspondence { source, target: best[piece].points[place], weight: 1.0 })
            };
            let pairs: Vec<Correspondence> =
                region.members.iter().zip(&map.points).filter_map(pair).collect();
            let options = ProcrustesOptions { scale: false, reflection: Reflection::Allow };
            let fit = procrustes(&pairs, options).ok()?;
            Some((piece as u32, fit.target_from_source.mirrored))
        };
        let of_region = |(region, map): (&Region, &LocalMap)| {
            let pieces = pieces_of[region.core[0] as usize].iter();
            pieces.filter_map(|&piece| in_piece(region, map, piece)).collect()
        };
        Self(cover.regions().par_iter().zip(maps).map(of_region).collect())
    }

    /// How many more pieces hold two regions with equal handedness than with opposite.
    pub fn votes(&self, a: u32, b: u32) -> f64 {
        let [a, b] = [a, b].map(|region| &self.0[region as usize]);
        let vote = |&(piece, mirrored): &(u32, bool)| {
            let other = b.binary_search_by_key(&piece, |lie| lie.0).ok()?;
            Some(if b[other].1 == mirrored { 1.0 } else { -1.0 })
        };
        a.iter().filter_map(vote).sum()
    }

    /// Which of `pieces` pieces lie mirrored, by what is known of most of their landmarks.
    pub fn pieces_by(&self, cover: &RegionCover, mirrored: &[bool], pieces: usize) -> Vec<bool> {
        let mut votes = vec![0; pieces];
        for ((region, lies), &own) in cover.regions().iter().zip(&self.0).zip(mirrored) {
            let size = region.core.len() as i64;
            for &(piece, within) in lies {
                votes[piece as usize] += if own == within { -size } else { size };
            }
        }
        votes.iter().map(|&votes| votes > 0).collect()
    }

    /// The pieces, of `pieces`, that hold regions of `part` (ascending) as well as others, ascending.
    pub fn divided_by(&self, part: &[u32], pieces: usize) -> Vec<usize> {
        let mut holds = vec![[false; 2]; pieces];
        for (region, lies) in self.0.iter().enumerate() {
            let inside = part.binary_search(&(region as u32)).is_ok();
            lies.iter().for_each(|&(piece, _)| holds[piece as usize][usize::from(inside)] = true);
        }
        (0..pieces).filter(|&piece| holds[piece] == [true; 2]).collect()
    }
}

#[cfg(test)]
mod tests;
