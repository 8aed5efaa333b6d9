//! The first map of a component: regions, each solved by itself, in one frame.
//!
//! # Algorithm
//! 1. Regions are mapped by themselves with the distances of the fixed logarithm. In a local map no wrong turn of
//!    the whole can make distances wrong, so that the distance function is learnt there first, and the local maps
//!    are brought to least stress under it.
//! 2. They are stitched. Regions at a hinge are widened to all landmarks that their cores are linked to, and solved
//!    and stitched once more: what more they share may decide the side.
//! 3. Where hinges are left, the map is laid out in other ways as well, and each part of it comes from the way that has
//!    the least stress there ([`variants`](crate::variants)). Then twists are taken out of the whole.

use covimap_embed::{LIFT_STEPS, Point};
use rayon::prelude::*;

use crate::distances::Law;
use crate::local_map::LocalMap;
use crate::progress::begin;
use crate::stitch::{Patchwork, Stitched};
use crate::surveyor::Surveyor;
use crate::variants::{self, Effort};
use crate::{MapError, RegionCover, Stage};

/// Landmarks for each hinge with which doubts are few.
const BORNE: usize = 1000;

/// A component laid out, in map units.
pub(crate) struct Layout {
    pub cover: RegionCover,
    pub stitched: Stitched,
    /// Whether twists were taken out.
    pub untwisted: bool,
}

/// Lays a connected graph out.
pub(crate) fn lay_out(surveyor: &Surveyor) -> Result<Layout, MapError> {
    let Surveyor { graph, params, observer, .. } = *surveyor;
    begin(Stage::Regions, Some(2 * graph.landmarks() as u64), observer)?;
    let mut cover = RegionCover::watched(graph, params.regions, observer);
    observer.finished(Stage::Regions);

    begin(Stage::LocalMaps, Some(cover.regions().len() as u64), observer)?;
    let mut maps = surveyor.local_maps(&cover, None)?;
    let law = surveyor.law(&params.distance.families(), &cover, &maps);
    if let Some(law) = &law {
        maps = surveyor.followed(law, cover.regions(), maps)?;
    }
    observer.finished(Stage::LocalMaps);

    begin(Stage::Stitch, Some(2 * maps.len() as u64), observer)?;
    let mut stitched = Patchwork::new(graph, &cover, &maps, observer).stitched()?;
    let hinged = cover.widen(graph, &stitched.seams.hinges, params.regions);
    if !hinged.is_empty() {
        let wider = hinged.par_iter().map(|&region| surveyor.solved(law.as_ref(), &cover.regions()[region]));
        let wider: Vec<LocalMap> = wider.collect::<Result<_, _>>()?;
        hinged.iter().zip(wider).for_each(|(&region, map)| maps[region] = map);
        stitched = Patchwork::new(graph, &cover, &maps, observer).stitched()?;
    }
    observer.finished(Stage::Stitch);
    let hinges = stitched.seams.hinges.len();
    let thin = hinges * BORNE > graph.landmarks();
    let law = law.filter(|_| hinges > 0);
    if let Some(law) = &law {
        let effort = if thin { Effort::MANY_DOUBTS } else { Effort::FEW_DOUBTS };
        stitched = variants::least_stressed(surveyor, law, &cover, &maps, stitched, effort)?;
        stitched.points = untwisted(surveyor, law, &stitched.points)?;
    }
    Ok(Layout { cover, stitched, untwisted: law.is_some() })
}

/// The whole, lifted under a law.
fn untwisted(surveyor: &Surveyor, law: &Law, points: &[Point]) -> Result<Vec<Point>, MapError> {
    begin(Stage::Lift, Some(LIFT_STEPS as u64), surveyor.observer)?;
    let distances = surveyor.distances.expect("who has a law has learnt it (bug in covimap)");
    let pairs = distances.measure(law, None).pairs;
    let stepped = || surveyor.observer.advanced(1);
    let points = surveyor.lifted(&pairs, points, &distances.unseen(law), stepped)?;
    surveyor.observer.finished(Stage::Lift);
    Ok(points)
}
