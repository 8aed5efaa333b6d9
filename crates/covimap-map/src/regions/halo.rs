//! Halos: the landmarks around a core that tie a region to its neighbours.
//!
//! A landmark joins where it is linked to enough of the core; the best linked ones come first if
//! there is no room for all. Where a core hangs on all others by fewer links than that, the links
//! there are have to do.
//!
//! Two regions can be laid together if they share two landmarks. Where a door, or one landmark that
//! two clusters have in common, leaves parts of the map without such a pair of regions, both ends of
//! every link between the parts join both regions.

use petgraph::unionfind::UnionFind;
use rayon::prelude::*;

use super::Region;
use crate::{LinkGraph, RegionParams};

/// Regions around the cores that `core_of` tells for each landmark.
pub(super) fn add(graph: &LinkGraph, core_of: &[u32], sizes: RegionParams) -> Vec<Region> {
    let mut cores = vec![Vec::new(); core_of.iter().max().map_or(0, |&last| last as usize + 1)];
    for (landmark, &region) in core_of.iter().enumerate() {
        cores[region as usize].push(landmark as u32);
    }
    let around = |core| region_around(graph, core, &[], sizes);
    let mut regions: Vec<Region> = cores.into_par_iter().map(around).collect();
    let bridgeheads = bridgeheads(graph, core_of, &regions);
    for (region, bridgeheads) in regions.iter_mut().zip(bridgeheads) {
        if !bridgeheads.is_empty() {
            *region = region_around(graph, std::mem::take(&mut region.core), &bridgeheads, sizes);
        }
    }
    regions
}

/// The core, the `chosen` landmarks next to it, and as much of its halo as there is room for.
pub(super) fn region_around(
    graph: &LinkGraph,
    core: Vec<u32>,
    chosen: &[u32],
    sizes: RegionParams,
) -> Region {
    let mut outside: Vec<(u32, f64)> = core
        .iter()
        .flat_map(|&landmark| graph.of(landmark))
        .filter(|link| core.binary_search(&link.to).is_err())
        .map(|link| (link.to, link.weight))
        .collect();
    outside.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let mut halo: Vec<Candidate> = outside
        .chunk_by(|a, b| a.0 == b.0)
        .map(|links| Candidate {
            landmark: links[0].0,
            chosen: chosen.binary_search(&links[0].0).is_ok(),
            links: links.len(),
            weight: links.iter().map(|link| link.1).sum(),
        })
        .collect();
    let most = halo.iter().map(|candidate| candidate.links).max().unwrap_or(0);
    halo.retain(|candidate| candidate.chosen || candidate.links >= sizes.halo_links.min(most));
    let order = |a: &Candidate, b: &Candidate| {
        b.chosen.cmp(&a.chosen).then(b.weight.total_cmp(&a.weight)).then(a.landmark.cmp(&b.landmark))
    };
    halo.sort_by(order);
    halo.truncate(sizes.members.saturating_sub(core.len()));
    let mut members = core.clone();
    members.extend(halo.iter().map(|candidate| candidate.landmark));
    members.sort_unstable();
    Region { core, members }
}

/// A landmark next to a core.
struct Candidate {
    landmark: u32,
    chosen: bool,
    /// Number of links into the core, and their summed weight.
    links: usize,
    weight: f64,
}

/// For each region, the far ends, ascending, of the core's links to parts of the map that no two
/// common landmarks tie to it: in nearly all maps none.
fn bridgeheads(graph: &LinkGraph, core_of: &[u32], regions: &[Region]) -> Vec<Vec<u32>> {
    let mut parts = UnionFind::<u32>::new(regions.len());
    for (a, region) in regions.iter().enumerate() {
        for neighbour in &region.members {
            let b = core_of[*neighbour as usize];
            if !parts.equiv(a as u32, b) && share_two(region, &regions[b as usize]) {
                parts.union(a as u32, b);
            }
        }
    }
    let part = parts.into_labeling();
    let part_of = |landmark: u32| part[core_of[landmark as usize] as usize];
    let far_ends = |region: &Region| {
        let links = region.core.iter().flat_map(|&own| {
            graph.of(own).iter().map(|link| link.to).filter(move |&far| part_of(far) != part_of(own))
        });
        let mut far_ends: Vec<u32> = links.collect();
        far_ends.sort_unstable();
        far_ends.dedup();
        far_ends
    };
    regions.iter().map(far_ends).collect()
}

fn share_two(a: &Region, b: &Region) -> bool {
    a.members.iter().filter(|member| b.members.binary_search(member).is_ok()).nth(1).is_some()
}
