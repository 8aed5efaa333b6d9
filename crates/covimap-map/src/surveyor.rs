//! The surveyor: maps regions by themselves, and all regions of a cover.

use covimap_embed::{DistanceFamily, PairDistances, Point, StopRule, lift};
use rayon::prelude::*;

use crate::distances::{Distances, Law, Unseen};
use crate::local_map::{self, LocalMap};
use crate::stitch::Patchwork;
use crate::{AutoParams, LinkGraph, MapError, Observer, Region, RegionCover, Silent};

/// Steps by which a local map follows the law.
const FOLLOWING: StopRule = StopRule { max_iterations: 30, tolerance: 1e-6 };

/// What local maps are made from.
pub(crate) struct Surveyor<'a> {
    pub graph: &'a LinkGraph,
    /// What a law can be learnt from; `None` for the fixed logarithm.
    pub distances: Option<&'a Distances<'a>>,
    pub params: &'a AutoParams,
    /// Seed of all chances.
    pub seed: u64,
    pub observer: &'a dyn Observer,
}

impl Surveyor<'_> {
    /// The maps of the regions of another cover, stitched; tells of every region.
    pub fn laid_out_by(&self, law: &Law, cover: &RegionCover) -> Result<Vec<Point>, MapError> {
        let maps = self.local_maps(cover, Some(law))?;
        Ok(Patchwork::new(self.graph, cover, &maps, &Silent).stitched()?.points)
    }

    /// The maps of all regions; tells of every region.
    pub fn local_maps(&self, cover: &RegionCover, law: Option<&Law>) -> Result<Vec<LocalMap>, MapError> {
        let solve = |region: &Region| {
            let map = self.solved(law, region)?;
            self.observer.advanced(1);
            Ok(map)
        };
        cover.regions().par_iter().map(solve).collect()
    }

    /// What the local maps tell of the distance function, if they tell anything.
    pub fn law(&self, families: &[DistanceFamily], cover: &RegionCover, maps: &[LocalMap]) -> Option<Law> {
        self.distances.filter(|_| !families.is_empty())?.learn_locally(families, cover, maps)
    }

    /// Local maps brought to least stress under a law.
    pub fn followed(
        &self,
        law: &Law,
        regions: &[Region],
        maps: Vec<LocalMap>,
    ) -> Result<Vec<LocalMap>, MapError> {
        regions.par_iter().zip(maps).map(|(region, map)| self.following(law, region, map)).collect()
    }

    /// The map of a region; with a law, brought to least stress under it.
    pub fn solved(&self, law: Option<&Law>, region: &Region) -> Result<LocalMap, MapError> {
        if self.observer.interrupted() {
            return Err(MapError::Interrupted);
        }
        let map = local_map::solve(self.graph, region, self.params.local_stop.rule())?;
        match law {
            Some(law) => self.following(law, region, map),
            None => Ok(map),
        }
    }

    /// A map with its twists taken out: it untwists in four dimensions and is pressed flat again ([`lift`]). Landmarks
    /// that were never seen together, although each was seen often, are kept apart meanwhile: a twist lays them over
    /// each other. `stepped` is called before every step.
    pub fn lifted(
        &self,
        pairs: &PairDistances,
        start: &[Point],
        unseen: &Unseen,
        stepped: impl Fn(),
    ) -> Result<Vec<Point>, MapError> {
        let go_on = || {
            stepped();
            !self.observer.interrupted()
        };
        let points = lift(pairs, start, unseen, self.seed, go_on)?;
        if self.observer.interrupted() { Err(MapError::Interrupted) } else { Ok(points) }
    }

    fn following(&self, law: &Law, region: &Region, map: LocalMap) -> Result<LocalMap, MapError> {
        let Some(distances) = self.distances else { return Ok(map) };
        let pairs = distances.inside(law, self.graph, &region.members, Some(&map.points));
        Ok(local_map::solve_again(&pairs, &map, FOLLOWING)?)
    }
}
