//! Overlapping regions: the pieces that are small enough to be solved by themselves.
//!
//! Every landmark is in the *core* of exactly one region. A region's *members* are its core and a
//! *halo* of landmarks that are linked to several of the core; the members that two regions share
//! hold them together when they are stitched. Cores are connected and take up at most half of the
//! members that a region may have.

mod cores;
mod halo;

use crate::{Hinge, LinkGraph, Observer, RegionParams, Silent};

/// One region of a cover.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Region {
    /// Landmarks that belong to this region and no other, ascending.
    pub core: Vec<u32>,
    /// Core and halo, ascending.
    pub members: Vec<u32>,
}

/// All regions of one connected graph.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RegionCover {
    regions: Vec<Region>,
    core_of: Vec<u32>,
}

impl RegionCover {
    /// Covers a connected graph. A graph of at most `sizes.members` landmarks is one region.
    pub(crate) fn new(graph: &LinkGraph, sizes: RegionParams) -> Self {
        Self::watched(graph, sizes, &Silent)
    }

    /// The same, telling of every landmark twice.
    pub(crate) fn watched(graph: &LinkGraph, sizes: RegionParams, observer: &dyn Observer) -> Self {
        let n = graph.landmarks();
        let core_of = if n <= sizes.members { vec![0; n] } else { cores::grow(graph, sizes, observer) };
        let regions = halo::add(graph, &core_of, sizes);
        let cover = Self { regions, core_of };
        #[cfg(test)]
        cover.check_invariants(graph, sizes);
        cover
    }

    /// Widens the two regions of every hinge to all landmarks that a link ties to their cores, as far as there
    /// is room, and returns their numbers, ascending.
    pub(crate) fn widen(&mut self, graph: &LinkGraph, hinges: &[Hinge], sizes: RegionParams) -> Vec<usize> {
        let mut hinged: Vec<usize> =
            hinges.iter().flat_map(|hinge| hinge.seam.regions.map(|region| region as usize)).collect();
        hinged.sort_unstable();
        hinged.dedup();
        let sizes = RegionParams { halo_links: 1, ..sizes };
        for &number in &hinged {
            let region = &mut self.regions[number];
            *region = halo::region_around(graph, std::mem::take(&mut region.core), &[], sizes);
        }
        hinged
    }

    /// The regions.
    #[must_use]
    pub fn regions(&self) -> &[Region] {
        &self.regions
    }

    /// The region of whose core each landmark is.
    #[must_use]
    pub fn core_of(&self) -> &[u32] {
        &self.core_of
    }
}

#[cfg(test)]
mod tests;
