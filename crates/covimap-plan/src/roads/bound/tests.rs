use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::*;
use crate::fixtures::{empty, index_of, lines_among, scattered};
use crate::search::{AStar, RouteSearch, SearchGraph};
use crate::{MapIndex, Objective, RoadParams, Roads};

/// A map of landmarks at random, about twenty roads across for 600 of them.
fn index(n: usize) -> MapIndex {
    let points = scattered(n, 7);
    index_of(&points, &lines_among(&points, 6))
}

/// Roads that cost something to begin with and then their length, save for a few that are cheap; the same both ways.
fn costs(map: &GlobalMap) -> Vec<f64> {
    let mut rng = ChaCha8Rng::seed_from_u64(4);
    let n = map.len() as u32;
    let mut cheap = std::collections::BTreeMap::new();
    let mut costs = Vec::new();
    for from in (0..n).map(LandmarkId) {
        for line in map.sight_lines().of(from) {
            let [a, b] = [from, line.to].map(|id| map.landmarks()[id.index()].position);
            let pair = (from.min(line.to), from.max(line.to));
            let factor = cheap.entry(pair).or_insert_with(|| if rng.random_bool(0.02) { 0.1 } else { 1.0 });
            costs.push(*factor * (0.05 + distance(a, b)));
        }
    }
    costs
}

/// All that the lines of sight join, at these costs, with nothing known of what is far.
struct Blind<'a>(Priced<'a>);

impl SearchGraph for Blind<'_> {
    fn landmarks(&self) -> usize {
        self.0.map.len()
    }

    fn roads_from(&self, from: LandmarkId) -> impl Iterator<Item = (LandmarkId, f64)> {
        self.0.from(from.0).map(|(to, cost)| (LandmarkId(to), cost))
    }

    fn at_least(&self, _: LandmarkId, _: LandmarkId) -> f64 {
        0.0
    }
}

#[test]
fn no_way_costs_less_and_cheap_roads_do_not_spoil_it() {
    let index = index(600);
    let costs = costs(index.map());
    let bound = Bound::of_costs(index.map(), &costs);
    let roads = Blind(Priced { map: index.map(), costs: &costs });
    let (mut told, mut true_costs) = (0.0, 0.0);
    for k in 0..200 {
        let [from, to] = [k * 3 % 600, (k * 7 + 300) % 600].map(LandmarkId);
        let way = AStar.search(&roads, from, to).unwrap();
        let leg = |leg: &[LandmarkId]| roads.roads_from(leg[0]).find(|road| road.0 == leg[1]).unwrap().1;
        let cost: f64 = way.windows(2).map(leg).sum();
        assert!(bound.at_least(from, to) <= cost * (1.0 + 1e-12), "{from:?} {to:?}");
        told += bound.at_least(from, to);
        true_costs += cost;
    }
    // By positions alone the cheapest road decides.
    let plain = roads.0.least_rate(&positions(index.map()));
    assert!(bound.rate > 4.0 * plain, "{} {plain}", bound.rate);
    assert!(told > 0.5 * true_costs, "{told} of {true_costs}");
}

#[test]
fn landmarks_stay_near_their_positions() {
    let index = index(600);
    let bound = Bound::of_costs(index.map(), &costs(index.map()));
    let moved = bound.places.iter().zip(positions(index.map())).map(|(&a, b)| distance(a, b));
    let (mut lengths, mut roads) = (0.0, 0.0);
    for (a, b, _) in index.map().sight_lines().pairs() {
        lengths += distance(index.placed(a).position, index.placed(b).position);
        roads += 1.0;
    }
    let mean = moved.sum::<f64>() / 600.0;
    // A third of a road was found.
    assert!(mean < 0.5 * lengths / roads, "{mean} {}", lengths / roads);
}

#[test]
fn it_is_the_length_where_roads_cost_that() {
    let index = index(50);
    let bound = Bound::of_lengths(index.map());
    let [a, b] = [3, 40].map(LandmarkId);
    assert_eq!(bound.at_least(a, b), distance(index.placed(a).position, index.placed(b).position));
    let order: Vec<LandmarkId> = (0..50).rev().map(LandmarkId).collect();
    assert_eq!(bound.reordered(&order).at_least(LandmarkId(9), LandmarkId(46)), bound.at_least(b, a));
}

#[test]
fn no_landmarks_no_roads_and_landmarks_at_one_place() {
    assert_eq!(Bound::of_costs(empty().map(), &[]).rate, 0.0);
    let pile = index_of(&[[1.0; 2]; 3], &[(0, 1, 2), (1, 2, 2)]);
    let bound = Bound::of_costs(pile.map(), &[0.5; 4]);
    assert_eq!(bound.at_least(LandmarkId(0), LandmarkId(2)), 0.0);
    let roads = Roads::new(&pile, RoadParams { objective: Objective::Safest, min_steps: 1 }).unwrap();
    assert_eq!(roads.route("L0", "L2").unwrap().landmarks.len(), 3);
}
