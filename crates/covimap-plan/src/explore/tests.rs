use std::sync::Arc;

use covimap_map::{
    BuildReport, ComponentReport, GlobalMap, Hinge, SeamReport, SeamsReport, Sensing, SensorModel,
};

use super::*;
use crate::Localiser;
use crate::fixtures::{index_of, lines_among, map_of, scattered};

const SENSOR: SensorModel =
    SensorModel { range: 0.5, edge: 0.05, detectability: 0.8, outliers: 0.01, warp: 0.0 };

/// The map with a sensor of range 0.5 and one detectability for all.
fn sensed(map: GlobalMap, components: usize) -> MapIndex {
    let n = map.len();
    let sensing = Sensing::from_parts(vec![SENSOR; components], vec![0.8; n], vec![0.1; n], &[]).unwrap();
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

/// A row of landmarks a range apart, each seen so often, with lines of sight from each to the next.
fn row(sightings: &[u32]) -> Arc<MapIndex> {
    let placed: Vec<_> = (0..sightings.len()).map(|k| ([0.5 * k as f64, 0.0], 0)).collect();
    let lines: Vec<_> = (1..sightings.len() as u32).map(|k| (k - 1, k, 1)).collect();
    let map = changed(&map_of(&placed, &lines), |k, placed| placed.sightings = sightings[k], vec![]);
    Arc::new(sensed(map, 1))
}

/// What the explorer says to looks, by ID.
fn walk(explorer: &mut Explorer, index: &MapIndex, looks: &[&[&str]]) -> Vec<Option<String>> {
    let mut next = |look: &&[&str]| explorer.next(look.iter().copied()).map(|id| index.name(id).to_owned());
    looks.iter().map(&mut next).collect()
}

#[test]
fn the_explorer_is_sent_over_lines_of_sight_to_what_was_seen_little() {
    let index = row(&[20, 20, 20, 20, 20, 5]);
    let mut explorer = Explorer::new(Arc::clone(&index)).unwrap();
    // It sees the way as far as L1, then farther and farther; the goal ends the errand with the fifth look at it.
    let looks: [&[&str]; 9] = [
        &["L0", "L1"],
        &["L1", "L2"],
        &["L2", "L4", "new"],
        &["L4", "L5"],
        &["L5"],
        &["L5", "L4"],
        &["L5"],
        &["L5"],
        &["L4"],
    ];
    let said = walk(&mut explorer, &index, &looks);
    let wanted = ["L1", "L2", "L4", "L5", "L5", "L5", "L5"].map(|id| Some(id.to_owned()));
    assert_eq!(said[..7], wanted);
    assert_eq!(said[7..], [None, None]);
}

#[test]
fn without_need_or_sight_the_explorer_wanders() {
    // Five of twenty are few, six are not.
    for (fewest, sent) in [(5, true), (6, false)] {
        let index = row(&[20, 20, 20, fewest]);
        let said = walk(&mut Explorer::new(Arc::clone(&index)).unwrap(), &index, &[&["L0"]]);
        assert_eq!(said[0].is_some(), sent, "{fewest}");
    }
    // Too early: the median landmark was seen in seven steps.
    let index = row(&[7, 7, 7, 1]);
    let mut explorer = Explorer::new(Arc::clone(&index)).unwrap();
    assert_eq!(walk(&mut explorer, &index, &[&["L0"], &[]]), [None, None]);
    // One more look at two of the four makes the median eight.
    assert_eq!(walk(&mut explorer, &index, &[&["L1", "L2"]]), [Some("L2".to_owned())]);
}

#[test]
fn news_put_errands_off() {
    let index = row(&[20, 20, 20, 1]);
    let mut explorer = Explorer::new(Arc::clone(&index)).unwrap();
    assert_eq!(walk(&mut explorer, &index, &[&["L0", "new"]]), [None]);
    let said = walk(&mut explorer, &index, &[&["L0"] as &[&str]; 30]);
    assert!(said[..28].iter().all(Option::is_none) && said[29].is_some(), "{said:?}");
}

#[test]
fn an_errand_is_given_up_when_it_leads_nowhere() {
    let index = row(&[20, 20, 20, 20, 20, 1]);
    // Out of sight of the way.
    let mut explorer = Explorer::new(Arc::clone(&index)).unwrap();
    let said = walk(&mut explorer, &index, &[&["L3"], &[], &["L3"]]);
    assert_eq!(said, [Some("L3".to_owned()), None, None]);
    // Stuck: the way from L3 to L5 is two ranges long, 12 + 2 * 7 looks; then ten looks of rest.
    let mut explorer = Explorer::new(Arc::clone(&index)).unwrap();
    let said = walk(&mut explorer, &index, &[&["L3"] as &[&str]; 60]);
    let turns: Vec<bool> = said.iter().map(Option::is_some).collect();
    assert_eq!(turns[..26], [true; 26]);
    assert_eq!(turns[26..36], [false; 10]);
    assert!(turns[36]);
}

#[test]
fn an_errand_outlives_a_new_map_that_has_its_way() {
    let index = row(&[20, 20, 20, 20, 1]);
    let mut explorer = Explorer::new(Arc::clone(&index)).unwrap();
    assert_eq!(walk(&mut explorer, &index, &[&["L0"]]), [Some("L0".to_owned())]);
    // By the newer map there is no need any more, but one does not turn back half-way.
    let newer = row(&[20, 20, 20, 20, 20]);
    explorer.adopt(Arc::clone(&newer)).unwrap();
    assert_eq!(walk(&mut explorer, &newer, &[&["L1", "L2"]]), [Some("L2".to_owned())]);
    // A map without the goal ends it; one without a sensor is refused.
    explorer.adopt(row(&[20, 20, 20])).unwrap();
    assert_eq!(walk(&mut explorer, &newer, &[&["L1", "L2"]]), [None]);
    let refusal = explorer.adopt(Arc::new(index_of(&[[0.0; 2]], &[]))).unwrap_err();
    assert!(matches!(refusal, PlanError::NoSensor { landmarks: 1 }));
    assert!(Explorer::new(Arc::new(index_of(&[], &[]))).is_err());
}
