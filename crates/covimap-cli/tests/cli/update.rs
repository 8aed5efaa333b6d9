//! `covimap build --state` and `covimap update`.

use std::fs;

use crate::scratch::{SQUARE, Scratch, robot_log};

/// The robot's log but for its end, and the end: one step in fifty.
fn cut_log() -> Scratch {
    let scratch = Scratch::new();
    let log = robot_log();
    let lines: Vec<_> = log.split_inclusive('\n').collect();
    let cut = lines.len() * 49 / 50;
    scratch.file("first.jsonl", lines[..cut].concat());
    scratch.file("rest.jsonl", lines[cut..].concat());
    scratch
}

/// With a state and a map of the first part.
fn with_state() -> Scratch {
    let scratch = cut_log();
    scratch.succeeds(&["build", "first.jsonl", "--state", "s", "-o", "map.json", "-q"]);
    scratch
}

fn bytes(scratch: &Scratch, name: &str) -> Vec<u8> {
    fs::read(scratch.path().join(name)).unwrap()
}

#[test]
fn a_build_with_a_state_makes_the_same_map_and_one_file_more() {
    let scratch = cut_log();
    scratch.succeeds(&["build", "first.jsonl", "-o", "plain.json", "-q"]);
    scratch.succeeds(&["build", "first.jsonl", "-o", "map.json", "--state", "s", "-q"]);
    assert_eq!(scratch.read("map.json"), scratch.read("plain.json"));
    assert_eq!(scratch.names(), ["first.jsonl", "map.json", "plain.json", "rest.jsonl", "s"]);
}

#[test]
fn an_update_counts_what_a_build_of_both_logs_counts() {
    let scratch = with_state();
    let before = bytes(&scratch, "s");
    let run = scratch.succeeds(&["update", "s", "rest.jsonl", "-o", "map.json"]);
    assert!(run.stderr.contains("\nupdated with 116 new steps, 0 new landmarks: "), "{}", run.stderr);
    assert!(run.stderr.contains("\nmap written to map.json\n"), "{}", run.stderr);
    assert_eq!(run.stdout, "");
    assert_eq!(scratch.names(), ["first.jsonl", "map.json", "rest.jsonl", "s"]);
    assert_ne!(bytes(&scratch, "s"), before);
    let full = scratch.succeeds(&["build", "first.jsonl", "rest.jsonl", "-o", "-", "-q"]).json();
    let map: serde_json::Value = serde_json::from_str(&scratch.read("map.json")).unwrap();
    for key in ["steps", "sightings", "landmarks", "pairs", "honesty"] {
        assert_eq!(map["report"][key], full["report"][key], "{key}");
    }
    for (row, wanted) in
        map["landmarks"].as_array().unwrap().iter().zip(full["landmarks"].as_array().unwrap())
    {
        assert_eq!((&row["id"], &row["sightings"]), (&wanted["id"], &wanted["sightings"]));
    }
    // The map can be asked like any other, and the state goes on.
    scratch.succeeds(&["info", "map.json"]);
    scratch.succeeds(&["update", "s", "rest.jsonl", "-o", "map.covimap", "-q"]);
    assert!(scratch.succeeds(&["info", "map.covimap"]).stdout.contains("updated with 116 new steps"));
}

#[test]
fn settings_are_those_of_the_build() {
    let scratch = cut_log();
    let options = ["--state", "s", "-o", "map.json", "-q", "--seed", "7", "--distance", "lens"];
    scratch.succeeds(&[&["build", "first.jsonl"], &options[..]].concat());
    let map = scratch.succeeds(&["update", "s", "rest.jsonl", "-o", "-", "-q"]).json();
    assert_eq!((&map["seed"], &map["settings"]["auto"]["distance"]), (&7.into(), &"lens".into()));
}

#[test]
fn json_reports_in_one_object_and_a_dash_puts_the_map_on_stdout() {
    let scratch = with_state();
    let report = scratch.succeeds(&["update", "s", "rest.jsonl", "-o", "map.json", "--json"]).json();
    assert_eq!((&report["map"], &report["state"]), (&"map.json".into(), &"s".into()));
    assert_eq!((&report["update"]["steps"], &report["update"]["landmarks"]), (&116.into(), &0.into()));
    assert!(report["seconds"]["count"].is_f64(), "{report}");
    let run = scratch.succeeds(&["update", "s", "rest.jsonl", "-o", "-"]);
    assert_eq!(run.json()["format"], 1);
}

#[test]
fn several_logs_and_other_formats() {
    let scratch = with_state();
    scratch.file("more.txt", "L6 L9 new\nL9 new\n\nnew L6\n");
    let map = scratch.succeeds(&["update", "s", "rest.jsonl", "more.txt", "-o", "-", "-q"]).json();
    assert_eq!(
        (&map["report"]["update"]["steps"], &map["report"]["update"]["landmarks"]),
        (&120.into(), &1.into())
    );
    assert_eq!(map["landmarks"].as_array().unwrap().len(), 16);
}

#[test]
fn state_and_map_do_not_depend_on_the_number_of_threads() {
    let made = |threads: &str| {
        let scratch = cut_log();
        let options = ["-o", "map.json", "-q", "--threads", threads];
        scratch.succeeds(&[&["build", "first.jsonl", "--state", "s"], &options[..]].concat());
        scratch.succeeds(&[&["update", "s", "rest.jsonl"], &options[..]].concat());
        (bytes(&scratch, "s"), bytes(&scratch, "map.json"))
    };
    let one = made("1");
    assert!(one == made("2") && one == made("7"));
}

#[test]
fn what_is_no_whole_state_is_refused_and_nothing_is_touched() {
    let scratch = with_state();
    let (state, map) = (bytes(&scratch, "s"), bytes(&scratch, "map.json"));
    scratch.file("short", &state[..state.len() - 9]);
    scratch.file("flipped", {
        let mut wrong = state.clone();
        wrong[state.len() / 2] ^= 1;
        wrong
    });
    scratch.file("later", {
        let mut other = state.clone();
        other[8] = 3;
        other
    });
    for (name, message) in [
        ("short", "short: no whole state, its check sum is"),
        ("flipped", "flipped: no whole state, its check sum is"),
        ("later", "later: state is format 3, this build reads 2"),
        ("first.jsonl", "first.jsonl: no whole state, it does not begin as one"),
        ("map.json", "map.json: no whole state, it does not begin as one"),
        ("none", "none: cannot be read; give a state, as `covimap build --state` writes it"),
    ] {
        scratch.refuses(&["update", name, "rest.jsonl", "-o", "new.json"], 3, message);
    }
    scratch.file("bad.jsonl", "{\"seen\": [\"A\"]}\nnot json\n");
    scratch.refuses(&["update", "s", "bad.jsonl", "-o", "map.json"], 3, "bad.jsonl:2: ");
    scratch.refuses(&["update", "s", "none.jsonl", "-o", "map.json"], 3, "none.jsonl");
    scratch.refuses(&["update", "s", "rest.jsonl", "-o", "no/map.json"], 1, "its folder does not exist");
    assert!(bytes(&scratch, "s") == state && bytes(&scratch, "map.json") == map);
}

#[test]
fn files_that_would_replace_each_other_are_refused() {
    let scratch = with_state();
    scratch.refuses(&["update", "s", "rest.jsonl", "-o", "s"], 2, "the map would replace the state");
    scratch.refuses(
        &["update", "s", "rest.jsonl", "-o", "rest.jsonl"],
        2,
        "would replace the log rest.jsonl",
    );
    scratch.refuses(&["update", "-", "rest.jsonl", "-o", "m.json"], 2, "it must be a file");
    scratch.refuses(&["update", "s", "rest.jsonl", "-o", "-", "--json"], 2, "both want stdout");
    scratch.refuses(&["update", "s", "rest.jsonl"], 2, "--output");
    scratch.file("square.jsonl", SQUARE);
    let build = |options: &[&str], message: &str| {
        scratch.refuses(&[&["build", "square.jsonl", "-o", "m.json"], options].concat(), 2, message);
    };
    build(&["--state", "m.json"], "--state and --output are the same file");
    build(&["--state", "square.jsonl"], "the state would replace the log square.jsonl");
    build(&["--state", "-"], "it must be a file");
    scratch.refuses(
        &["build", "square.jsonl", "-o", "m.json", "--state", "no/s"],
        1,
        "its folder does not exist",
    );
}
