use super::*;
use crate::fixtures::{empty, index_of, lines_among, scattered, square_and_pair};

/// Dijkstra's search: without a bound.
struct Blind;

impl RouteSearch<Roads<'_>> for Blind {
    fn search(&self, graph: &Roads<'_>, from: LandmarkId, to: LandmarkId) -> Option<Vec<LandmarkId>> {
        AStar.search(&Unbounded(graph), from, to)
    }
}

struct Unbounded<'a>(&'a Roads<'a>);

impl SearchGraph for Unbounded<'_> {
    fn landmarks(&self) -> usize {
        self.0.landmarks()
    }

    fn roads_from(&self, from: LandmarkId) -> impl Iterator<Item = (LandmarkId, f64)> {
        self.0.roads_from(from)
    }

    fn at_least(&self, _: LandmarkId, _: LandmarkId) -> f64 {
        0.0
    }
}

fn params(objective: Objective, min_steps: u32) -> RoadParams {
    RoadParams { objective, min_steps }
}

fn numbers(route: &Route) -> Vec<u32> {
    route.landmarks.iter().map(|id| id.0).collect()
}

/// A long straight leg that was rarely seen, and a detour that was seen often.
fn shortcut() -> MapIndex {
    let points = [[0.0, 0.0], [2.0, 0.0], [0.5, 1.0], [1.5, 1.0]];
    index_of(&points, &[(0, 1, 2), (0, 2, 80), (2, 3, 80), (1, 3, 80)])
}

#[test]
fn the_shortest_and_the_safest_way_may_differ() {
    let index = shortcut();
    let shortest = Roads::new(&index, RoadParams::default()).unwrap().route("L0", "L1").unwrap();
    assert_eq!(numbers(&shortest), [0, 1]);
    assert_eq!((shortest.length, shortest.cost), (2.0, 2.0));
    let safest = Roads::new(&index, params(Objective::Safest, 1)).unwrap().route("L0", "L1").unwrap();
    assert_eq!(numbers(&safest), [0, 2, 3, 1]);
    // Three legs of f = 80.5 / 121; the straight one has f = 2.5 / 199, more than 3 times the cost.
    assert!((safest.cost - -3.0 * (80.5f64 / 121.0).ln()).abs() < 1e-12);
    // sqrt(0.25 + 1) twice, and 1.
    assert!((safest.length - (2.0 * 1.25f64.sqrt() + 1.0)).abs() < 1e-12);
}

#[test]
fn waypoints_are_the_middles_of_the_legs() {
    let index = shortcut();
    let route = Roads::new(&index, params(Objective::Shortest, 3)).unwrap().route("L1", "L2").unwrap();
    assert_eq!(numbers(&route), [1, 3, 2]);
    let [first, last] = route.waypoints[..] else { panic!("{route:?}") };
    assert_eq!(first.position, [1.75, 0.5]);
    assert_eq!(first.in_sight, [LandmarkId(1), LandmarkId(3)]);
    assert_eq!((first.steps, first.cost), (80, 1.25f64.sqrt()));
    assert_eq!((last.position, last.cost), ([1.0, 1.0], route.cost));
    let here = Roads::new(&index, RoadParams::default()).unwrap().route("L1", "L1").unwrap();
    assert_eq!((numbers(&here), here.length, here.waypoints.len()), (vec![1], 0.0, 0));
}

#[test]
fn there_is_no_way_between_components_nor_over_weaker_roads_than_asked() {
    let index = square_and_pair();
    let roads = Roads::new(&index, params(Objective::Shortest, 11)).unwrap();
    assert!(matches!(roads.route("L0", "L4"), Err(PlanError::Apart { components: [0, 1], .. })));
    assert_eq!(
        roads.route("L4", "L5").unwrap_err().to_string(),
        "no way from \"L4\" to \"L5\" whose neighbours were seen together in 11 steps or more; ask for fewer"
    );
    assert!(matches!(roads.route("L4", "L6"), Err(PlanError::UnknownLandmark { .. })));
}

#[test]
fn a_map_without_lines_of_sight_has_no_roads() {
    for index in [empty(), index_of(&[[0.0; 2], [1.0; 2]], &[])] {
        assert_eq!(
            Roads::new(&index, RoadParams::default()).unwrap_err().to_string(),
            "the map holds no lines of sight, so it knows no way; build it again from its log"
        );
    }
}

#[test]
fn a_foreign_search_is_taken_at_its_word_only_over_roads() {
    struct Straight;
    impl RouteSearch<Roads<'_>> for Straight {
        fn search(&self, _: &Roads<'_>, from: LandmarkId, to: LandmarkId) -> Option<Vec<LandmarkId>> {
            Some(vec![from, to])
        }
    }
    let index = shortcut();
    let roads = Roads::new(&index, params(Objective::Shortest, 3)).unwrap();
    assert_eq!(numbers(&roads.route_by(&Straight, "L0", "L2").unwrap()), [0, 2]);
    for to in ["L1", "L3"] {
        assert_eq!(
            roads.route_by(&Straight, "L0", to).unwrap_err().to_string(),
            format!(
                "the search went from \"L0\" to {to:?}, which no road joins; a leg must be a road of the graph"
            )
        );
    }
}

#[test]
fn a_foreign_search_that_goes_astray_is_refused() {
    struct To(Vec<u32>);
    impl RouteSearch<Roads<'_>> for To {
        fn search(&self, _: &Roads<'_>, _: LandmarkId, _: LandmarkId) -> Option<Vec<LandmarkId>> {
            Some(self.0.iter().copied().map(LandmarkId).collect())
        }
    }
    let index = shortcut();
    let roads = Roads::new(&index, params(Objective::Shortest, 3)).unwrap();
    for way in [vec![], vec![0], vec![0, 1], vec![1, 2], vec![0, 99, 2], vec![99]] {
        let refused = roads.route_by(&To(way.clone()), "L0", "L2");
        assert!(
            matches!(&refused, Err(PlanError::Astray { from, to }) if from == "L0" && to == "L2"),
            "{way:?}"
        );
    }
}

#[test]
fn the_bound_changes_no_cost() {
    // Two landmarks at one place: a road without length.
    let mut points = scattered(120, 8);
    points[7] = points[40];
    let index = index_of(&points, &lines_among(&points, 1));
    for objective in [Objective::Shortest, Objective::Safest] {
        let roads = Roads::new(&index, params(objective, 35)).unwrap();
        let pairs: Vec<[LandmarkId; 2]> = (0..60).map(|i| [LandmarkId(i), LandmarkId(119 - i)]).collect();
        let mut found = 0;
        for &[from, to] in &pairs {
            let (Ok(drawn), Ok(blind)) = (roads.route(from, to), roads.route_by(&Blind, from, to)) else {
                assert!(roads.route_by(&Blind, from, to).is_err());
                continue;
            };
            found += 1;
            assert!((drawn.cost - blind.cost).abs() < 1e-12);
            let legs = drawn.landmarks.windows(2).map(|leg| (leg[0], leg[1]));
            assert!(legs.zip(&drawn.waypoints).all(|((a, b), point)| point.in_sight == [a, b]));
        }
        assert!(found > 40, "{found}");
    }
}

#[test]
fn landmarks_at_one_place_have_ways_of_no_length() {
    // Two legs of f = 80.5 / 121 cost less than one of f = 2.5 / 199.
    let index = index_of(&[[1.0, 2.0]; 3], &[(0, 1, 80), (1, 2, 80), (0, 2, 2)]);
    let safest = Roads::new(&index, params(Objective::Safest, 1)).unwrap().route("L0", "L2").unwrap();
    assert_eq!((numbers(&safest), safest.length), (vec![0, 1, 2], 0.0));
    let shortest = Roads::new(&index, RoadParams::default()).unwrap().route("L0", "L2").unwrap();
    assert_eq!(shortest.length, 0.0);
}

#[test]
fn many_routes_are_those_one_by_one() {
    let index = shortcut();
    let roads = Roads::new(&index, RoadParams::default()).unwrap();
    let pairs = [["L0", "L3"], ["L3", "L1"], ["L2", "L2"]];
    let all = roads.route_of_each(&pairs).unwrap();
    for ([from, to], route) in pairs.iter().zip(&all) {
        assert_eq!(route, &roads.route(from, to).unwrap());
    }
    assert!(matches!(roads.route_of_each(&[["L0", "X"]]), Err(PlanError::UnknownLandmark { .. })));
}

#[test]
fn prepared_roads_give_the_same_routes() {
    // More landmarks than a cell holds.
    let points = scattered(2500, 12);
    let index = index_of(&points, &lines_among(&points, 2));
    let flat = Roads::new(&index, RoadParams::default()).unwrap();
    let prepared = flat.clone().prepare();
    let pairs: Vec<[LandmarkId; 2]> = (0..40).map(|i| [LandmarkId(i * 61), LandmarkId(i * 17)]).collect();
    let [expected, found] = [flat, prepared].map(|roads| roads.route_of_each(&pairs).unwrap());
    for (expected, found) in expected.iter().zip(&found) {
        assert!((expected.cost - found.cost).abs() <= 1e-12 * expected.cost);
    }
}
