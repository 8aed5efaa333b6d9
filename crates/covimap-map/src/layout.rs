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
//! 4. A part can lie folded although all seams are sure, by links that are few but agree. Components without a hinge that are
//!    not large are therefore laid out in other ways, too, and that layout is taken if it ends with clearly less stress.

use covimap_embed::{LIFT_STEPS, Newton, Point, StopRule};
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

/// Most landmarks of a component that is laid out in other ways as well though it has no hinge.
const SMALL: usize = 10_000;
/// Most landmarks of a component on which every effort is spent: it takes less than a second.
const VERY_SMALL: usize = 3_000;
/// Share of the stress by which the second layout must be better then.
const CLEAR: f64 = 0.005;
/// The polish by which layouts are judged.
const POLISH: StopRule = StopRule { max_iterations: 12, tolerance: 1e-5 };

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
    let doubtful = hinges * BORNE > graph.landmarks() || graph.landmarks() <= VERY_SMALL;
    let mut untwisted = false;
    if let Some(law) = law.filter(|_| hinges > 0 || graph.landmarks() <= SMALL) {
        let effort = if doubtful { Effort::MANY_DOUBTS } else { Effort::FEW_DOUBTS };
        let mut other = variants::least_stressed(surveyor, &law, &cover, &maps, &stitched.points, effort)?;
        other.points = lifted(surveyor, &law, &other.points)?;
        if hinges > 0 || is_clearly_better(surveyor, &law, &other.points, &stitched.points)? {
            (stitched, untwisted) = (other, true);
        }
    }
    Ok(Layout { cover, stitched, untwisted })
}

/// Whether a layout ends with clearly less stress than another one. Of two ways to the same minimum the first is kept: lifting
/// bends corridors.
fn is_clearly_better(
    surveyor: &Surveyor,
    law: &Law,
    layout: &[Point],
    other: &[Point],
) -> Result<bool, MapError> {
    let distances = surveyor.distances.expect("who has a law has learnt it (bug in covimap)");
    let pairs = distances.measure(law, None).pairs;
    let mut newton = Newton::new(&pairs);
    let mut stress = |layout| {
        let polished = newton.minimise(&pairs, layout, POLISH, || !surveyor.observer.interrupted())?;
        Ok::<_, MapError>(polished.stress1.powi(2))
    };
    let (a, b) = (stress(layout)?, stress(other)?);
    Ok(a < (1.0 - CLEAR) * b)
}

/// The whole, lifted under a law.
fn lifted(surveyor: &Surveyor, law: &Law, points: &[Point]) -> Result<Vec<Point>, MapError> {
    begin(Stage::Lift, Some(LIFT_STEPS as u64), surveyor.observer)?;
    let distances = surveyor.distances.expect("who has a law has learnt it (bug in covimap)");
    let pairs = distances.measure(law, None).pairs;
    let stepped = || surveyor.observer.advanced(1);
    let points = surveyor.lifted(&pairs, points, &distances.unseen(law), stepped)?;
    surveyor.observer.finished(Stage::Lift);
    Ok(points)
}
