use proptest::prelude::*;

use super::*;
use crate::fixtures::{cases, empty, index_of, map_of, scattered, square_and_pair};

fn numbers(found: &[Near]) -> Vec<u32> {
    found.iter().map(|near| near.landmark.0).collect()
}

/// All landmarks by their distance from a place, the slow way.
fn by_distance(index: &MapIndex, place: Point) -> Vec<Near> {
    let landmarks = (0..index.map().len() as u32).map(LandmarkId);
    let mut all: Vec<Near> = landmarks
        .map(|landmark| {
            let [x, y] = index.placed(landmark).position;
            Near { landmark, distance: ((x - place[0]).powi(2) + (y - place[1]).powi(2)).sqrt() }
        })
        .collect();
    all.sort_by(|a, b| a.distance.total_cmp(&b.distance).then(a.landmark.cmp(&b.landmark)));
    all
}

#[test]
fn landmarks_are_named_by_id_or_number() {
    let index = square_and_pair();
    assert_eq!(index.id("L2").unwrap(), LandmarkId(2));
    assert_eq!(index.id(String::from("L2")).unwrap(), LandmarkId(2));
    assert_eq!(index.landmark(LandmarkId(5)).unwrap().position, [0.5, 0.0]);
    assert_eq!(index.name(LandmarkId(5)), "L5");
    assert_eq!(
        index.id("L22").unwrap_err().to_string(),
        "the map has no landmark \"L22\"; did you mean \"L2\"?"
    );
    assert_eq!(
        index.id("window").unwrap_err().to_string(),
        "the map has no landmark \"window\"; `covimap export --to csv` lists the IDs"
    );
    assert_eq!(
        index.id(LandmarkId(6)).unwrap_err().to_string(),
        "the map has no landmark number 6, it has 6; numbers count from 0"
    );
}

#[test]
fn components_do_not_see_each_other() {
    let index = square_and_pair();
    assert_eq!(numbers(&index.nearest("L0", 9).unwrap()), [1, 3, 2]);
    assert_eq!(numbers(&index.nearest("L4", 9).unwrap()), [5]);
    assert_eq!(numbers(&index.within("L4", 9.0).unwrap()), [5]);
    assert_eq!(numbers(&index.nearest_to(1, [0.4, 0.0], 9).unwrap()), [5, 4]);
    assert_eq!(index.components().collect::<Vec<_>>(), [0, 1]);
    assert_eq!(index.component(1).unwrap(), [LandmarkId(4), LandmarkId(5)]);
    assert_eq!(index.region(0).len(), 4);
    assert_eq!(index.region(1), [LandmarkId(4), LandmarkId(5)]);
    assert_eq!(index.region(2), []);
    assert_eq!(
        index.component(2).unwrap_err().to_string(),
        "the map has no component 2, it has 2; numbers count from 0"
    );
}

#[test]
fn equally_near_landmarks_come_by_number() {
    // Four at distance 1 of L0, two at the place of L0.
    let points = [[0.0, 0.0], [0.0, 1.0], [1.0, 0.0], [0.0, -1.0], [-1.0, 0.0], [0.0; 2], [0.0; 2]];
    let index = index_of(&points, &[]);
    for k in 0..8 {
        assert_eq!(numbers(&index.nearest("L0", k).unwrap()), [5, 6, 1, 2, 3, 4][..k.min(6)], "{k}");
    }
    assert_eq!(numbers(&index.within("L0", 1.0).unwrap()), [5, 6, 1, 2, 3, 4]);
    assert_eq!(numbers(&index.within("L0", 0.0).unwrap()), [5, 6]);
    assert_eq!(index.nearest("L1", 1).unwrap(), [Near { landmark: LandmarkId(0), distance: 1.0 }]);
}

#[test]
fn small_and_degenerate_maps() {
    assert_eq!(empty().components().count(), 0);
    assert!(matches!(
        empty().nearest_to(0, [0.0; 2], 1),
        Err(PlanError::UnknownComponent { component: 0, components: 0 })
    ));
    let one = index_of(&[[2.0, 3.0]], &[]);
    assert!(one.nearest("L0", 5).unwrap().is_empty());
    assert!(one.neighbours("L0").unwrap().is_empty());
    let two = index_of(&[[0.0; 2]; 2], &[]);
    assert_eq!(two.nearest("L0", 5).unwrap(), [Near { landmark: LandmarkId(1), distance: 0.0 }]);
    assert_eq!(two.neighbours("L0").unwrap(), [LandmarkId(1)]);
    let line: Vec<Point> = (0..5).map(|i| [f64::from(i), 0.0]).collect();
    let line = index_of(&line, &[]);
    assert_eq!(line.neighbours("L2").unwrap(), [LandmarkId(1), LandmarkId(3)]);
    assert_eq!(numbers(&line.nearest("L0", 2).unwrap()), [1, 2]);
}

#[test]
fn places_and_radii_that_are_none_are_refused() {
    let index = square_and_pair();
    assert_eq!(
        index.nearest_to(0, [f64::NAN, 0.0], 1).unwrap_err().to_string(),
        "the place is (NaN, 0), coordinates must be finite"
    );
    assert!(matches!(index.within_of(0, [0.0, f64::INFINITY], 1.0), Err(PlanError::Nowhere { .. })));
    for radius in [-1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(index.within("L0", radius), Err(PlanError::BadRadius { .. })));
    }
    assert_eq!(
        index.within("L0", -1.0).unwrap_err().to_string(),
        "the radius is -1; give a finite one of 0 or more, in the units of the map"
    );
}

#[test]
fn many_questions_are_answered_as_one_by_one_and_the_first_error_is_told() {
    let index = index_of(&scattered(60, 3), &[]);
    let ids: Vec<LandmarkId> = (0..60).map(LandmarkId).collect();
    let all = index.nearest_of_each(&ids, 4).unwrap();
    let within = index.within_of_each(&ids, 0.2).unwrap();
    for (&id, (near, inside)) in ids.iter().zip(all.iter().zip(&within)) {
        assert_eq!(near, &index.nearest(id, 4).unwrap());
        assert_eq!(inside, &index.within(id, 0.2).unwrap());
    }
    let refused = index.nearest_of_each(&["L0", "nowhere", "elsewhere"], 1).unwrap_err();
    assert!(matches!(refused, PlanError::UnknownLandmark { id, .. } if id == "nowhere"));
}

#[test]
fn threads_share_an_index() {
    fn shared<T: Send + Sync + 'static>(_: &T) {}
    shared(&Arc::new(square_and_pair()));
}

#[test]
fn many_threads_may_be_the_first_to_ask() {
    // Few questions for many threads: those without one help with what the questions need first.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(8).build().unwrap();
    let map = index_of(&scattered(20_000, 3), &[]).map().clone();
    let triples: Vec<[LandmarkId; 3]> =
        (0..12).map(|k| [3 * k, 3 * k + 1, 3 * k + 2].map(LandmarkId)).collect();
    let alone = MapIndex::new(map.clone());
    let one_by_one: Vec<_> = triples.iter().map(|&[a, b, c]| alone.orientation(a, b, c).unwrap()).collect();
    for _ in 0..20 {
        let asked = |index: &MapIndex| {
            triples.par_iter().map(|&[a, b, c]| index.orientation(a, b, c).unwrap()).collect::<Vec<_>>()
        };
        let fresh = MapIndex::new(map.clone());
        assert_eq!(pool.install(|| asked(&fresh)), one_by_one);
        let fresh = MapIndex::new(map.clone());
        assert_eq!(pool.install(|| fresh.orientation_of_each(&triples).unwrap()), one_by_one);
        let fresh = MapIndex::new(map.clone());
        let near = pool
            .install(|| triples.par_iter().map(|ids| fresh.neighbours(ids[0]).unwrap().len()).sum::<usize>());
        assert!(near > 24);
    }
}

#[test]
fn delaunay_neighbours_are_those_of_each_component() {
    let points = scattered(80, 9);
    let placed: Vec<_> = points.iter().enumerate().map(|(i, &point)| (point, i as u32 % 2)).collect();
    let index = MapIndex::new(Arc::new(map_of(&placed, &[])));
    for component in [0, 1] {
        let members: Vec<u32> = (0..80).filter(|i| i % 2 == component).collect();
        let places: Vec<Point> = members.iter().map(|&i| points[i as usize]).collect();
        let edges = covimap_map::delaunay_edges(&places).unwrap();
        for (place, &member) in (0..).zip(&members) {
            let wanted: Vec<LandmarkId> = (0..40)
                .filter(|&other| edges.contains(&(place, other)) || edges.contains(&(other, place)))
                .map(|other| LandmarkId(members[other as usize]))
                .collect();
            assert_eq!(index.neighbours(LandmarkId(member)).unwrap(), wanted);
        }
    }
}

proptest! {
    #![proptest_config(cases(40))]
    #[test]
    fn nearest_and_within_agree_with_looking_at_everything(
        // A coarse grid, so that many are equally near and some coincide.
        places in prop::collection::vec((0..6u8, 0..6u8), 1..50),
        at in (-1.0..7.0f64, -1.0..7.0f64),
        k in 0..60usize,
        radius in 0.0..5.0f64,
    ) {
        let points: Vec<Point> = places.iter().map(|&(x, y)| [f64::from(x), f64::from(y)]).collect();
        let index = index_of(&points, &[]);
        for place in [[at.0, at.1], [at.0.round(), at.1.round()]] {
            let all = by_distance(&index, place);
            prop_assert_eq!(numbers(&index.nearest_to(0, place, k).unwrap()), numbers(&all[..k.min(all.len())]));
            let inside: Vec<Near> = all.iter().copied().filter(|near| near.distance <= radius).collect();
            prop_assert_eq!(numbers(&index.within_of(0, place, radius).unwrap()), numbers(&inside));
        }
    }
}
