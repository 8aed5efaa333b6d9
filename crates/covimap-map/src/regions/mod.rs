//! Overlapping regions: the pieces that are small enough to be solved by themselves.
//!
//! Every landmark is in the *core* of exactly one region. A region's *members* are its core and a
//! *halo* of landmarks that are linked to several of the core; the members that two regions share
//! hold them together when they are stitched. Cores are connected and take up at most half of the
//! members that a region may have.

mod cores;
mod halo;

use crate::{LinkGraph, RegionParams};

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
        let n = graph.landmarks();
        let core_of = if n <= sizes.members { vec![0; n] } else { cores::grow(graph, sizes) };
        let regions = halo::add(graph, &core_of, sizes);
        let cover = Self { regions, core_of };
        #[cfg(test)]
        cover.check_invariants(graph, sizes);
        cover
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
