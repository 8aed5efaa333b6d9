//! `covimap evaluate`.

use crate::scratch::{Scratch, data, robot_log};

/// The map of the square, and its truth with one landmark that nobody saw.
fn surveyed() -> Scratch {
    let scratch = Scratch::with_map();
    scratch.file("truth.csv", "id,x,y\nA,0,0\nB,2,0\nC,2,2\nD,0,2\nE,9,9\n");
    scratch
}

#[test]
fn the_errors_of_a_map_are_printed_for_people() {
    let run = surveyed().succeeds(&["evaluate", "square.map.json", "truth.csv"]);
    assert_eq!(run.stderr, "left out: 1 landmark of the truth not in the map\n");
    assert!(run.stdout.contains("landmarks compared                               4\n"), "{}", run.stdout);
    assert!(run.stdout.contains("triangles turned the wrong way              0.0000\n"), "{}", run.stdout);
}

#[test]
fn the_errors_of_a_map_are_printed_for_programs() {
    let found = surveyed().succeeds(&["evaluate", "square.map.json", "truth.csv", "--json"]).json();
    assert_eq!(found["n"], 4);
    assert_eq!(found["missing"], 1);
    assert_eq!(found["orientation_error"], 0.0);
    for key in ["delaunay_error", "rmse", "knn10"] {
        assert!(found[key].is_f64(), "{key} in {found}");
    }
}

#[test]
fn quiet_leaves_the_result() {
    let run = surveyed().succeeds(&["evaluate", "-q", "square.map.json", "truth.csv"]);
    assert_eq!(run.stderr, "");
    assert!(run.stdout.contains("landmarks compared"));
}

#[test]
fn the_limit_of_a_log_stands_beside_its_map() {
    let scratch = Scratch::new();
    scratch.file("truth.csv", std::fs::read_to_string(data("mrclam-1.truth.csv")).unwrap());
    scratch.file("robot.jsonl", robot_log());
    scratch.succeeds(&["build", "robot.jsonl", "-q"]);
    let limit = ["evaluate", "robot.map.json", "truth.csv", "--limit", "robot.jsonl"];
    let text = scratch.succeeds(&limit).stdout;
    let header = text.lines().next().unwrap().split_whitespace().collect::<Vec<_>>().join(" ");
    assert_eq!(header, "map from the truth ratio");
    for row in ["\nstress-1 ", "\ntriangles turned the wrong way ", "\nwith the places of the robot known "] {
        assert!(text.contains(row), "{row:?} is not in {text}");
    }
    let found = scratch.succeeds(&[&limit[..], &["--json"]].concat()).json();
    let plain = scratch.succeeds(&["evaluate", "robot.map.json", "truth.csv", "--json"]).json();
    for (key, value) in plain.as_object().unwrap() {
        assert_eq!(&found[key], value, "{key}");
        assert!(found["from_truth"].get(key).is_some(), "{key}");
    }
    let quotient = |key: &str| found[key].as_f64().unwrap() / found["from_truth"][key].as_f64().unwrap();
    for key in ["stress1", "delaunay_error", "orientation_error", "local_orientation_error", "rmse"] {
        assert!((found["ratio"][key].as_f64().unwrap() - quotient(key)).abs() < 1e-12, "{key}: {found}");
    }
    assert!(found["bound"]["rmse"].as_f64().unwrap() > 0.0, "{found}");
    assert!(found["bound"]["delaunay_error"].as_f64().unwrap() > 0.0, "{found}");
}

#[test]
fn the_limit_wants_the_log_of_the_map() {
    let scratch = surveyed();
    scratch.file("other.txt", "A B\nB X\n");
    let limit = ["evaluate", "square.map.json", "truth.csv", "--limit", "other.txt"];
    scratch.refuses(&limit, 3, "the map was not made of this log: \"C\" is in one of the two only");
    let format = ["evaluate", "square.map.json", "truth.csv", "--format", "text"];
    scratch.refuses(&format, 2, "--format is that of the log of --limit");
    scratch.refuses(&["evaluate", "square.map.json", "truth.csv", "--limit", "none.txt"], 3, "none.txt");
}
