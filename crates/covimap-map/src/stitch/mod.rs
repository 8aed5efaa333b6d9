//! Stitching: local maps into one frame.
//!
//! # Algorithm
//! 1. Every two regions that share landmarks give a seam: where one lies in the frame of the other,
//!    for either handedness, and the evidence for one of them ([`seams`]).
//! 2. Synchronisation over the graph of regions and seams decides handedness, turn and shift of
//!    every region, and sets aside seams that contradict the rest.
//! 3. A landmark goes to the weighted mean of its places in the regions it belongs to; the region
//!    whose core it is counts most, for there it was seen from all sides.
//!
//! 4. Regions whose sides are sure among themselves make a branch; what joins two branches is a hinge
//!    ([`branches`]).
//!
//! Scales stay as they are: all local maps measure in the same unit.

mod branches;
mod seams;

use covimap_embed::{
    Estimate, Point, RelativeFrame, Similarity, SynchroniseOptions, Synchronised, handedness, synchronise,
};

use crate::{LinkGraph, LocalMap, MapError, Observer, RegionCover, SeamsReport};
pub(crate) use branches::SURE;
use seams::Seam;
pub(crate) use seams::flatness;

/// Weight of a landmark's place in the region whose core it is, relative to other regions.
const CORE_WEIGHT: f64 = 4.0;
/// Misfit, in map units, below which seams are not told apart in weight.
pub(crate) const LEAST_MISFIT: f64 = 0.03;

/// Scales stay.
const RIGID: SynchroniseOptions = SynchroniseOptions { scale_pull: f64::INFINITY };

/// The maps of all regions in one frame.
pub(crate) struct Stitched {
    /// Positions of all landmarks.
    pub points: Vec<Point>,
    /// Branch of each region; branch 0 has most landmarks.
    pub branch_of: Vec<u32>,
    /// Dropped seams and hinges.
    pub seams: SeamsReport,
}

/// The local maps of a connected graph, and what the landmarks that they share tell of how they lie to each other.
pub(crate) struct Patchwork<'a> {
    cover: &'a RegionCover,
    maps: &'a [LocalMap],
    landmarks: usize,
    seams: Vec<Seam>,
}

impl<'a> Patchwork<'a> {
    /// Lays the maps of all regions of `cover` side by side; tells of every region.
    pub fn new(
        graph: &LinkGraph,
        cover: &'a RegionCover,
        maps: &'a [LocalMap],
        observer: &dyn Observer,
    ) -> Self {
        Self { cover, maps, landmarks: graph.landmarks(), seams: seams::find(graph, cover, maps, observer) }
    }

    /// One frame for all.
    pub fn stitched(&self) -> Result<Stitched, MapError> {
        let synchronised = synchronise(self.maps.len(), &open_edges(&self.seams), RIGID)?;
        let both = self.seams.iter().zip(&synchronised.edges);
        let used: Vec<usize> = both.map(|(seam, edge)| seam.fit_of(edge.used)).collect();
        Ok(self.joined(&used, &synchronised))
    }

    /// Which regions lie mirrored, if `more(a, b)` is known besides of the evidence that regions `a` and `b` are of
    /// equal handedness.
    pub fn sides(&self, more: impl Fn(u32, u32) -> f64) -> Result<Vec<bool>, MapError> {
        let told = |seam: &Seam| Seam { evidence: seam.evidence + more(seam.a, seam.b), ..seam.clone() };
        let told: Vec<Seam> = self.seams.iter().map(told).collect();
        Ok(handedness(self.maps.len(), &open_edges(&told))?)
    }

    /// One frame for all where it is known which regions lie mirrored.
    pub fn stitched_by(&self, mirrored: &[bool]) -> Result<Stitched, MapError> {
        let used = |seam: &Seam| usize::from(mirrored[seam.a as usize] != mirrored[seam.b as usize]);
        let used: Vec<usize> = self.seams.iter().map(used).collect();
        let edges: Vec<RelativeFrame> =
            self.seams.iter().zip(&used).map(|(seam, &used)| relative_frame(seam, used)).collect();
        let synchronised = synchronise(self.maps.len(), &edges, RIGID)?;
        Ok(self.joined(&used, &synchronised))
    }

    /// Regions that have a seam in common, ascending.
    pub fn neighbours(&self) -> impl Iterator<Item = (u32, u32)> {
        self.seams.iter().map(|seam| (seam.a, seam.b))
    }

    fn joined(&self, used: &[usize], synchronised: &Synchronised) -> Stitched {
        let points = blend(self.landmarks, self.cover, self.maps, &synchronised.global_from_node);
        let (branch_of, seams) = branches::find(self.cover, &self.seams, used, &synchronised.edges);
        Stitched { points, branch_of, seams }
    }
}

/// The likelier fit of every seam first, and the other one as its alternative.
fn open_edges(seams: &[Seam]) -> Vec<RelativeFrame> {
    let edge = |seam: &Seam| {
        let likelier = seam.fit_of(Estimate::Given);
        RelativeFrame { alternative: Some(seam.a_from_b[1 - likelier]), ..relative_frame(seam, likelier) }
    };
    seams.iter().map(edge).collect()
}

/// The edge of a seam if its fit `used` is right, and there is no other.
fn relative_frame(seam: &Seam, used: usize) -> RelativeFrame {
    RelativeFrame {
        a: seam.a,
        b: seam.b,
        a_from_b: seam.a_from_b[used],
        alternative: None,
        evidence: seam.evidence.abs(),
        weight: seam.shared as f64 / (seam.misfit[used].powi(2) + LEAST_MISFIT.powi(2)),
    }
}

fn blend(landmarks: usize, cover: &RegionCover, maps: &[LocalMap], frames: &[Similarity]) -> Vec<Point> {
    let mut sums = vec![[0.0; 3]; landmarks];
    for (index, (region, map)) in cover.regions().iter().zip(maps).enumerate() {
        for (&landmark, &place) in region.members.iter().zip(&map.points) {
            let own = cover.core_of()[landmark as usize] as usize == index;
            let weight = if own { CORE_WEIGHT } else { 1.0 };
            let point = frames[index].apply(place);
            let sum = &mut sums[landmark as usize];
            *sum = [sum[0] + weight * point[0], sum[1] + weight * point[1], sum[2] + weight];
        }
    }
    sums.iter().map(|[x, y, weight]| [x / weight, y / weight]).collect()
}

#[cfg(test)]
mod tests;
