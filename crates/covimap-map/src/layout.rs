//! The first map of a component: regions, each solved by itself, in one frame.
//!
//! # Algorithm
//! 1. Regions are mapped by themselves with the distances of the fixed logarithm. In a local map no wrong turn of
//!    the whole can make distances wrong, so that the distance function is learnt there first, and the local maps
//!    are brought to least stress under it.
//! 2. They are stitched. Regions at a hinge are widened to all landmarks that their cores are linked to, and solved
//!    and stitched once more: what more they share may decide the side.
//! 3. Where hinges are left, and they are many, the map is laid out in other ways as well, and each part of it comes from the way that
//!    has the least stress there ([`variants`](crate::variants)).

use covimap_embed::{DistanceFamily, Point, StopRule};
use rayon::prelude::*;

use crate::component::begin;
use crate::distances::{Distances, Law};
use crate::local_map::{self, LocalMap};
use crate::stitch::{Stitched, stitch};
use crate::{AutoParams, LinkGraph, MapError, Observer, Region, RegionCover, Silent, Stage, variants};

/// Steps by which a local map follows the law.
const FOLLOWING: StopRule = StopRule { max_iterations: 30, tolerance: 1e-6 };
/// Landmarks for each hinge that is borne: with fewer, other layouts are tried.
const BORNE: usize = 1000;

/// A component laid out, in map units.
pub(crate) struct Layout {
    pub cover: RegionCover,
    pub stitched: Stitched,
}

/// What a layout is made from.
pub(crate) struct Ground<'a> {
    pub graph: &'a LinkGraph,
    /// What a law can be learnt from; `None` for the fixed logarithm.
    pub distances: Option<&'a Distances<'a>>,
    pub params: &'a AutoParams,
    pub observer: &'a dyn Observer,
}

/// Lays a connected graph out.
pub(crate) fn lay_out(ground: &Ground) -> Result<Layout, MapError> {
    let Ground { graph, params, observer, .. } = *ground;
    begin(Stage::Regions, Some(2 * graph.landmarks() as u64), observer)?;
    let mut cover = RegionCover::watched(graph, params.regions, observer);
    observer.finished(Stage::Regions);

    begin(Stage::LocalMaps, Some(cover.regions().len() as u64), observer)?;
    let mut maps = ground.local_maps(&cover, None)?;
    let law = ground.law(&params.distance.families(), &cover, &maps);
    if let Some(law) = &law {
        maps = ground.followed(law, cover.regions(), maps)?;
    }
    observer.finished(Stage::LocalMaps);

    begin(Stage::Stitch, Some(2 * maps.len() as u64), observer)?;
    let mut stitched = stitch(graph, &cover, &maps, observer)?;
    let hinged = cover.widen(graph, &stitched.seams.hinges, params.regions);
    if !hinged.is_empty() {
        let wider = hinged.par_iter().map(|&region| ground.solved(law.as_ref(), &cover.regions()[region]));
        let wider: Vec<LocalMap> = wider.collect::<Result<_, _>>()?;
        hinged.iter().zip(wider).for_each(|(&region, map)| maps[region] = map);
        stitched = stitch(graph, &cover, &maps, observer)?;
    }
    observer.finished(Stage::Stitch);
    if let (Some(law), true) = (&law, stitched.seams.hinges.len() * BORNE > graph.landmarks()) {
        stitched = variants::least_stressed(ground, law, &cover, &maps, stitched)?;
    }
    Ok(Layout { cover, stitched })
}

impl Ground<'_> {
    /// The maps of the regions of another cover, stitched; tells of every region.
    pub fn laid_out_by(&self, law: &Law, cover: &RegionCover) -> Result<Vec<Point>, MapError> {
        let maps = self.local_maps(cover, Some(law))?;
        Ok(stitch(self.graph, cover, &maps, &Silent)?.points)
    }

    fn local_maps(&self, cover: &RegionCover, law: Option<&Law>) -> Result<Vec<LocalMap>, MapError> {
        let solve = |region: &Region| {
            let map = self.solved(law, region)?;
            self.observer.advanced(1);
            Ok(map)
        };
        cover.regions().par_iter().map(solve).collect()
    }

    fn law(&self, families: &[DistanceFamily], cover: &RegionCover, maps: &[LocalMap]) -> Option<Law> {
        self.distances.filter(|_| !families.is_empty())?.learn_locally(families, cover, maps)
    }

    fn followed(
        &self,
        law: &Law,
        regions: &[Region],
        maps: Vec<LocalMap>,
    ) -> Result<Vec<LocalMap>, MapError> {
        regions.par_iter().zip(maps).map(|(region, map)| self.following(law, region, map)).collect()
    }

    /// The map of a region; with a law, brought to least stress under it.
    fn solved(&self, law: Option<&Law>, region: &Region) -> Result<LocalMap, MapError> {
        if self.observer.interrupted() {
            return Err(MapError::Interrupted);
        }
        let map = local_map::solve(self.graph, region, self.params.local_stop.rule())?;
        match law {
            Some(law) => self.following(law, region, map),
            None => Ok(map),
        }
    }

    fn following(&self, law: &Law, region: &Region, map: LocalMap) -> Result<LocalMap, MapError> {
        let Some(distances) = self.distances else { return Ok(map) };
        let pairs = distances.inside(law, self.graph, &region.members, Some(&map.points));
        Ok(local_map::solve_again(&pairs, &map, FOLLOWING)?)
    }
}
