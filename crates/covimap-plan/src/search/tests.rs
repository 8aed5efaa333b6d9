use proptest::prelude::*;

use super::*;
use crate::fixtures::cases;

/// Roads with their costs, over landmarks without places.
struct Network {
    landmarks: usize,
    roads: Vec<(u32, u32, f64)>,
}

impl SearchGraph for Network {
    fn landmarks(&self) -> usize {
        self.landmarks
    }

    fn roads_from(&self, from: LandmarkId) -> impl Iterator<Item = (LandmarkId, f64)> {
        let ends = self.roads.iter().flat_map(|&(a, b, cost)| [(a, b, cost), (b, a, cost)]);
        ends.filter(move |road| road.0 == from.0).map(|(_, to, cost)| (LandmarkId(to), cost))
    }

    fn at_least(&self, _: LandmarkId, _: LandmarkId) -> f64 {
        0.0
    }
}

impl Network {
    fn search(&self, from: u32, to: u32) -> Option<Vec<u32>> {
        let way = AStar.search(self, LandmarkId(from), LandmarkId(to))?;
        Some(way.into_iter().map(|id| id.0).collect())
    }

    /// Least costs between all pairs, by Floyd and Warshall.
    fn costs(&self) -> Vec<Vec<f64>> {
        let n = self.landmarks;
        let mut costs = vec![vec![f64::INFINITY; n]; n];
        for (i, row) in costs.iter_mut().enumerate() {
            row[i] = 0.0;
        }
        for &(a, b, cost) in &self.roads {
            for (a, b) in [(a as usize, b as usize), (b as usize, a as usize)] {
                costs[a][b] = costs[a][b].min(cost);
            }
        }
        for k in 0..n {
            for i in 0..n {
                for j in 0..n {
                    costs[i][j] = costs[i][j].min(costs[i][k] + costs[k][j]);
                }
            }
        }
        costs
    }
}

#[test]
fn a_detour_that_costs_less_is_taken() {
    let network = Network { landmarks: 5, roads: vec![(0, 1, 5.0), (0, 2, 1.0), (2, 3, 1.0), (3, 1, 1.0)] };
    assert_eq!(network.search(0, 1).unwrap(), [0, 2, 3, 1]);
    assert_eq!(network.search(1, 0).unwrap(), [1, 3, 2, 0]);
    assert_eq!(network.search(4, 4).unwrap(), [4]);
    assert_eq!(network.search(0, 4), None);
}

#[test]
fn roads_that_cost_nothing_go_in_no_circle() {
    let network = Network { landmarks: 4, roads: vec![(0, 1, 0.0), (1, 2, 0.0), (2, 0, 0.0), (2, 3, 0.0)] };
    assert_eq!(network.search(0, 3).unwrap(), [0, 2, 3]);
}

proptest! {
    #![proptest_config(cases(100))]
    #[test]
    fn ways_are_as_cheap_as_can_be(
        landmarks in 1..12usize,
        roads in prop::collection::vec((0..12u32, 0..12u32, 0..9u8), 0..30),
    ) {
        let inside = |&(a, b, _): &(u32, u32, u8)| (a.max(b) as usize) < landmarks;
        let roads = roads.into_iter().filter(inside).map(|(a, b, cost)| (a, b, f64::from(cost))).collect();
        let network = Network { landmarks, roads };
        let costs = network.costs();
        for (from, row) in (0..).zip(&costs) {
            for (to, &least) in (0..).zip(row) {
                let Some(way) = network.search(from, to) else {
                    prop_assert_eq!(least, f64::INFINITY);
                    continue;
                };
                prop_assert_eq!((way[0], *way.last().unwrap()), (from, to));
                let leg = |two: &[u32]| {
                    let roads = network.roads_from(LandmarkId(two[0])).filter(|road| road.0.0 == two[1]);
                    roads.map(|road| road.1).fold(f64::INFINITY, f64::min)
                };
                // Whole numbers: no rounding.
                prop_assert_eq!(way.windows(2).map(leg).sum::<f64>(), least);
            }
        }
    }
}
