//! `covimap info`.

use crate::scratch::Scratch;

#[test]
fn a_map_is_described_for_people() {
    let scratch = Scratch::with_map();
    let run = scratch.succeeds(&["info", "square.map.json"]);
    assert_eq!(run.stderr, "");
    assert!(run.stdout.starts_with("square.map.json: method auto, seed 0\n4 landmarks in 1 component"));
    assert!(run.stdout.contains("component  landmarks  regions  pairs  stress-1"), "{}", run.stdout);
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
