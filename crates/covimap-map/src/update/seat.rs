//! First places for landmarks that have none, in the frames of the old charts.
//!
//! Every component keeps the frame of the old chart that most of its landmarks are of. The rest of it - landmarks that
//! are new, and small charts that new links tie to it - is cut into connected *pieces*; a piece and the placed
//! landmarks around it are mapped by the ordinary stages and laid onto those placed landmarks, in the handedness that
//! fits better. A large chart that new links tie to another one is not taken apart: a piece is made of the
//! landmarks at the ends of these links, and the chart is carried by what it shares with the piece.
//!
//! Components without an old chart of three landmarks are left to the ordinary stages alone.

use covimap_embed::{Correspondence, Point};
use rayon::prelude::*;

use super::Joined;
use super::draft::{Draft, NOWHERE};
use super::fit::Fit;
use crate::layout::{Layout, lay_out};
use crate::progress::begin;
use crate::surveyor::Surveyor;
use crate::{MapError, MapperParams, Observer, RegionCover, Stage};

/// Fewest landmarks of a chart whose frame is worth keeping.
const FEWEST: usize = 3;

/// A part of a component that is mapped by itself.
struct Piece {
    /// Without a place, or at the end of a link between two charts; ascending.
    core: Vec<u32>,
    /// The core, and the placed landmarks that it is linked to; ascending.
    members: Vec<u32>,
    /// Of the members, in a frame of its own.
    points: Vec<Point>,
    cover: RegionCover,
}

/// Gives a place to every landmark of the components that keep an old frame.
pub(super) fn seat(joined: &Joined, draft: &mut Draft, observer: &dyn Observer) -> Result<(), MapError> {
    for number in 0..joined.components.len() {
        choose_base(joined, draft, number);
    }
    let cores = cores(joined, draft);
    begin(Stage::LocalMaps, Some(cores.len() as u64), observer)?;
    let solve = |core: Vec<u32>| {
        let piece = solve(joined, draft, core, observer)?;
        observer.advanced(1);
        Ok(piece)
    };
    let pieces = cores.into_par_iter().map(solve).collect::<Result<Vec<Piece>, MapError>>()?;
    observer.finished(Stage::LocalMaps);
    carry_charts(draft, &pieces);
    for piece in &pieces {
        lay(joined, draft, piece);
    }
    Ok(())
}

/// Chooses the chart whose frame a component keeps, and decides which others are carried and which solved anew.
fn choose_base(joined: &Joined, draft: &mut Draft, number: usize) {
    let members = &joined.components[number];
    let mut charts: Vec<u32> = members
        .iter()
        .map(|&member| draft.chart_of[member as usize])
        .filter(|&chart| chart != NOWHERE)
        .collect();
    charts.sort_unstable();
    let sizes: Vec<(u32, usize)> = charts.chunk_by(|a, b| a == b).map(|same| (same[0], same.len())).collect();
    let base = sizes.iter().rev().max_by_key(|size| size.1).filter(|size| size.1 >= FEWEST);
    draft.base[number] = base.map(|base| base.0);
    let carried = |chart: u32| {
        sizes.iter().any(|size| size.0 == chart && size.1 > joined.params().auto.regions.members)
    };
    let stays = |chart: u32| base.is_some_and(|base| base.0 == chart || carried(chart));
    for &member in members {
        let chart = &mut draft.chart_of[member as usize];
        if *chart != NOWHERE && !stays(*chart) {
            *chart = NOWHERE;
        }
    }
}

/// The connected parts of what has no place in components with a base, and of the ends of links between charts.
fn cores(joined: &Joined, draft: &mut Draft) -> Vec<Vec<u32>> {
    for landmark in 0..joined.landmarks() as u32 {
        if draft.base[joined.component_of[landmark as usize] as usize].is_none() {
            continue;
        }
        let own = draft.chart_of[landmark as usize];
        let across =
            |to: u32| !matches!(draft.chart_of[to as usize], other if other == NOWHERE || other == own);
        draft.free[landmark as usize] =
            own == NOWHERE || joined.graph.of(landmark).iter().any(|link| across(link.to));
    }
    let mut left = draft.free.clone();
    let mut cores = Vec::new();
    for first in 0..joined.landmarks() as u32 {
        if !std::mem::replace(&mut left[first as usize], false) {
            continue;
        }
        let mut core = vec![first];
        let mut next = 0;
        while next < core.len() {
            for link in joined.graph.of(core[next]) {
                if std::mem::replace(&mut left[link.to as usize], false) {
                    core.push(link.to);
                }
            }
            next += 1;
        }
        core.sort_unstable();
        cores.push(core);
    }
    cores
}

/// Looks for requests to stop, and tells of nothing: pieces are many and small.
struct Quiet<'a>(&'a dyn Observer);

impl Observer for Quiet<'_> {
    fn interrupted(&self) -> bool {
        self.0.interrupted()
    }
}

/// Maps a core and the placed landmarks around it.
fn solve(joined: &Joined, draft: &Draft, core: Vec<u32>, observer: &dyn Observer) -> Result<Piece, MapError> {
    let linked = core.iter().flat_map(|&landmark| joined.graph.of(landmark)).map(|link| link.to);
    let mut members: Vec<u32> = linked.filter(|&to| draft.chart_of[to as usize] != NOWHERE).collect();
    members.extend_from_slice(&core);
    members.sort_unstable();
    members.dedup();
    let graph = joined.graph.restricted_to(&members);
    let MapperParams { auto, seed, .. } = joined.params();
    let observer = Quiet(observer);
    let surveyor =
        Surveyor { graph: &graph, distances: None, params: auto, seed: *seed, observer: &observer };
    let Layout { cover, stitched, .. } = lay_out(&surveyor)?;
    Ok(Piece { core, members, points: stitched.points, cover })
}

/// Carries charts into the frame of the base of their component, one after the other, each by the piece that
/// shares most with what is in that frame already.
fn carry_charts(draft: &mut Draft, pieces: &[Piece]) {
    loop {
        let shared = |piece: &Piece| {
            let anchors = piece.anchors(draft);
            let open = anchors.iter().any(|&(_, landmark)| !draft.is_framed(landmark));
            open.then(|| anchors.iter().filter(|&&(_, landmark)| draft.is_framed(landmark)).count())
        };
        let best =
            pieces.iter().filter_map(|piece| Some((shared(piece)?, piece))).rev().max_by_key(|best| best.0);
        let Some((_, piece)) = best.filter(|best| best.0 > 0) else { break };
        let base_from_piece = piece.fit(draft);
        let anchors = piece.anchors(draft);
        let (framed, open): (Vec<_>, Vec<_>) =
            anchors.into_iter().partition(|&(_, landmark)| draft.is_framed(landmark));
        let chart = |&(_, landmark): &(usize, u32)| draft.chart_of[landmark as usize];
        let mut open: Vec<(u32, (usize, u32))> = open.iter().map(|anchor| (chart(anchor), *anchor)).collect();
        open.sort_unstable();
        for shared in open.chunk_by(|a, b| a.0 == b.0) {
            let pair = |&(_, (place, landmark)): &(u32, (usize, u32))| Correspondence {
                source: draft.polished[landmark as usize],
                target: base_from_piece.similarity.apply(piece.points[place]),
                weight: 1.0,
            };
            let base_from_chart = Fit::of(&shared.iter().map(pair).collect::<Vec<_>>());
            draft.carry(shared[0].1.1, framed[0].1, &base_from_chart, base_from_piece.evidence);
        }
    }
}

/// Lays a piece onto the placed landmarks around it.
fn lay(joined: &Joined, draft: &mut Draft, piece: &Piece) {
    let fit = piece.fit(draft);
    for (&landmark, &point) in piece.members.iter().zip(&piece.points) {
        if draft.chart_of[landmark as usize] == NOWHERE {
            draft.polished[landmark as usize] = fit.similarity.apply(point);
        }
    }
    let fresh: Vec<u32> =
        piece.core.iter().copied().filter(|&l| draft.chart_of[l as usize] == NOWHERE).collect();
    if fresh.len() < joined.params().auto.regions.core {
        draft.join_regions(&joined.graph, &fresh);
    } else {
        let region = |landmark: u32| {
            let place = piece.members.binary_search(&landmark).expect("the core is in (bug in covimap)");
            piece.cover.core_of()[place]
        };
        draft.open_regions(&joined.graph, &fresh, region, &fit);
    }
}

impl Piece {
    /// Placed landmarks, each behind its place among the members.
    fn anchors(&self, draft: &Draft) -> Vec<(usize, u32)> {
        let placed = |(_, landmark): &(usize, u32)| draft.chart_of[*landmark as usize] != NOWHERE;
        self.members.iter().copied().enumerate().filter(placed).collect()
    }

    /// Where the piece lies in the frame of its component, by the landmarks that are in that frame already.
    fn fit(&self, draft: &Draft) -> Fit {
        let framed = self.anchors(draft).into_iter().filter(|&(_, landmark)| draft.is_framed(landmark));
        let pairs: Vec<Correspondence> = framed
            .map(|(place, landmark)| Correspondence {
                source: self.points[place],
                target: draft.polished[landmark as usize],
                weight: 1.0,
            })
            .collect();
        Fit::of(&pairs)
    }
}
