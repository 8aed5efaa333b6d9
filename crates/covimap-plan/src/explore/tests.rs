use std::sync::Arc;

use covimap_map::{
    BuildReport, ComponentReport, GlobalMap, Hinge, SeamReport, SeamsReport, Sensed, Sensing, SensorModel,
};

use super::*;
use crate::Localiser;
use crate::fixtures::{index_of, lines_among, map_of, scattered};

const SENSOR: SensorModel = SensorModel { range: 0.5, edge: 0.05, detectability: 0.8, outliers: 0.01 };
const SENSED: Sensed = Sensed { detectability: 0.8, deviation: 0.1, warp: 0.0 };

/// The map with a sensor of range 0.5 and one detectability for all.
fn sensed(map: GlobalMap, components: usize) -> MapIndex {
    let n = map.len();
    let sensing = Sensing::from_parts(vec![SENSOR; components], vec![SENSED; n], &[]).unwrap();
    MapIndex::new(Arc::new(map.with_sensing(sensing).unwrap()))
}

/// The same map with other numbers of sightings, regions and hinges.
fn changed(
    map: &GlobalMap,
    change: impl Fn(usize, &mut covimap_map::PlacedLandmark),
    hinges: Vec<Hinge>,
) -> GlobalMap {
    let mut landmarks = map.landmarks().to_vec();
    landmarks.iter_mut().enumerate().for_each(|(i, placed)| change(i, placed));
    let seams = SeamsReport { hinges, ..SeamsReport::default() };
    let component = ComponentReport { seams, ..ComponentReport::default() };
    let report = BuildReport { steps: 100, components: vec![component], ..BuildReport::default() };
    GlobalMap::from_parts(map.names().clone(), landmarks, map.params().clone(), report)
        .unwrap()
        .with_sight_lines(map.sight_lines().clone())
        .unwrap()
}

fn ids(goals: &[Goal]) -> Vec<&str> {
    goals.iter().map(|goal| goal.id.as_str()).collect()
}

#[test]
fn the_gain_of_a_visit_is_what_it_takes_away_from_the_variances() {
    // Two landmarks 0.3 apart, well within the range of 0.5, and one far away.
    let points = [[0.0, 0.0], [0.3, 0.0], [5.0, 0.0]];
    let map = map_of(&points.map(|point| (point, 0)), &[(0, 1, 40), (1, 2, 1)]);
    let index = sensed(map, 1);
    let goals = next_best(&index, None, 9, ExploreParams::default()).unwrap();
    let goal = goals.iter().find(|goal| goal.id != "L2").unwrap();
    // Each was seen 100 times; ten looks show the one in 8 v(0) = 8 / (1 + e^-10), the other in
    // 8 v(.3) = 8 / (1 + e^-4).
    let more = [0.0, 0.3].map(|d: f64| 8.0 / (1.0 + ((d - 0.5) / 0.05).exp()));
    let variance = |k: u32| index.covariance_of(LandmarkId(k)).deviation().powi(2);
    let own = if goal.id == "L0" { 0 } else { 1 };
    let taken = variance(own) * more[0] / (100.0 + more[0]) + variance(1 - own) * more[1] / (100.0 + more[1]);
    let all: f64 = (0..3).map(variance).sum();
    assert!((goal.gain - taken / all).abs() < 1e-12, "{goal:?}");
}

#[test]
fn what_was_seen_little_gains_more_and_says_why() {
    // A board with a line of sight between any two squares side by side.
    let squares = (0..49).map(|k| [0.3 * f64::from(k % 7), 0.3 * f64::from(k / 7)]);
    let points: Vec<_> = squares.collect();
    let placed: Vec<_> = points.iter().map(|&point| (point, 0)).collect();
    let across = (0..49u32).filter(|k| k % 7 < 6).map(|k| (k, k + 1, 4));
    let lines: Vec<_> = across.chain((0..42).map(|k| (k, k + 7, 4))).collect();
    let of = |sightings: u32| {
        let seen = move |i: usize, placed: &mut covimap_map::PlacedLandmark| {
            placed.sightings = if i == 24 { sightings } else { 100 };
        };
        sensed(changed(&map_of(&placed, &lines), seen, vec![]), 1)
    };
    let index = of(6);
    let all = next_best(&index, None, 60, ExploreParams::default()).unwrap();
    let few: Vec<_> = all.iter().filter(|goal| goal.reasons.contains(&Reason::FewSightings)).collect();
    assert!(few.iter().all(|goal| goal.id == "L24"), "{few:?}");
    let visit = |index: &MapIndex| {
        let before: f64 = index.covariance_of(LandmarkId(24)).deviation().powi(2);
        gain(index, index.map().sensing().unwrap(), LandmarkId(24), 10.0).unwrap() / before
    };
    // 8 of 14 of its variance against 8 of 108.
    assert!(visit(&index) > visit(&of(100)) + 0.4, "{} {}", visit(&index), visit(&of(100)));
    // Goals keep a range away from each other, and the first ones are the same however many are asked for.
    let at = |id: &str| points[id[1..].parse::<usize>().unwrap()];
    for (k, a) in all.iter().enumerate() {
        for b in &all[..k] {
            assert!((at(&a.id)[0] - at(&b.id)[0]).hypot(at(&a.id)[1] - at(&b.id)[1]) >= 0.5);
        }
    }
    assert_eq!(next_best(&index, None, 4, ExploreParams::default()).unwrap(), all[..4]);
}

#[test]
fn hinges_come_first() {
    // Two squares, regions 0 and 1, joined by the line L1 - L4.
    let points =
        [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [2.0, 0.0], [3.0, 0.0], [3.0, 1.0], [2.0, 1.0]];
    let lines = [
        (0, 1, 50),
        (1, 2, 50),
        (2, 3, 50),
        (0, 3, 50),
        (4, 5, 5),
        (5, 6, 5),
        (6, 7, 5),
        (4, 7, 5),
        (1, 4, 90),
    ];
    let map = map_of(&points.map(|point| (point, 0)), &lines);
    let seam =
        SeamReport { regions: [0, 1], shared: 2, residual: 0.1, condition: 0.0, evidence: 0.5, trust: 1.0 };
    let hinge = Hinge { seam, landmarks: 4 };
    let halves = |i: usize, placed: &mut covimap_map::PlacedLandmark| placed.region = u32::from(i >= 4);
    let index = sensed(changed(&map, halves, vec![hinge]), 1);
    let goals = next_best(&index, None, 8, ExploreParams::default()).unwrap();
    let mut first = ids(&goals[..2]);
    first.sort_unstable();
    assert_eq!(first, ["L1", "L4"]);
    assert!(goals[..2].iter().all(|goal| goal.reasons[0] == Reason::Hinge));
    assert!(goals[2..].iter().all(|goal| !goal.reasons.contains(&Reason::Hinge)));
    // A hinge also keeps a map from being good enough, however certain its turns.
    let wanted = ExploreParams { error: 0.49, ..ExploreParams::default() };
    let open = forecast(&index, wanted).unwrap();
    assert_eq!((open.hinges, open.stop, open.more_steps), (1, false, 0));
    assert!(forecast(&sensed(changed(&map, halves, vec![]), 1), wanted).unwrap().stop);
}

#[test]
fn near_goals_are_worth_more_and_other_components_come_last() {
    // Four equal pairs in a row in one component, and one in another.
    let pair = |x: f64| [([x, 0.0], 0), ([x + 0.1, 0.0], 0)];
    let mut placed: Vec<_> = [0.0, 3.0, 6.0, 9.0].into_iter().flat_map(pair).collect();
    placed.extend([([0.0, 0.0], 1), ([0.1, 0.0], 1)]);
    let lines = [(0, 1, 9), (2, 3, 9), (4, 5, 9), (6, 7, 9), (8, 9, 2)];
    let index = Arc::new(sensed(map_of(&placed, &lines), 2));
    let localiser = Localiser::new(Arc::clone(&index)).unwrap();
    let here = localiser.locate(&localiser.look(["L4", "L5"]));
    let goals = next_best(&index, Some(&here), 9, ExploreParams::default()).unwrap();
    assert!(["L4", "L5"].contains(&goals[0].id.as_str()), "{goals:?}");
    let last = goals.last().unwrap();
    assert_eq!((goals.len(), last.component, last.distance), (5, 1, None));
    // Without a place the other component, whose line of sight rests on fewer steps, gains as much as it gains.
    let anywhere = next_best(&index, None, 9, ExploreParams::default()).unwrap();
    assert!(anywhere.iter().all(|goal| goal.distance.is_none()));
}

#[test]
fn four_times_the_steps_halve_the_error() {
    // e = .2 of T steps: (.2 / .1)^2 - 1 = 3 times as many more.
    let points = scattered(40, 3);
    let placed: Vec<_> = points.iter().map(|&point| (point, 0)).collect();
    let map = changed(&map_of(&placed, &lines_among(&points, 3)), |_, _| (), vec![]);
    let index = MapIndex::new(Arc::new(map));
    let now = forecast(&index, ExploreParams::default()).unwrap();
    assert!(now.error > 0.0 && now.error < 0.5);
    let half =
        forecast(&index, ExploreParams { error: now.error / 2.0, ..ExploreParams::default() }).unwrap();
    assert_eq!((half.more_steps, half.stop), (300, false));
    let same = forecast(&index, ExploreParams { error: now.error, ..ExploreParams::default() }).unwrap();
    assert_eq!((same.more_steps, same.stop), (0, true));
}

#[test]
fn maps_of_nothing_one_and_two_landmarks() {
    let params = ExploreParams::default();
    for n in 0..3 {
        let points = &[[0.0, 0.0], [0.2, 0.0]][..n];
        let told = forecast(&index_of(points, &[]), params).unwrap();
        assert_eq!((told.error, told.stop), (0.5, false));
        let placed: Vec<_> = points.iter().map(|&point| (point, 0)).collect();
        let index = sensed(map_of(&placed, &[]), 1);
        // The second is within a range of the first.
        assert_eq!(next_best(&index, None, 5, params).unwrap().len(), n.min(1));
        assert!(next_best(&index, None, 0, params).unwrap().is_empty());
    }
    let refusal = next_best(&index_of(&[[0.0; 2]], &[]), None, 1, params).unwrap_err();
    assert!(matches!(refusal, PlanError::NoSensor { landmarks: 1 }));
}

#[test]
fn settings_out_of_their_range_are_refused() {
    let index = index_of(&[], &[]);
    let refused = |params| match forecast(&index, params).unwrap_err() {
        PlanError::BadParameter { name, .. } => name,
        other => panic!("{other}"),
    };
    assert_eq!(refused(ExploreParams { looks: 0, ..ExploreParams::default() }), "explore.looks");
    for error in [0.0, 0.5, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(refused(ExploreParams { error, ..ExploreParams::default() }), "explore.error");
    }
}

/// What the explorer says to looks at the landmarks of these one-letter IDs.
fn walk(explorer: &mut Explorer, looks: &[&str]) -> Vec<Option<String>> {
    let ids = |look: &&str| look.chars().map(String::from).collect::<Vec<_>>();
    let said = |look: &&str| explorer.next(ids(look).iter().map(String::as_str)).map(str::to_owned);
    looks.iter().map(said).collect()
}

/// Looks that show nothing.
fn dark(explorer: &mut Explorer, looks: usize) {
    (0..looks).for_each(|_| assert_eq!(explorer.next([]), None));
}

#[test]
fn the_explorer_heads_for_what_came_into_sight_last() {
    let said = walk(&mut Explorer::default(), &["a", "ab", "abc", "abc", "c", "abc", ""]);
    // From its fourth look on a landmark is no news: a and b had three by the fourth look, c by the fifth.
    let wanted = ["a", "b", "c", "c", "c"].map(|id| Some(id.to_owned()));
    assert_eq!((&said[..5], &said[5..]), (&wanted[..], &[None, None][..]));
}

#[test]
fn of_landmarks_that_came_together_the_less_seen_goes_first_then_the_first_by_id() {
    let said = walk(&mut Explorer::default(), &["ba", "a", "ab", "ba", "ab"]);
    // Second look at a alone, so that b has been seen less: 1, 2 and 3 times when it is chosen.
    let wanted = ["a", "a", "b", "b"].map(|id| Some(id.to_owned()));
    assert_eq!((&said[..4], &said[4..]), (&wanted[..], &[None][..]));
}

#[test]
fn what_was_not_seen_for_a_hundred_looks_and_half_of_all_is_news_again() {
    // Four looks, then so many without: the next is look 5 + dark, and l = 4, so that t - l = 1 + dark.
    for (without, is_news) in [(98, false), (99, true)] {
        let mut explorer = Explorer::default();
        assert_eq!(walk(&mut explorer, &["a"; 4])[3], None);
        dark(&mut explorer, without);
        assert_eq!(walk(&mut explorer, &["a"])[0].is_some(), is_news, "{without}");
    }
    // After 304 looks with the last sight of a in look 204, t - l is 101 at t = 305: less than half.
    let mut explorer = Explorer::default();
    walk(&mut explorer, &["a"; 204]);
    dark(&mut explorer, 100);
    assert_eq!(walk(&mut explorer, &["a"]), [None]);
    // l = 305: at t = 609 it is 304, just less than half; the look makes l = 609, and 609 looks later t - l is half of t.
    dark(&mut explorer, 303);
    assert_eq!(walk(&mut explorer, &["a"]), [None]);
    dark(&mut explorer, 608);
    let said = walk(&mut explorer, &["a"; 4]);
    assert_eq!(said.iter().map(Option::is_some).collect::<Vec<_>>(), [true, true, true, false]);
}

#[test]
fn an_id_that_is_given_twice_counts_once() {
    let said = walk(&mut Explorer::default(), &["aa", "aaa", "aa", "aa"]);
    assert_eq!(said.iter().map(Option::is_some).collect::<Vec<_>>(), [true, true, true, false]);
}
