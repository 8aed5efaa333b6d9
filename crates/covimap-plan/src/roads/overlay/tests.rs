use proptest::prelude::*;

use super::*;
use crate::fixtures::{cases, index_of, lines_among, scattered, square_and_pair};
use crate::{MapIndex, Objective, RoadParams, Route};

fn roads(index: &MapIndex, objective: Objective, min_steps: u32) -> Roads<'_> {
    Roads::new(index, RoadParams { objective, min_steps }).unwrap()
}

/// The way over an overlay, which must cost what the search over all roads finds; none if there is none.
fn same_cost(roads: &Roads<'_>, overlay: &Overlay, from: u32, to: u32) -> Option<Route> {
    let [from, to] = [from, to].map(LandmarkId);
    let [over, flat] = [roads.route_by(overlay, from, to).ok(), roads.route_by(&AStar, from, to).ok()];
    assert_eq!(over.is_some(), flat.is_some(), "{from:?} {to:?}");
    let (over, flat) = (over?, flat?);
    assert!((over.cost - flat.cost).abs() <= 1e-12 * flat.cost, "{} {}", over.cost, flat.cost);
    assert_eq!((over.landmarks[0], *over.landmarks.last().unwrap()), (from, to));
    Some(over)
}

fn all_pairs(index: &MapIndex, most: usize) -> usize {
    let n = index.map().len() as u32;
    let mut found = 0;
    for objective in [Objective::Shortest, Objective::Safest] {
        let roads = roads(index, objective, 1);
        let overlay = Overlay::new(&roads, most);
        let pairs = (0..n).flat_map(|a| (0..n).map(move |b| (a, b)));
        found += pairs.filter_map(|(a, b)| same_cost(&roads, &overlay, a, b)).count();
    }
    found
}

proptest! {
    #![proptest_config(cases(60))]
    #[test]
    fn ways_cost_what_a_search_over_all_roads_finds(
        n in 3..250usize,
        seed in 0..1000u64,
        most in prop::sample::select(vec![1, 2, 5, 20, 70, 1000]),
        min_steps in prop::sample::select(vec![1, 50, 70]),
        safest: bool,
        // Landmarks on a coarse lattice often share a place, and have many equally cheap ways.
        lattice: bool,
    ) {
        let mut points = scattered(n, seed);
        let lines = lines_among(&points, seed);
        if lattice {
            points.iter_mut().flatten().for_each(|v| *v = (*v * 8.0).floor());
        }
        let index = index_of(&points, &lines);
        let objective = if safest { Objective::Safest } else { Objective::Shortest };
        prop_assume!(!lines.is_empty());
        let roads = roads(&index, objective, min_steps);
        let overlay = Overlay::new(&roads, most);
        for i in 0..40 {
            same_cost(&roads, &overlay, i * 7 % n as u32, i * 31 % n as u32);
        }
    }
}

#[test]
fn two_halves_that_one_landmark_joins() {
    // Two triangles with a corner in common.
    let points = [[-2.0, 1.0], [-2.0, -1.0], [0.0, 0.0], [2.0, 1.0], [2.0, -1.0]];
    let index = index_of(&points, &[(0, 1, 9), (1, 2, 9), (0, 2, 9), (2, 3, 9), (3, 4, 9), (2, 4, 9)]);
    for most in 1..6 {
        assert_eq!(all_pairs(&index, most), 50);
    }
}

#[test]
fn cells_may_hold_landmarks_of_several_components() {
    let index = square_and_pair();
    for most in 1..7 {
        // 4 x 4 pairs in the square and 2 x 2 in the other, for two objectives; no other pair has a way.
        assert_eq!(all_pairs(&index, most), 40);
    }
}

#[test]
fn passages_over_others_at_the_border_are_left_out() {
    // A line 0 - 1 - 2 - 3 with roads of 1, 2 and 4, and a road of 8 past all; 2 is inside.
    let line = [
        vec![(1, 1.0), (3, 8.0)],
        vec![(0, 1.0), (2, 2.0)],
        vec![(1, 2.0), (3, 4.0)],
        vec![(2, 4.0), (0, 8.0)],
    ];
    let renumbered = |border: usize| passages_from(0, &line, border, 1e-9);
    assert_eq!(renumbered(2), [(1, 1.0)]);
    // 0 to 3 is 7 over 1 and 2, both at the border.
    assert_eq!(renumbered(4), [(1, 1.0)]);
    // The same with 1 inside: swap the numbers of 1 and 3.
    let line = [
        vec![(3, 1.0), (1, 8.0)],
        vec![(2, 4.0), (0, 8.0)],
        vec![(3, 2.0), (1, 4.0)],
        vec![(0, 1.0), (2, 2.0)],
    ];
    assert_eq!(passages_from(0, &line, 2, 1e-9), [(1, 7.0)]);
}

#[test]
fn passages_between_landmarks_at_one_place_stay() {
    // Each is between the two others, at no cost: if that counted, all passages would be left out.
    let triangle: Vec<Vec<(u32, f64)>> =
        (0..3).map(|i| (0..3).filter(|&j| j != i).map(|j| (j, 0.0)).collect()).collect();
    for from in 0..3 {
        assert_eq!(passages_from(from, &triangle, 3, 0.0).len(), 2);
    }
}

#[test]
fn overlays_do_not_depend_on_the_number_of_threads() {
    let points = scattered(400, 3);
    let index = index_of(&points, &lines_among(&points, 4));
    let roads = roads(&index, Objective::Safest, 1);
    let made = [1, 4].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let overlay = pool.install(|| Overlay::new(&roads, 30));
        (overlay.cells.order, overlay.starts, overlay.passages)
    });
    assert_eq!(made[0], made[1]);
}
