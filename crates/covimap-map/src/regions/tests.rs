use std::collections::BTreeMap;

use proptest::prelude::*;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::*;
use crate::SeamReport;
use crate::fixtures::{cases, exact_links, links_where, scattered};

impl RegionCover {
    /// Regions with these members, every landmark in the core of the first that has it.
    pub(crate) fn of_members(landmarks: usize, members: &[&[u32]]) -> Self {
        let first = |landmark| members.iter().position(|members| members.contains(&landmark)).unwrap() as u32;
        let core_of: Vec<u32> = (0..landmarks as u32).map(first).collect();
        let region = |(number, members): (usize, &&[u32])| Region {
            core: members
                .iter()
                .copied()
                .filter(|&member| core_of[member as usize] == number as u32)
                .collect(),
            members: members.to_vec(),
        };
        Self { regions: members.iter().enumerate().map(region).collect(), core_of }
    }

    /// What every cover keeps to, whatever the graph.
    pub(crate) fn check_invariants(&self, graph: &LinkGraph, sizes: RegionParams) {
        let mut core_of = vec![usize::MAX; graph.landmarks()];
        for (number, Region { core, members }) in self.regions.iter().enumerate() {
            assert!(core.is_sorted_by(|a, b| a < b) && members.is_sorted_by(|a, b| a < b));
            assert!(!core.is_empty() && core.iter().all(|landmark| members.binary_search(landmark).is_ok()));
            assert!(members.len() <= sizes.members, "region {number} has {} members", members.len());
            assert!(self.regions.len() == 1 || 2 * core.len() <= sizes.members, "no room for a halo");
            for &landmark in core {
                assert_eq!(std::mem::replace(&mut core_of[landmark as usize], number), usize::MAX);
            }
            for part in [core, members] {
                assert_eq!(graph.restricted_to(part).components().len(), 1, "region {number} falls apart");
            }
        }
        assert!(core_of.iter().zip(&self.core_of).all(|(&a, &b)| a == b as usize));
    }
}

fn sizes(core: usize, members: usize, halo_links: usize) -> RegionParams {
    RegionParams { core, members, halo_links }
}

/// A random graph of `n` landmarks: a random tree and a share of all other pairs.
fn random_graph(n: usize, share: f64, seed: u64) -> LinkGraph {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut linked = BTreeMap::new();
    for j in 1..n {
        let trunk = rng.random_range(0..j);
        for i in (0..j).filter(|&i| i == trunk || rng.random_bool(share)).collect::<Vec<_>>() {
            linked.insert((i, j), rng.random_range(0.2..1.0));
        }
    }
    links_where(n, |i, j| linked.get(&(i, j)).copied())
}

proptest! {
    #![proptest_config(cases(48))]

    #[test]
    fn covers_of_random_graphs(
        n in 1_usize..120, share in 0.0..0.2, seed in 0_u64..1000,
        core in 4_usize..20, more in 0_usize..60, halo_links in 1_usize..5,
    ) {
        let graph = random_graph(n, share, seed);
        let sizes = sizes(core, 2 * core + more, halo_links);
        RegionCover::new(&graph, sizes).check_invariants(&graph, sizes);
    }
}

/// Covers of graphs that are easy to draw and hard to cut.
#[test]
fn lines_grids_stars_and_complete_graphs() {
    let grid = |i: usize, j: usize| (j == i + 1 && !j.is_multiple_of(20) || j == i + 20).then_some(1.0);
    let graphs = [
        ("line", links_where(200, |i, j| (j == i + 1).then_some(1.0))),
        ("circle", links_where(200, |i, j| (j == i + 1 || j == i + 199).then_some(1.0))),
        ("grid", links_where(400, grid)),
        ("star", links_where(200, |i, _| (i == 0).then_some(1.0))),
        ("double star", links_where(200, |i, j| (i == 0 || i == 1 && j % 2 == 0).then_some(1.0))),
        ("complete, all alike", links_where(200, |_, _| Some(1.0))),
        ("complete", exact_links(&scattered(200, [2.0, 2.0], 1), 9.0)),
    ];
    for (name, graph) in graphs {
        for sizes in [RegionParams::default(), sizes(12, 40, 3), sizes(4, 8, 1)] {
            println!("{name}, {sizes:?}");
            RegionCover::new(&graph, sizes).check_invariants(&graph, sizes);
        }
    }
}

#[test]
fn few_landmarks_are_one_region() {
    for n in [1, 2, 3, 150] {
        let graph = links_where(n, |i, j| (j == i + 1).then_some(1.0));
        let cover = RegionCover::new(&graph, RegionParams::default());
        let all: Vec<u32> = (0..n as u32).collect();
        assert_eq!(cover.regions(), [Region { core: all.clone(), members: all }]);
        assert_eq!(cover.core_of(), vec![0; n]);
    }
    let graph = links_where(151, |i, j| (j == i + 1).then_some(1.0));
    assert!(RegionCover::new(&graph, RegionParams::default()).regions().len() > 1);
}

#[test]
fn cores_are_of_about_the_size_asked_for_and_numbered_by_their_first_landmark() {
    let graph = exact_links(&scattered(900, [9.0, 10.0], 5), 1.1);
    for size in [8, 12, 30] {
        let cover = RegionCover::new(&graph, sizes(size, 200, 3));
        let mut lengths: Vec<usize> = cover.regions().iter().map(|region| region.core.len()).collect();
        lengths.sort_unstable();
        let median = lengths[lengths.len() / 2];
        assert!((size / 2..=2 * size).contains(&median), "{size}: median core of {median}");
        assert!(cover.regions().is_sorted_by_key(|region| region.core[0]));
    }
}

#[test]
fn a_halo_landmark_has_links_enough_and_none_with_so_many_is_left_out() {
    let graph = exact_links(&scattered(600, [6.0, 10.0], 7), 1.1);
    for halo_links in [1, 3, 6] {
        let cover = RegionCover::new(&graph, sizes(12, 400, halo_links));
        for Region { core, members } in cover.regions() {
            let outside = (0..600).filter(|landmark| core.binary_search(landmark).is_err());
            let links: Vec<(u32, usize)> =
                outside.map(|landmark| (landmark, links(&graph, landmark, core))).collect();
            // Where nothing is linked so well, at the rim, the best there is will do.
            let enough = halo_links.min(links.iter().map(|&(_, links)| links).max().unwrap());
            for (landmark, links) in links {
                assert_eq!(members.binary_search(&landmark).is_ok(), links >= enough);
            }
        }
    }
}

/// Number of links of a landmark into a core.
fn links(graph: &LinkGraph, landmark: u32, core: &[u32]) -> usize {
    graph.of(landmark).iter().filter(|link| core.binary_search(&link.to).is_ok()).count()
}

#[test]
fn a_full_region_keeps_the_landmarks_that_are_linked_best() {
    let graph = exact_links(&scattered(600, [6.0, 10.0], 7), 1.1);
    let cover = RegionCover::new(&graph, sizes(12, 30, 1));
    // All weights are 1 here: the number of links decides.
    let mut full = 0;
    for Region { core, members } in cover.regions().iter().filter(|region| region.members.len() == 30) {
        full += 1;
        let halo = members.iter().filter(|member| core.binary_search(member).is_err());
        let least = halo.map(|&member| links(&graph, member, core)).min().unwrap();
        let outside = (0..600).filter(|landmark| members.binary_search(landmark).is_err());
        assert!(outside.map(|landmark| links(&graph, landmark, core)).max().unwrap() <= least);
    }
    assert!(full > 10);
}

/// Whether regions that share two landmarks lead from every region to every other.
fn hangs_together(cover: &RegionCover) -> bool {
    let shares =
        |a: &Region, b: &Region| a.members.iter().filter(|&member| b.members.contains(member)).count() >= 2;
    let links = links_where(cover.regions().len(), |a, b| {
        shares(&cover.regions()[a], &cover.regions()[b]).then_some(1.0)
    });
    links.components().len() == 1
}

#[test]
fn parts_that_one_landmark_or_one_link_joins_share_two_landmarks() {
    let cluster = scattered(200, [4.0, 5.0], 9);
    // Landmarks 200 to 399 are a second cluster; all else is far apart.
    let two = |i: usize, j: usize| {
        let (a, b) = (cluster[i % 200], cluster[j % 200]);
        (i / 200 == j / 200 && crate::fixtures::distance(a, b) < 1.1).then_some(0.5)
    };
    let joined = |extra: Vec<(usize, usize)>| {
        links_where(400, |i, j| two(i, j).or_else(|| extra.contains(&(i, j)).then_some(0.7)))
    };
    let hinge: Vec<(usize, usize)> = (200..400).filter(|&j| two(200, j).is_some()).map(|j| (17, j)).collect();
    for (name, graph) in [("one link", joined(vec![(17, 230)])), ("one landmark", joined(hinge))] {
        let cover = RegionCover::new(&graph, RegionParams::default());
        assert!(cover.regions().len() > 10 && hangs_together(&cover), "{name}");
    }
    // Without a door nothing is to be done for it.
    let open = exact_links(&scattered(400, [4.0, 10.0], 9), 1.1);
    assert!(hangs_together(&RegionCover::new(&open, RegionParams::default())));
}

#[test]
fn regions_at_a_hinge_take_in_all_that_is_linked_to_their_cores() {
    let graph = exact_links(&scattered(400, [6.0, 8.0], 4), 1.0);
    let sizes = RegionParams::default();
    let mut cover = RegionCover::new(&graph, sizes);
    let before = cover.clone();
    let seam =
        SeamReport { regions: [2, 5], shared: 3, residual: 0.1, condition: 0.1, evidence: 2.0, trust: 1.0 };
    assert_eq!(cover.widen(&graph, &[Hinge { seam, landmarks: 9 }], sizes), [2, 5]);
    cover.check_invariants(&graph, sizes);
    for (number, (region, old)) in cover.regions().iter().zip(before.regions()).enumerate() {
        if [2, 5].contains(&number) {
            let linked = |landmark: u32| links(&graph, landmark, &region.core) > 0;
            let wanted = (0..400).filter(|&i| linked(i) || region.core.binary_search(&i).is_ok());
            assert_eq!(region.members, wanted.collect::<Vec<_>>());
            assert!(region.members.len() > old.members.len());
        } else {
            assert_eq!(region, old);
        }
    }
}
