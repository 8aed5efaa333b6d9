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
//!    same distances and with nothing around them. Where doubts are many, that of least stress is lifted and polished once more; the
//!    better of both stays.
//! 3. Every piece is a [witness](witnesses) of how the regions of the first cover lie to each other, and a
//!    [contest](contest) decides the sides of regions, and those of the pieces with them. The pieces are stitched by
//!    these sides.
//!
//! # Complexity
//! For each layout that of the first one, a polish of `O(n)` landmarks in pieces of bounded size and a lift of
//! these, and the contest.

use covimap_embed::{Newton, Point, StopRule};
use rayon::prelude::*;

use crate::distances::{Law, Unseen};
use crate::local_map::LocalMap;
use crate::progress::begin;
use crate::stitch::{Patchwork, Stitched};
use crate::surveyor::Surveyor;
use crate::{MapError, Region, RegionCover, RegionParams, Silent, Stage};

mod contest;
mod witnesses;

use contest::{CHALLENGES, Contest};
use witnesses::Witnesses;

/// What is done to find the parts that are wrong.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Effort {
    /// Landmarks in the cores of each of the other covers.
    cores: &'static [usize],
    /// Whether every piece is lifted.
    lifted: bool,
}

impl Effort {
    /// Where hinges are far between: nearly all pieces are right in one of two layouts.
    pub const FEW_DOUBTS: Self = Self { cores: &[50], lifted: false };
    /// Where they are not.
    pub const MANY_DOUBTS: Self = Self { cores: &[25, 50], lifted: true };
}

/// Most members of a region over its core.
const MEMBERS: usize = 10;
/// Landmarks in the core of a piece, and its members at most.
const PIECE: [usize; 2] = [400, 1600];
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
    first: &[Point],
    effort: Effort,
) -> Result<Stitched, MapError> {
    let Surveyor { graph, observer, .. } = *surveyor;
    let distances = surveyor.distances.expect("who has a law has learnt it (bug in covimap)");
    let cut =
        |core, members| RegionCover::new(graph, RegionParams { core, members, ..surveyor.params.regions });
    let covers: Vec<RegionCover> = effort.cores.iter().map(|&core| cut(core, MEMBERS * core)).collect();
    let pieces = cut(PIECE[0], PIECE[1]);
    let maps_of_pieces = (covers.len() + 2 + CHALLENGES) * pieces.regions().len();
    let regions: usize = covers.iter().map(|cover| cover.regions().len()).sum();
    begin(Stage::Variants, Some((regions + maps_of_pieces) as u64), observer)?;
    let others = covers.iter().map(|cover| surveyor.laid_out_by(law, cover));
    let others: Vec<Vec<Point>> = others.collect::<Result<_, _>>()?;
    let layouts: Vec<&[Point]> = [first].into_iter().chain(others.iter().map(Vec::as_slice)).collect();
    let lifted = effort.lifted;
    let trial = Trial { surveyor, law, lifted, unseen: &distances.unseen(law) };
    let best = |piece: &Region| {
        let map = trial.least_stressed(&piece.members, &layouts)?;
        observer.advanced(covers.len() as u64 + 2);
        Ok::<_, MapError>(map)
    };
    let best: Vec<LocalMap> = pieces.regions().par_iter().map(best).collect::<Result<_, _>>()?;
    let patchwork = Patchwork::new(graph, cover, maps, &Silent);
    let contest = Contest {
        trial,
        cover,
        patchwork: &patchwork,
        pieces: &pieces,
        of_pieces: &Patchwork::new(graph, &pieces, &best, &Silent),
        witnesses: &Witnesses::new(cover, maps, &pieces, &best),
    };
    let (sides, points) = contest.settled()?;
    observer.finished(Stage::Variants);
    Ok(Stitched { points, ..patchwork.stitched_by(&sides)? })
}

/// Parts of the map by themselves, under the same law.
struct Trial<'a> {
    surveyor: &'a Surveyor<'a>,
    law: &'a Law,
    lifted: bool,
    unseen: &'a Unseen<'a>,
}

impl Trial<'_> {
    /// The map of some landmarks from the layout that leads to the least stress, or that one lifted if
    /// it is better.
    fn least_stressed(&self, members: &[u32], layouts: &[&[Point]]) -> Result<LocalMap, MapError> {
        let Self { surveyor, law, lifted, unseen } = *self;
        let distances = surveyor.distances.expect("who has a law has learnt it (bug in covimap)");
        let pairs = distances.inside(law, surveyor.graph, members, None);
        let mut newton = Newton::new(&pairs);
        let mut polished = |start: &[Point]| {
            if surveyor.observer.interrupted() {
                return Err(MapError::Interrupted);
            }
            let map = newton.minimise(&pairs, start, POLISH, || true)?;
            Ok(LocalMap { points: map.points, stress1: map.stress1 })
        };
        let better = |a: LocalMap, b: LocalMap| if b.stress1 < a.stress1 { b } else { a };
        let mut from = |layout: &&[Point]| {
            let start: Vec<Point> = members.iter().map(|&member| layout[member as usize]).collect();
            polished(&start)
        };
        let maps: Vec<LocalMap> = layouts.iter().map(&mut from).collect::<Result<_, _>>()?;
        let best = maps.into_iter().reduce(better).expect("there is a layout (bug in covimap)");
        if !lifted {
            return Ok(best);
        }
        let start = surveyor.lifted(&pairs, &best.points, &unseen.among(members), || ())?;
        Ok(better(best, polished(&start)?))
    }
}
