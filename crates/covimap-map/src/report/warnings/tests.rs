use super::*;
use crate::SightingLog;
use crate::fixtures::counts_of;

fn component(landmarks: u64, converged: bool) -> ComponentReport {
    ComponentReport {
        landmarks,
        regions: 1,
        pairs: 1,
        stress1: 0.1,
        iterations: 1,
        converged,
        distances: None,
    }
}

/// Kind, count and examples of the warnings about a log.
fn about(steps: &[&[&str]], components: &[ComponentReport]) -> Vec<(String, u64, Vec<String>)> {
    let log = SightingLog::from_steps(steps.iter().map(|step| step.iter().copied()));
    let counts = counts_of(&log);
    warnings(&counts, &LinkGraph::from_counts(&counts), HonestyReport::default(), components, log.names())
        .into_iter()
        .map(|warning| (warning.kind, warning.count, warning.examples))
        .collect()
}

fn warning(kind: &str, count: u64, examples: &[&str]) -> (String, u64, Vec<String>) {
    (kind.to_owned(), count, examples.iter().map(|&id| id.to_owned()).collect())
}

/// Every two of five landmarks twice, in different company: nothing to warn of.
const SOUND: [&[&str]; 5] =
    [&["A", "B", "C"], &["B", "C", "D"], &["C", "D", "E"], &["D", "E", "A"], &["E", "A", "B"]];

fn sound_and(more: &[&'static [&'static str]]) -> Vec<&'static [&'static str]> {
    SOUND.iter().chain(more).copied().collect()
}

#[test]
fn a_sound_log_gets_no_warning() {
    assert_eq!(about(&SOUND, &[component(5, true)]), []);
}

#[test]
fn landmarks_seen_once() {
    let steps = sound_and(&[&["F", "A", "B", "C"], &["D", "A"]]);
    assert_eq!(about(&steps, &[component(6, true)]), [warning("seen_once", 1, &["F"])]);
}

#[test]
fn landmarks_seen_by_themselves() {
    let steps = sound_and(&[&["F"], &["F"]]);
    let components = [component(5, true), component(1, true)];
    assert_eq!(
        about(&steps, &components),
        [warning("never_together", 1, &["F"]), warning("components", 2, &[])]
    );
}

#[test]
fn landmarks_with_one_or_two_partners() {
    let steps = sound_and(&[&["F", "A"], &["F", "B"], &["G", "C"], &["G"]]);
    assert_eq!(about(&steps, &[component(7, true)]), [warning("few_partners", 2, &["F", "G"])]);
    // With three partners all is well.
    let steps = sound_and(&[&["F", "A"], &["F", "B"], &["F", "C"]]);
    assert_eq!(about(&steps, &[component(6, true)]), []);
}

#[test]
fn landmarks_that_are_always_seen_together() {
    let steps = sound_and(&[&["F", "G", "A", "B"], &["F", "G", "C"]]);
    assert_eq!(about(&steps, &[component(7, true)]), [warning("twins", 2, &["F", "G"])]);
    // Once without the other and they can be told apart.
    let steps = sound_and(&[&["F", "G", "A", "B"], &["F", "G", "C"], &["F", "D"]]);
    assert_eq!(about(&steps, &[component(7, true)]), []);
}

#[test]
fn components_that_did_not_converge() {
    let components = [component(5, false), component(4, true), component(3, false)];
    let found = about(&SOUND, &components);
    assert_eq!(found, [warning("components", 3, &[]), warning("not_converged", 2, &[])]);
}

#[test]
fn maps_of_three_landmarks_or_fewer() {
    let steps: [&[&str]; 4] = [&["A", "B", "C"], &["A", "B"], &["B", "C"], &["A", "C"]];
    assert_eq!(about(&steps, &[component(3, true)]), [warning("too_few_landmarks", 1, &[])]);
}

#[test]
fn ten_examples_are_named_and_the_rest_counted() {
    let ids: Vec<String> = (0..25).map(|k| format!("lone{k}")).collect();
    let steps: Vec<[&str; 1]> = ids.iter().flat_map(|id| [[id.as_str()], [id.as_str()]]).collect();
    let steps: Vec<&[&str]> = steps.iter().map(|step| step.as_slice()).collect();
    let found = about(&[&steps[..], &SOUND].concat(), &[component(5, true)]);
    let named: Vec<&str> = ids[..10].iter().map(String::as_str).collect();
    assert_eq!(found, [warning("never_together", 25, &named)]);
}

#[test]
fn misrecognition_is_told_where_it_is_notable() {
    let log = SightingLog::from_steps(SOUND.iter().map(|step| step.iter().copied()));
    let counts = counts_of(&log);
    let found = |misrecognition, set_aside| {
        let honesty = HonestyReport { set_aside, misrecognition };
        warnings(&counts, &LinkGraph::from_counts(&counts), honesty, &[component(5, true)], log.names())
    };
    let warning = &found(Some(0.0213), 412)[0];
    assert_eq!((warning.kind.as_str(), warning.count, warning.examples.len()), ("misrecognition", 412, 0));
    assert!(warning.message.contains("about 2.1 % of the sightings"), "{}", warning.message);
    for silent in [found(None, 0), found(Some(0.0), 0), found(Some(0.0019), 12)] {
        assert_eq!(silent, []);
    }
}
