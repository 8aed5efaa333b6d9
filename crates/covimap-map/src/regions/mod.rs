//! Overlapping regions: the pieces that are small enough to be solved by themselves.
//!
//! Every landmark is in the *core* of exactly one region. A region's *members* are its core and a
//! *halo* of landmarks that are linked to several of the core; the members that two regions share
//! hold them together when they are stitched. Cores are connected and bounded in size.

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
        let core_of = if n <= sizes.members { vec![0; n] } else { cores::grow(graph, sizes.core) };
        let mut cores = vec![Vec::new(); core_of.iter().max().map_or(0, |&last| last as usize + 1)];
        for (landmark, &region) in core_of.iter().enumerate() {
            cores[region as usize].push(landmark as u32);
        }
        let regions = halo::add(graph, cores, sizes);
        Self { regions, core_of }
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
