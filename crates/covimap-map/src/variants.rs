//! Variants: a map laid out in several ways, of which every part takes the best.
//!
//! Which side of a weak place is which, and whether a street lies twisted in its local map, regions of different sizes
//! decide differently, and each decides a few of them wrongly. Nothing in one layout tells which: a twist that costs
//! no stress nearby costs it where streets meet again. So the map is cut into pieces that are large enough for
//! streets to meet in them, each piece is brought to least stress from every layout, and keeps the best.
//!
//! What is wrong in all of them, [lifting](covimap_embed::lift()) may turn round.
//!
//! # Algorithm
//! 1. The graph is covered by regions of other sizes as well; their local maps, under the same law, are stitched
//!    to one more layout each.
//! 2. Pieces of some hundred landmarks, which overlap like regions, are polished from every layout, all under the
//!    same distances and with nothing around them. That of least stress is lifted and polished once more; the better of
//!    both stays.
//! 3. Every piece is a witness of how the regions of the first cover lie to each other, with more weight than the seams
//!    of these; synchronisation decides their sides anew, and those of the pieces with them. The pieces are stitched by
//!    these sides.
//!
//! # Complexity
//! For each layout that of the first one, and a polish of `O(n)` landmarks in pieces of bounded size and a lift of
//! these.

use covimap_embed::{Correspondence, Newton, Point, ProcrustesOptions, Reflection, StopRule, procrustes};
use rayon::prelude::*;

use crate::distances::{Law, Unseen};
use crate::local_map::LocalMap;
use crate::progress::begin;
use crate::stitch::{Stitched, sides, stitch_by_sides};
use crate::surveyor::Surveyor;
use crate::{MapError, Region, RegionCover, RegionParams, Stage};

/// Landmarks in the cores of the other covers.
const CORES: [usize; 2] = [25, 50];
/// Most members of a region over its core.
const MEMBERS: usize = 10;
/// Landmarks in the core of a piece, and its members at most.
const PIECE: [usize; 2] = [400, 1600];
/// Evidence of a piece for how two of its regions lie to each other: more than seams of small regions have, which lie
/// twisted now and then.
const EVIDENCE: f64 = 100.0;
/// How a piece is polished.
const POLISH: StopRule = StopRule { max_iterations: 12, tolerance: 1e-5 };

/// The best of the layout `first`, which the maps of `cover` were stitched to, and of others.
///
/// Seams are reported as the regions of `cover` have them, with the sides that they have in the result.
pub(crate) fn least_stressed(
    surveyor: &Surveyor,
    law: &Law,
    cover: &RegionCover,
    maps: &[LocalMap],
    first: Stitched,
) -> Result<Stitched, MapError> {
    let distances = surveyor.distances.expect("who has a law has learnt it (bug in covimap)");
    let cut = |core, members| {
        RegionCover::new(surveyor.graph, RegionParams { core, members, ..surveyor.params.regions })
    };
    let covers = CORES.map(|core| cut(core, MEMBERS * core));
    let pieces = cut(PIECE[0], PIECE[1]);
    let maps_of_pieces = (covers.len() + 2) * pieces.regions().len();
    let regions: usize = covers.iter().map(|cover| cover.regions().len()).sum();
    begin(Stage::Variants, Some((regions + maps_of_pieces) as u64), surveyor.observer)?;
    let mut layouts = vec![first.points];
    for cover in &covers {
        layouts.push(surveyor.laid_out_by(law, cover)?);
    }
    let unseen = distances.unseen(law);
    let best = |piece: &Region| best_map(surveyor, law, piece, &layouts, &unseen);
    let best: Vec<LocalMap> = pieces.regions().par_iter().map(best).collect::<Result<_, _>>()?;
    let lie = Lie::of(cover, maps, &pieces, &best);
    let mirrored = sides(surveyor.graph, cover, maps, |a, b| lie.votes(a, b))?;
    let of_pieces = lie.pieces_by(cover, &mirrored, best.len());
    let points = stitch_by_sides(surveyor.graph, &pieces, &best, &of_pieces)?.points;
    surveyor.observer.finished(Stage::Variants);
    Ok(Stitched { points, ..stitch_by_sides(surveyor.graph, cover, maps, &mirrored)? })
}

/// How regions lie in pieces: the pieces that hold the core of each region, ascending, and whether its map lies
/// mirrored in theirs.
struct Lie(Vec<Vec<(u32, bool)>>);

impl Lie {
    fn of(cover: &RegionCover, maps: &[LocalMap], pieces: &RegionCover, best: &[LocalMap]) -> Self {
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

    /// The evidence of all pieces that hold two regions for their equal handedness.
    fn votes(&self, a: u32, b: u32) -> f64 {
        let [a, b] = [a, b].map(|region| &self.0[region as usize]);
        let vote = |&(piece, mirrored): &(u32, bool)| {
            let other = b.binary_search_by_key(&piece, |lie| lie.0).ok()?;
            Some(if b[other].1 == mirrored { EVIDENCE } else { -EVIDENCE })
        };
        a.iter().filter_map(vote).sum()
    }

    /// Which pieces lie mirrored, by what is known of most of their landmarks.
    fn pieces_by(&self, cover: &RegionCover, mirrored: &[bool], pieces: usize) -> Vec<bool> {
        let mut votes = vec![0; pieces];
        for ((region, lies), &own) in cover.regions().iter().zip(&self.0).zip(mirrored) {
            let size = region.core.len() as i64;
            for &(piece, within) in lies {
                votes[piece as usize] += if own == within { -size } else { size };
            }
        }
        votes.iter().map(|&votes| votes > 0).collect()
    }
}

/// The map of a piece from the layout that leads to the least stress, or that one lifted if it is better.
fn best_map(
    surveyor: &Surveyor,
    law: &Law,
    piece: &Region,
    layouts: &[Vec<Point>],
    unseen: &Unseen,
) -> Result<LocalMap, MapError> {
    let distances = surveyor.distances.expect("who has a law has learnt it (bug in covimap)");
    let pairs = distances.inside(law, surveyor.graph, &piece.members, None);
    let mut newton = Newton::new(&pairs);
    let mut polished = |start: &[Point]| {
        if surveyor.observer.interrupted() {
            return Err(MapError::Interrupted);
        }
        let map = newton.minimise(&pairs, start, POLISH, || true)?;
        surveyor.observer.advanced(1);
        Ok(LocalMap { points: map.points, stress1: map.stress1 })
    };
    let better = |a: LocalMap, b: LocalMap| if b.stress1 < a.stress1 { b } else { a };
    let mut from = |layout: &Vec<Point>| {
        let start: Vec<Point> = piece.members.iter().map(|&member| layout[member as usize]).collect();
        polished(&start)
    };
    let maps: Vec<LocalMap> = layouts.iter().map(&mut from).collect::<Result<_, _>>()?;
    let best = maps.into_iter().reduce(better).expect("there is the first layout (bug in covimap)");
    let start = surveyor.lifted(&pairs, &best.points, &unseen.among(&piece.members), || ())?;
    Ok(better(best, polished(&start)?))
}

#[cfg(test)]
mod tests;
