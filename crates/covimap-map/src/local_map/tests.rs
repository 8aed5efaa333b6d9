use super::*;
use crate::fixtures::{distance, exact_links, links_where, scattered};

const TO_THE_END: StopRule = StopRule { max_iterations: 5000, tolerance: 1e-14 };

fn whole(graph: &LinkGraph) -> Region {
    let all: Vec<u32> = (0..graph.landmarks() as u32).collect();
    Region { core: all.clone(), members: all }
}

/// Largest error of a distance, over all pairs of members.
fn worst_distance(map: &LocalMap, truth: &[Point]) -> f64 {
    let pairs = (0..truth.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
    let miss = |(i, j)| (distance(map.points[i], map.points[j]) - distance(truth[i], truth[j])).abs();
    pairs.map(miss).fold(0.0, f64::max)
}

#[test]
fn exact_distances_give_the_exact_map() {
    for seed in 0..5 {
        let truth = scattered(60, [2.0, 2.5], seed);
        let graph = exact_links(&truth, 1.1);
        let map = solve(&graph, &whole(&graph), TO_THE_END).unwrap();
        assert!(map.stress1 < 1e-4, "seed {seed}: {}", map.stress1);
        assert!(worst_distance(&map, &truth) < 1e-3, "seed {seed}: {}", worst_distance(&map, &truth));
    }
}

#[test]
fn a_region_is_mapped_by_the_links_inside_it() {
    let truth = scattered(80, [3.0, 3.0], 6);
    let graph = exact_links(&truth, 1.4);
    let members: Vec<u32> = (0..80).filter(|&i| truth[i as usize][0] < 1.5).collect();
    let region = Region { core: members.clone(), members: members.clone() };
    let map = solve(&graph, &region, TO_THE_END).unwrap();
    let inside: Vec<Point> = members.iter().map(|&i| truth[i as usize]).collect();
    assert!(worst_distance(&map, &inside) < 1e-3, "{}", worst_distance(&map, &inside));
}

#[test]
fn the_links_decide_and_not_the_paths() {
    // Around three sides of a square: the path from 0 to 3 has length 3, the link says 1.
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let graph = exact_links(&square, 1.2);
    let start = path_scaling(&graph.to_pairs()).unwrap();
    let map = solve(&graph, &whole(&graph), TO_THE_END).unwrap();
    assert!(map.stress1 < 1e-9);
    // Paths of length 2 across, where the diagonal is sqrt 2, make the start too large.
    assert!(distance(start[0], start[2]) > 1.5 && distance(start[0], start[1]) > 1.05);
}

#[test]
fn one_member_two_members_and_a_line() {
    let one = links_where(1, |_, _| None);
    assert_eq!(solve(&one, &whole(&one), TO_THE_END).unwrap().points, [[0.0, 0.0]]);
    let two = links_where(2, |_, _| Some(0.4));
    let map = solve(&two, &whole(&two), TO_THE_END).unwrap();
    assert!((distance(map.points[0], map.points[1]) - 0.4).abs() < 1e-12);
    // A chain has no other paths than along it, so that it lies stretched.
    let line: Vec<Point> = (0..9).map(|k| [0.5 * f64::from(k), 0.0]).collect();
    let chain = links_where(9, |i, j| (j == i + 1).then_some(0.5));
    let map = solve(&chain, &whole(&chain), TO_THE_END).unwrap();
    assert!(worst_distance(&map, &line) < 1e-9 && map.stress1 < 1e-9);
}

#[test]
fn a_region_that_falls_apart_has_no_map() {
    let graph = links_where(4, |i, j| (j == i + 1 && i != 1).then_some(1.0));
    assert!(matches!(
        solve(&graph, &whole(&graph), TO_THE_END),
        Err(EmbedError::UnknownDistance { i: 0, j: 2 })
    ));
}

#[test]
fn a_length_is_told_by_the_regions_of_both_ends() {
    // Landmarks 0 and 1 in the core of the first region, 2 and 3 in that of the second.
    let cover = RegionCover::of_members(4, &[&[0, 1, 2], &[2, 3]]);
    let map = |points: &[Point]| LocalMap { points: points.to_vec(), stress1: 0.0 };
    let maps = [map(&[[0.0, 0.0], [3.0, 4.0], [6.0, 8.0]]), map(&[[1.0, 1.0], [1.0, 3.0]])];
    assert_eq!(length(&cover, &maps, [0, 1]), Some(5.0));
    assert_eq!(length(&cover, &maps, [1, 2]), Some(5.0));
    assert_eq!(length(&cover, &maps, [2, 3]), Some(2.0));
    assert_eq!(length(&cover, &maps, [0, 3]), None);
}

#[test]
fn a_map_follows_other_distances_of_its_links() {
    let truth = scattered(40, [1.5, 1.5], 8);
    let graph = exact_links(&truth, 1.1);
    let map = solve(&graph, &whole(&graph), TO_THE_END).unwrap();
    let longer = graph.to_pairs_with(|i, j| (1.25 * distance(truth[i as usize], truth[j as usize]), 1.0));
    let map = solve_again(&longer, &map, TO_THE_END).unwrap();
    let stretched: Vec<Point> = truth.iter().map(|point| point.map(|x| 1.25 * x)).collect();
    assert!(worst_distance(&map, &stretched) < 1e-3, "{}", worst_distance(&map, &stretched));
}
