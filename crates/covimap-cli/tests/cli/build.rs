//! `covimap build`.

use crate::scratch::{SQUARE, Scratch, data, robot_log};

/// A walk along a wall with 400 numbered posts, of which eight are in sight: several regions.
fn long_wall() -> String {
    let step = |first: usize| {
        let seen: Vec<_> = (first..first + 8 - first % 3).map(|post| format!("\"P{post}\"")).collect();
        format!("{{\"seen\": [{}]}}\n", seen.join(", "))
    };
    (0..392).map(step).collect()
}

#[test]
fn a_log_alone_is_enough() {
    let scratch = Scratch::with_square();
    let run = scratch.succeeds(&["build", "square.jsonl"]);
    assert_eq!(run.stdout, "");
    assert_eq!(scratch.names(), ["square.jsonl", "square.map.json"]);
    for part in [
        "4 landmarks in 1 component and 1 region, 5 pairs seen together, from 6 steps\nstress-1 0.",
        "\ntime: read 0.",
        "map written to square.map.json\nnext: covimap info square.map.json\n",
    ] {
        assert!(run.stderr.contains(part), "{part:?} is not in {}", run.stderr);
    }
    let map: serde_json::Value = serde_json::from_str(&scratch.read("square.map.json")).unwrap();
    assert_eq!(map["format"], 1);
    assert_eq!(map["method"], "auto");
    let ids: Vec<_> = map["landmarks"].as_array().unwrap().iter().map(|row| row["id"].as_str()).collect();
    assert_eq!(ids, [Some("A"), Some("B"), Some("C"), Some("D")]);
}

#[test]
fn quiet_says_nothing() {
    let scratch = Scratch::with_square();
    assert_eq!(scratch.succeeds(&["build", "-q", "square.jsonl"]).stderr, "");
    assert_eq!(scratch.succeeds(&["--quiet", "build", "square.jsonl"]).stderr, "");
}

#[test]
fn a_dash_puts_the_map_and_nothing_else_on_stdout() {
    let scratch = Scratch::with_square();
    let run = scratch.succeeds(&["build", "square.jsonl", "-o", "-"]);
    assert_eq!(run.json()["format"], 1);
    assert!(!run.stderr.contains("next:"), "{}", run.stderr);
    assert_eq!(scratch.names(), ["square.jsonl"]);
    scratch.succeeds(&["build", "square.jsonl", "-o", "map.json"]);
    assert_eq!(scratch.read("map.json"), run.stdout);
}

#[test]
fn json_reports_in_one_object() {
    let scratch = Scratch::with_square();
    let report = scratch.succeeds(&["build", "square.jsonl", "--json", "--seed", "7"]).json();
    assert_eq!(report["map"], "square.map.json");
    assert_eq!(report["method"], "auto");
    assert_eq!(report["seed"], 7);
    assert_eq!(report["report"]["landmarks"], 4);
    assert!(report["seconds"]["read"].is_f64(), "{report}");
}

#[test]
fn the_bytes_of_a_map_do_not_depend_on_the_number_of_threads() {
    let scratch = Scratch::new();
    scratch.file("wall.jsonl", long_wall());
    scratch.file("robot.jsonl", robot_log());
    for log in ["wall.jsonl", "robot.jsonl"] {
        for method in ["auto", "classical"] {
            let map = |threads: &str| {
                let options = ["--method", method, "--threads", threads, "-o", "-", "-q"];
                scratch.succeeds(&[&["build", log], &options[..]].concat()).stdout
            };
            let one = map("1");
            assert!(one == map("2") && one == map("7"), "{log} {method}");
        }
    }
    let map = scratch.succeeds(&["build", "wall.jsonl", "-o", "-", "-q"]).json();
    assert!(map["report"]["regions"].as_u64() > Some(1), "the log is to have several regions");
}

#[test]
fn a_build_that_would_take_too_much_memory_is_refused_before_it_starts() {
    let scratch = Scratch::with_square();
    let refusal =
        "MB of memory, 1 MB are allowed - 4 landmarks, about 5 pairs; allow more or map parts of the log";
    scratch.refuses(&["build", "square.jsonl", "--max-memory", "1M"], 1, refusal);
    scratch.refuses(&["build", "square.jsonl", "--max-memory", "much"], 2, "such as 800M or 1.5G");
    let run = scratch.succeeds(&["build", "square.jsonl", "--max-memory", "1G", "--json"]);
    assert!(run.stderr.contains("memory: about "), "{}", run.stderr);
    assert!(run.json()["memory_estimate"].as_u64().unwrap() < 1_000_000_000);
}

#[test]
fn several_logs_are_one_log_in_the_order_given() {
    let scratch = Scratch::with_square();
    let lines: Vec<_> = SQUARE.lines().collect();
    scratch.file("first.jsonl", lines[..2].join("\n"));
    scratch.file("second.txt", "C D\nD A\nA B C\nC D A\n");
    scratch.succeeds(&["build", "first.jsonl", "second.txt", "-q"]);
    scratch.succeeds(&["build", "square.jsonl", "-q"]);
    assert_eq!(scratch.read("first.map.json"), scratch.read("square.map.json"));
}

#[test]
fn every_setting_of_the_classical_method_reaches_the_map() {
    let scratch = Scratch::with_square();
    let map = |options: &[&str]| {
        let fixed = ["build", "square.jsonl", "--method", "classical", "-o", "-", "-q"];
        scratch.succeeds(&[&fixed[..], options].concat()).json()
    };
    let plain = map(&[]);
    assert_eq!(plain["method"], "classical");
    let wanted = serde_json::json!({ "phi": "phi2", "alpha": null, "lo": 0.1, "hi": 2.0, "tic": true });
    assert_eq!(plain["settings"]["classical"], wanted);
    for (options, key, value) in [
        (&["--phi", "phi1"][..], "phi", serde_json::json!("phi1")),
        (&["--alpha", "0.5"], "alpha", serde_json::json!(0.5)),
        (&["--lo", "0.3"], "lo", serde_json::json!(0.3)),
        (&["--hi", "0.6"], "hi", serde_json::json!(0.6)),
        (&["--no-tic"], "tic", serde_json::json!(false)),
    ] {
        let changed = map(options);
        assert_eq!(changed["settings"]["classical"][key], value);
        if key != "tic" {
            assert_ne!(changed["landmarks"], plain["landmarks"], "{key} changes nothing");
        }
    }
}

#[test]
fn every_distance_function_reaches_the_map() {
    let scratch = Scratch::new();
    scratch.file("robot.jsonl", robot_log());
    let distances = |options: &[&str]| {
        let map = scratch.succeeds(&[&["build", "robot.jsonl", "-o", "-", "-q"], options].concat()).json();
        (map["settings"]["auto"]["distance"].clone(), map["report"]["components"][0]["distances"].clone())
    };
    for family in ["log", "inverse", "lens", "power", "spline", "isotonic"] {
        let (setting, report) = distances(&["--distance", family]);
        assert_eq!(setting, family);
        assert_eq!((&report["curve"]["family"], &report["learnt"]), (&family.into(), &true.into()));
    }
    let (setting, report) = distances(&["--distance", "fixed-log"]);
    assert_eq!((setting, &report["learnt"]), ("fixed_log".into(), &false.into()));
    assert_eq!(distances(&["--distance", "auto"]), distances(&[]));
    assert_eq!(distances(&[]).1["scores"].as_array().unwrap().len(), 6);
}

#[test]
fn warnings_name_landmarks() {
    let scratch = Scratch::new();
    scratch.file("log.txt", "A B C D\nB C D\nC D\nA B\nA D\nD E\n");
    let run = scratch.succeeds(&["build", "log.txt"]);
    assert!(run.stderr.contains("warning: seen_once (1): "), "{}", run.stderr);
    assert!(run.stderr.contains("\n  E\n"), "{}", run.stderr);
}

#[test]
fn the_map_of_a_log_elsewhere_comes_into_the_current_folder() {
    let scratch = Scratch::new();
    scratch.succeeds(&["build", data("mrclam-1.jsonl").to_str().unwrap(), "-q"]);
    assert_eq!(scratch.names(), ["mrclam-1.map.json"]);
}

#[test]
fn ranges_make_the_map_metric() {
    let scratch = Scratch::new();
    // Posts at the corners of a grid of half a metre; the robot looks from the middle of every square and from some other places.
    let mut log = String::new();
    for step in 0..200 {
        let place = [0.25 + 0.09 * f64::from(step % 20), 0.2 + 0.17 * f64::from(step / 20)];
        let posts = (0..25).map(|k| (k, [0.5 * f64::from(k % 5), 0.5 * f64::from(k / 5)]));
        let away = |at: [f64; 2]| (at[0] - place[0]).hypot(at[1] - place[1]);
        let near: Vec<_> = posts.map(|(k, at)| (k, away(at))).filter(|post| post.1 < 0.8).collect();
        let seen: Vec<_> = near.iter().map(|(k, _)| format!("\"P{k}\"")).collect();
        let ranges: Vec<_> = near.iter().map(|(k, away)| format!("\"P{k}\": {away}")).collect();
        log += &format!("{{\"seen\": [{}], \"ranges\": {{{}}}}}\n", seen.join(", "), ranges.join(", "));
    }
    scratch.file("posts.jsonl", log);
    let said = scratch.succeeds(&["build", "posts.jsonl", "-o", "map.json"]);
    assert!(said.stdout.contains("in metres by") || said.stderr.contains("in metres by"), "{}", said.stderr);
    let near = scratch.succeeds(&["near", "map.json", "P12", "-k", "4", "--json"]).json();
    for post in near["near"].as_array().unwrap() {
        assert!((post["distance"].as_f64().unwrap() - 0.5).abs() < 0.01, "{near}");
    }
    scratch.file("bad.jsonl", "{\"seen\": [\"A\"]}\n{\"seen\": [\"A\"], \"ranges\": {\"A\": -2}}\n");
    scratch.refuses(&["build", "bad.jsonl"], 3, "bad.jsonl:2: the range to `A` is -2; give metres above 0");
}
