use super::*;
use crate::fixtures::{counts_of, log_of, looks, scattered};
use crate::{Mapper, MapperParams, Method, Silent};

/// Looks into a long hall, in which so many pairs of landmarks far from each other have the same number.
fn aliased(pairs: usize) -> Vec<Vec<usize>> {
    let extent = [1.0, 16.0];
    let truth = scattered(240, extent, 4);
    let mut order: Vec<usize> = (0..240).collect();
    order.sort_by(|&a, &b| truth[a][1].total_cmp(&truth[b][1]));
    let mut number: Vec<usize> = (0..240).collect();
    for k in 0..pairs {
        // A range is 9 landmarks long.
        number[order[140 + 40 * k]] = order[10 + 40 * k];
    }
    let mut all = looks(&truth, extent, 0.6, 6000);
    for look in &mut all {
        look.iter_mut().for_each(|i| *i = number[*i]);
        look.sort_unstable();
        look.dedup();
    }
    all.retain(|look| look.len() > 1);
    all
}

fn names(looks: &[Vec<usize>]) -> SightingLog {
    SightingLog::from_steps(looks.iter().map(|look| look.iter().map(usize::to_string).collect::<Vec<_>>()))
}

#[test]
fn ids_in_two_places_are_found_and_no_others() {
    for pairs in [1, 3] {
        let log = names(&aliased(pairs));
        let found = find(&counts_of(&log));
        assert_eq!(found.len(), pairs);
        for alias in &found {
            assert_eq!(alias.bundles.len(), 2);
        }
    }
    assert_eq!(find(&counts_of(&names(&aliased(0)))), []);
}

#[test]
fn clean_logs_and_small_ones_have_none() {
    for seed in 0..4 {
        let truth = scattered(100, [1.0, 5.0], seed);
        let log = log_of(&looks(&truth, [1.0, 5.0], 0.6, 1500));
        assert_eq!(find(&counts_of(&log)), []);
        // With few steps company is patchy.
        let log = log_of(&looks(&truth, [1.0, 5.0], 0.6, 60));
        assert_eq!(find(&counts_of(&log)), []);
    }
    for steps in [vec![], vec![vec!["A"]], vec![vec!["A", "B"]; 9]] {
        assert_eq!(find(&counts_of(&SightingLog::from_steps(steps))), []);
    }
}

#[test]
fn parts_that_one_id_joins_are_not_said_to_lie_apart() {
    let mut steps = vec![vec!["A", "B", "C", "hinge"]; 5];
    steps.extend(vec![vec!["X", "Y", "Z", "hinge"]; 5]);
    assert_eq!(find(&counts_of(&SightingLog::from_steps(steps.clone()))), []);
    // A long way round says that they do: B, 1, 2, X is three sightings long.
    for pair in [["B", "1"], ["1", "2"], ["2", "X"]] {
        steps.extend(vec![pair.to_vec(); 3]);
    }
    let log = SightingLog::from_steps(steps.clone());
    let found = find(&counts_of(&log));
    // Names in order of appearance: A B C hinge X Y Z.
    assert_eq!(found, [Alias { landmark: LandmarkId(3), bundles: vec![vec![0, 1, 2], vec![4, 5, 6]] }]);
    // One sighting less, and they may be neighbours.
    steps.extend(vec![vec!["1", "X"]; 3]);
    assert_eq!(find(&counts_of(&SightingLog::from_steps(steps))), []);
}

#[test]
fn every_sighting_goes_to_the_copy_whose_company_is_there() {
    let alias = Alias { landmark: LandmarkId(0), bundles: vec![vec![1, 2], vec![3, 4]] };
    let log = SightingLog::from_steps([
        vec!["A", "b", "c"],
        vec!["A", "d", "e"],
        vec!["A", "b", "d", "e"],
        vec!["A"],
        vec!["d", "A#1"],
    ]);
    let after = split(&log, &[alias]).unwrap();
    let step =
        |t: usize| after.step(t).iter().map(|&i| after.names().name(LandmarkId(i))).collect::<Vec<_>>();
    // `A#1` is taken.
    assert_eq!(step(0), ["A##1", "b", "c"]);
    assert!(step(1).contains(&"A##2") && step(2).contains(&"A##2"));
    assert_eq!(step(3), ["A##1"]);
    assert!(step(4).contains(&"A#1"));
}

#[test]
fn a_map_of_aliased_ids_is_as_good_as_one_without() {
    let looks = aliased(3);
    let build = |method, split_aliases| {
        let mut params = MapperParams { method, ..MapperParams::default() };
        params.auto.split_aliases = split_aliases;
        Mapper::new(params).unwrap().build(&names(&looks), &Silent).unwrap()
    };
    let map = build(Method::Auto, true);
    // 240 places, of which three pairs have one ID.
    assert_eq!(map.len(), 240);
    let warning = map.report().warnings.iter().find(|warning| warning.kind == "aliases").unwrap();
    assert_eq!((warning.count, warning.examples.len()), (3, 3));
    let name = &warning.examples[0];
    let place = |id: String| {
        let number = map.names().iter().position(|other| other == id).unwrap();
        map.landmarks()[number].position
    };
    let [a, b] = [place(format!("{name}#1")), place(format!("{name}#2"))];
    // They are several ranges apart, as their ends of the hall are.
    assert!((a[0] - b[0]).hypot(a[1] - b[1]) > 4.0 * map.sensing().unwrap().sensor(0).range);
    // Unless asked for, IDs are told and left as they are; the paper's method takes IDs for landmarks.
    let whole = build(Method::Auto, false);
    let told = whole.report().warnings.iter().find(|warning| warning.kind == "aliases").unwrap();
    assert_eq!((whole.len(), told.count), (237, 3));
    assert_eq!(build(Method::Classical, true).len(), 237);
}
