//! Halos: the landmarks around a core that tie a region to its neighbours.
//!
//! A landmark joins where it is linked to enough of the core; the best linked ones come first if
//! there is no room for all. Where a core hangs on the rest by fewer links than that, the links
//! there are have to do: every core touches every core it is linked with.

use rayon::prelude::*;

use super::Region;
use crate::{LinkGraph, RegionParams};

pub(super) fn add(graph: &LinkGraph, cores: Vec<Vec<u32>>, sizes: RegionParams) -> Vec<Region> {
    cores.into_par_iter().map(|core| region_around(graph, core, sizes)).collect()
}

fn region_around(graph: &LinkGraph, core: Vec<u32>, sizes: RegionParams) -> Region {
    let mut outside: Vec<(u32, f64)> = core
        .iter()
        .flat_map(|&landmark| graph.of(landmark))
        .filter(|link| core.binary_search(&link.to).is_err())
        .map(|link| (link.to, link.weight))
        .collect();
    outside.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let mut halo: Vec<(usize, f64, u32)> = outside
        .chunk_by(|a, b| a.0 == b.0)
        .map(|links| (links.len(), links.iter().map(|link| link.1).sum(), links[0].0))
        .collect();
    let most = halo.iter().map(|candidate| candidate.0).max().unwrap_or(0);
    halo.retain(|candidate| candidate.0 >= sizes.halo_links.min(most));
    halo.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.2.cmp(&b.2)));
    halo.truncate(sizes.members.saturating_sub(core.len()));
    let mut members = core.clone();
    members.extend(halo.iter().map(|candidate| candidate.2));
    members.sort_unstable();
    Region { core, members }
}
