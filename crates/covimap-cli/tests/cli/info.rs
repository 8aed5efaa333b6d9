//! `covimap info`.

use crate::scratch::{Scratch, robot_log};

#[test]
fn a_map_is_described_for_people() {
    let scratch = Scratch::with_map();
    let run = scratch.succeeds(&["info", "square.map.json"]);
    assert_eq!(run.stderr, "");
    assert!(run.stdout.starts_with("square.map.json: method auto, seed 0\n4 landmarks in 1 component"));
    assert!(run.stdout.contains("component  landmarks  regions  pairs  stress-1"), "{}", run.stdout);
}

#[test]
fn the_distance_function_is_told_in_words() {
    let scratch = Scratch::new();
    scratch.file("robot.jsonl", robot_log());
    let told = |options: &[&str]| {
        scratch.succeeds(&[&["build", "robot.jsonl", "-q"], options].concat());
        scratch.succeeds(&["info", "robot.map.json"]).stdout
    };
    let learnt = told(&["--distance", "power"]);
    for words in [
        "distance function: power, f = 0.",
        "learnt from 83 pairs\n  log-likelihood held out, below the best: power 0.0\n",
        "steps tell as much as one independent look",
        "% of the pairs look farther apart than they are, as if across walls",
        "frequency  expected  map 10 %  map 50 %  map 90 %\n",
    ] {
        assert!(learnt.contains(words), "{words}: {learnt}");
    }
    let fixed = told(&["--distance", "fixed-log"]);
    assert!(fixed.contains("distance function: log, f = 1.000 exp(-(d / 0.548)^2), not learnt\n"), "{fixed}");
}

#[test]
fn a_map_is_described_for_programs() {
    let scratch = Scratch::with_map();
    let object = scratch.succeeds(&["info", "square.map.json", "--json"]).json();
    assert_eq!(object["landmarks"], 4);
    assert_eq!(object["settings"]["method"], "auto");
    assert_eq!(object["report"]["pairs"], 5);
}

#[test]
fn a_map_can_come_from_stdin() {
    let scratch = Scratch::with_map();
    let map = scratch.read("square.map.json");
    let mut command = scratch.command(&["info", "-", "--json"]);
    command.write_stdin(map).assert().success();
}
