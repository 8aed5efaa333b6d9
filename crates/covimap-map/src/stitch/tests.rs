use covimap_embed::{Correspondence, ProcrustesOptions, Reflection, procrustes};
use proptest::prelude::*;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::*;
use crate::fixtures::{cases, exact_links, on_threads, scattered};
use crate::{RegionParams, Silent};

/// Turns, shifts and, half of the time, mirrors a point set; the same for all of its points.
fn moved(points: Vec<Point>, rng: &mut ChaCha8Rng) -> LocalMap {
    let (sin, cos) = rng.random_range(0.0..6.3_f64).sin_cos();
    let shift = [rng.random_range(-9.0..9.0), rng.random_range(-9.0..9.0)];
    let motion = Similarity { cos, sin, mirrored: rng.random(), scale: 1.0, shift };
    LocalMap { points: points.into_iter().map(|point| motion.apply(point)).collect(), stress1: 0.0 }
}

/// The local map of each region: the true positions, each coordinate off by up to `noise`, in a frame
/// of its own.
fn local_maps(truth: &[Point], cover: &RegionCover, noise: f64, seed: u64) -> Vec<LocalMap> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let map = |region: &crate::Region| {
        let blurred = |&member: &u32| truth[member as usize].map(|x| x + noise * rng.random_range(-1.0..1.0));
        let points = region.members.iter().map(blurred).collect();
        moved(points, &mut rng)
    };
    cover.regions().iter().map(map).collect()
}

/// Root mean square distance from the truth after the best rigid motion or reflection.
fn rmse(points: &[Point], truth: &[Point]) -> f64 {
    let pair = |(&source, &target)| Correspondence { source, target, weight: 1.0 };
    let pairs: Vec<_> = points.iter().zip(truth).map(pair).collect();
    procrustes(&pairs, ProcrustesOptions { scale: false, reflection: Reflection::Allow }).unwrap().rmse
}

fn stitched(truth: &[Point], reach: f64, noise: f64, seed: u64) -> f64 {
    let graph = exact_links(truth, reach);
    let cover = RegionCover::new(&graph, RegionParams::default());
    let maps = local_maps(truth, &cover, noise, seed);
    rmse(&Patchwork::new(&graph, &cover, &maps, &Silent).stitched().unwrap().points, truth)
}

proptest! {
    #![proptest_config(cases(24))]

    #[test]
    fn exact_local_maps_give_the_exact_map(seed in 0_u64..1000, width in 3.0..8.0) {
        let truth = scattered(400, [width, 40.0 / width], seed);
        prop_assume!(exact_links(&truth, 1.1).components().len() == 1);
        let rmse = stitched(&truth, 1.1, 0.0, seed);
        prop_assert!(rmse < 1e-9, "{}", rmse);
    }

    #[test]
    fn small_errors_of_local_maps_stay_small(seed in 0_u64..1000) {
        let truth = scattered(500, [7.0, 7.0], seed);
        // Each of a landmark's places is off by 0.03 sqrt(2/3) = 0.024 in the mean square. Their mean is
        // off by less; frames that are a little off over seven units bring it back to 0.031.
        let rmse = stitched(&truth, 1.1, 0.03, seed);
        prop_assert!(rmse < 0.04, "{}", rmse);
    }
}

#[test]
fn a_single_region_keeps_its_map() {
    let truth = scattered(40, [2.0, 2.0], 3);
    let graph = exact_links(&truth, 1.1);
    let cover = RegionCover::new(&graph, RegionParams::default());
    let maps = local_maps(&truth, &cover, 0.0, 4);
    assert_eq!(Patchwork::new(&graph, &cover, &maps, &Silent).stitched().unwrap().points, maps[0].points);
}

#[test]
fn a_closed_corridor_closes() {
    // A ring of 30 units around and 1 wide: the last region must meet the first.
    let flat = scattered(600, [30.0, 1.0], 11);
    let turn = std::f64::consts::TAU / 30.0;
    let truth: Vec<Point> = flat
        .iter()
        .map(|&[x, y]| {
            [
                (30.0 / std::f64::consts::TAU + y) * (turn * x).cos(),
                (30.0 / std::f64::consts::TAU + y) * (turn * x).sin(),
            ]
        })
        .collect();
    assert!(stitched(&truth, 1.1, 0.0, 1) < 1e-9);
    let rmse = stitched(&truth, 1.1, 0.03, 1);
    assert!(rmse < 0.1, "{rmse}");
}

/// Two rooms of 4 x 4 with a wall at x = 0 between them. Links end at the wall, but for those of the
/// landmarks in the doorway, which stand in line.
fn rooms_with_a_door(seed: u64) -> (Vec<Point>, LinkGraph) {
    let mut truth: Vec<Point> = scattered(150, [4.0, 4.0], seed).iter().map(|&[x, y]| [x + 0.3, y]).collect();
    truth.extend(scattered(150, [4.0, 4.0], seed + 1).iter().map(|&[x, y]| [-x - 0.3, y]));
    truth.extend((0..6).map(|k| [0.0, 1.6 + 0.15 * f64::from(k)]));
    let graph = exact_links(&truth, 1.3);
    let crosses = |i: usize, j: usize| truth[i][0] * truth[j][0] < 0.0;
    // A line of sight through the door, y from 1.6 to 2.35.
    let through = |i: usize, j: usize| {
        let ([x, y], [u, v]) = (truth[i], truth[j]);
        (1.6..2.35).contains(&(y + (v - y) * x / (x - u)))
    };
    let graph = crate::fixtures::links_where(306, |i, j| {
        let link = graph.of(i as u32).iter().find(|link| link.to == j as u32)?;
        (!crosses(i, j) || through(i, j)).then_some(link.distance)
    });
    (truth, graph)
}

#[test]
fn links_through_a_door_decide_which_side_is_which() {
    for seed in 0..8 {
        let (truth, graph) = rooms_with_a_door(seed);
        let cover = RegionCover::new(&graph, RegionParams::default());
        let maps = local_maps(&truth, &cover, 0.02, seed);
        let rmse = rmse(&Patchwork::new(&graph, &cover, &maps, &Silent).stitched().unwrap().points, &truth);
        // Folded over at the door the rooms would lie on each other, metres from where they belong.
        assert!(rmse < 0.15, "seed {seed}: {rmse}");
    }
}

#[test]
fn the_same_bits_on_one_thread_and_on_three() {
    let truth = scattered(500, [7.0, 7.0], 2);
    let graph = exact_links(&truth, 1.1);
    let cover = RegionCover::new(&graph, RegionParams::default());
    let maps = local_maps(&truth, &cover, 0.03, 2);
    let run = |threads| {
        on_threads(threads, || Patchwork::new(&graph, &cover, &maps, &Silent).stitched().unwrap().points)
    };
    assert_eq!(run(1), run(3));
}

/// A cover of a room with noisy local maps.
fn room() -> (LinkGraph, RegionCover, Vec<LocalMap>) {
    let truth = scattered(400, [6.0, 6.0], 5);
    let graph = exact_links(&truth, 1.1);
    let cover = RegionCover::new(&graph, RegionParams::default());
    let maps = local_maps(&truth, &cover, 0.03, 6);
    (graph, cover, maps)
}

#[test]
fn by_the_sides_that_it_finds_stitching_gives_its_own_map() {
    let (graph, cover, maps) = room();
    let patchwork = Patchwork::new(&graph, &cover, &maps, &Silent);
    let found = patchwork.sides(|_, _| 0.0).unwrap();
    assert!(found.contains(&true) && found.contains(&false));
    let opposite: Vec<bool> = found.iter().map(|side| !side).collect();
    let wanted = patchwork.stitched().unwrap();
    for known in [found, opposite] {
        let stitched = patchwork.stitched_by(&known).unwrap();
        assert!(rmse(&stitched.points, &wanted.points) < 1e-6);
        assert_eq!(
            (stitched.branch_of, &stitched.seams.hinges),
            (wanted.branch_of.clone(), &wanted.seams.hinges)
        );
    }
}

#[test]
fn what_is_known_besides_outweighs_seams() {
    let (graph, cover, maps) = room();
    let patchwork = Patchwork::new(&graph, &cover, &maps, &Silent);
    let found = patchwork.sides(|_, _| 0.0).unwrap();
    // Region 3 is said to lie the other way round.
    let said = |a: u32, b: u32| {
        let equal = (found[a as usize] == found[b as usize]) != (a == 3 || b == 3);
        if equal { 1e4 } else { -1e4 }
    };
    let sides = patchwork.sides(said).unwrap();
    let changed: Vec<usize> =
        (0..maps.len()).filter(|&r| (sides[r] != found[r]) != (sides[0] != found[0])).collect();
    assert_eq!(changed, [3]);
    // The seams of that region are used against their evidence.
    let forced = patchwork.stitched_by(&sides).unwrap().seams;
    let against = |seam: &crate::SeamReport| seam.evidence < 0.0 && seam.regions.contains(&3);
    assert!(forced.hinges.iter().any(|hinge| against(&hinge.seam)) || forced.dropped.iter().any(against));
}
