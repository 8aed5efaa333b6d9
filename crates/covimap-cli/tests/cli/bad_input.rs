//! Every kind of bad input: a helpful message, exit code 3, no file.

use std::io::Write;

use flate2::{Compression, write::GzEncoder};

use crate::scratch::{Run, SQUARE, Scratch};

const BAD_INPUT: i32 = 3;

/// A log with these contents must be refused with this message.
#[track_caller]
fn refused(name: &str, contents: impl AsRef<[u8]>, message: &str) {
    let scratch = Scratch::new();
    scratch.file(name, contents);
    scratch.refuses(&["build", name], BAD_INPUT, message);
}

/// A log that must become a map, perhaps with a warning.
fn mapped(contents: &str) -> Run {
    let scratch = Scratch::new();
    scratch.file("log.txt", contents);
    let run = scratch.succeeds(&["build", "log.txt"]);
    let map: serde_json::Value = serde_json::from_str(&scratch.read("log.map.json")).unwrap();
    for landmark in map["landmarks"].as_array().unwrap() {
        assert!(landmark["x"].is_number() && landmark["y"].is_number(), "{landmark}");
    }
    run
}

#[test]
fn an_empty_file() {
    refused("log.jsonl", "", "covimap: log.jsonl: no step in the log; a step is a line like");
    refused("log.csv", "", "covimap: log.csv: no step in the log");
    refused("log", "\n\n", "no step in the log");
}

#[test]
fn no_step_with_two_landmarks() {
    refused(
        "log.txt",
        "A\nB\n\nA\n",
        "covimap: no step shows two landmarks - 2 landmarks in 4 steps; pool several sightings",
    );
}

#[test]
fn invalid_json_names_file_and_line() {
    let scratch = Scratch::new();
    scratch.file("log.jsonl", SQUARE.replace("{\"seen\": [\"C\", \"D\"]}", "{\"seen\": [\"C\", \"D\""));
    let run = scratch.run(&["build", "log.jsonl"]);
    assert_eq!(run.code, Some(BAD_INPUT));
    assert!(run.stderr.starts_with("log.jsonl:3: "), "{}", run.stderr);
    assert!(run.stderr.trim_end().contains("; "), "says what to do: {}", run.stderr);
    assert_eq!(run.stderr.lines().count(), 1);
}

#[test]
fn seen_of_a_wrong_type() {
    for wrong in ["\"A\"", "7", "{\"A\": 1}", "null", "[[\"A\"]]", "[1.5, \"A\"]", "[true]"] {
        refused("log.jsonl", format!("{SQUARE}{{\"seen\": {wrong}}}\n"), "log.jsonl:7: ");
    }
    refused("log.jsonl", format!("{SQUARE}{{\"t\": 3}}\n"), "log.jsonl:7: ");
}

#[test]
fn text_that_is_not_utf8() {
    for (name, line) in [("log.txt", &b"A B\xff\n"[..]), ("log.jsonl", b"{\"seen\": [\"\xc3\x28\"]}\n")] {
        refused(name, line, &format!("{name}:1: byte "));
    }
    refused("log.csv", b"step,landmark\n1,A\n1,\xff\n", "log.csv:3: byte 3 of the line");
}

#[test]
fn a_line_of_100_megabytes() {
    let mut line = br#"{"seen": [""#.to_vec();
    line.resize(100_000_000, b'A');
    refused("log.jsonl", [SQUARE.as_bytes(), &line].concat(), "log.jsonl:7: ");
}

#[test]
fn tables_without_a_header_or_with_a_broken_row() {
    refused("log.csv", "1,A\n1,B\n", "log.csv:1: ");
    refused("log.csv", "step,landmark\n1,A\n1\n", "log.csv:3: ");
    refused("log.csv", "step,landmark\n1,A\n1,B,C\n", "log.csv:3: ");
    refused("log.csv", "step,landmark\n1,A\n1,\n", "log.csv:3: ");
}

#[test]
fn a_gzip_file_that_is_cut_short() {
    let mut packer = GzEncoder::new(Vec::new(), Compression::default());
    packer.write_all(SQUARE.repeat(1000).as_bytes()).unwrap();
    let whole = packer.finish().unwrap();
    refused("log.jsonl.gz", &whole[..whole.len() / 2], "the file is cut short, copy or pack it again");
    refused("log.jsonl.gz", &whole[..12], "log.jsonl.gz:1: ");
}

#[test]
fn a_folder_or_nothing_in_the_place_of_a_log() {
    let scratch = Scratch::new();
    std::fs::create_dir(scratch.path().join("logs")).unwrap();
    scratch.refuses(
        &["build", "logs"],
        BAD_INPUT,
        "covimap: logs: is a directory; name the log file inside it",
    );
    let missing = "covimap: no.jsonl: cannot be opened; check its name and rights\n  cause: No such file";
    scratch.refuses(&["build", "no.jsonl"], BAD_INPUT, missing);
    scratch.refuses(&["check", "no.jsonl"], BAD_INPUT, missing);
}

#[test]
fn a_format_that_nothing_tells() {
    refused("log", "A B\n", "covimap: log: cannot tell the log format");
    let scratch = Scratch::new();
    scratch.file("log", "A B\nB C\nA C\nC D A\n");
    scratch.succeeds(&["build", "log", "--format", "text"]);
}

#[test]
fn one_two_and_three_landmarks() {
    refused("log.txt", "A\nA\n", "no step shows two landmarks - 1 landmarks in 2 steps");
    for few in ["A B\nA\nB\nA B\n", "A B\nB C\nA C\nA\n"] {
        let run = mapped(few);
        assert!(run.stderr.contains("warning: too_few_landmarks"), "{}", run.stderr);
    }
}

#[test]
fn landmarks_that_are_always_seen_together() {
    refused("log.txt", "A B C D\nD C B A\nA B C D\n", "all 4 landmarks are seen in the same 3 steps");
}

#[test]
fn two_landmarks_that_cannot_be_told_apart() {
    let run = mapped("A B T1 T2\nB C T2 T1\nC D\nD A\nA T1 T2\nB D\n");
    assert!(run.stderr.contains("warning: twins (2): "), "{}", run.stderr);
    assert!(run.stderr.contains("\n  T1, T2\n"), "{}", run.stderr);
}

#[test]
fn parts_that_have_nothing_in_common() {
    let run = mapped("A B\nB C\nC A\nX Y\nY Z\nZ X\nlonely\n");
    assert!(run.stderr.contains("7 landmarks in 3 components"), "{}", run.stderr);
    assert!(run.stderr.contains("warning: components (3): "), "{}", run.stderr);
    assert!(run.stderr.contains("warning: never_together (1): "), "{}", run.stderr);
}

#[test]
fn an_id_of_10_kilobytes() {
    let id = "x".repeat(10_000);
    refused("log.txt", format!("A B\nA {id}\n"), "log.txt:2: the ID `xxxxxxxxxxxxxxxxxxxx");
}

#[test]
fn a_truth_without_common_ids() {
    let scratch = Scratch::with_map();
    scratch.file("truth.csv", "id,x,y\nP,0,0\nQ,1,0\nR,0,1\n");
    let message = "covimap: no landmark of the map is in the truth: the map has 4 such as \"A\"";
    scratch.refuses(&["evaluate", "square.map.json", "truth.csv"], BAD_INPUT, message);
    scratch.file("truth.csv", "id,x,y\nA,0,0\nB,1,0\n");
    let message = "covimap: map and truth share 2 landmarks";
    scratch.refuses(&["evaluate", "square.map.json", "truth.csv"], BAD_INPUT, message);
}

#[test]
fn a_truth_with_nan() {
    let scratch = Scratch::with_map();
    scratch.file("truth.csv", "id,x,y\nA,0,0\nB,NaN,0\nC,1,1\n");
    let message = "truth.csv:3: x is NaN, positions must be finite; leave the row out\n";
    scratch.refuses(&["evaluate", "square.map.json", "truth.csv"], BAD_INPUT, message);
    scratch.refuses(
        &["export", "square.map.json", "--to", "svg", "--truth", "truth.csv"],
        BAD_INPUT,
        message,
    );
}

#[test]
fn something_else_in_the_place_of_a_map() {
    let scratch = Scratch::with_square();
    scratch.file("future.json", "{\"format\": 2}");
    scratch.file("cut.json", "{\"format\": 1, \"landmarks\": [\n{\"id\": \"A\", \"x\": 1");
    for command in [&["info"][..], &["export", "--to", "csv"]] {
        let refuses = |map: &str, message: &str| {
            scratch.refuses(&[command, &[map]].concat(), BAD_INPUT, message);
        };
        refuses("square.jsonl", "square.jsonl:1: not a whole map file, ");
        refuses("cut.json", "cut.json:2: not a whole map file, ");
        refuses("future.json", "covimap: future.json: map file is format 2, this build reads 1");
        refuses("no.json", "covimap: no.json: cannot be read; give a map file");
    }
}

#[test]
fn a_log_too_large_for_the_dense_method() {
    let steps: String = (0..3001).map(|k| format!("L{k} L{}\n", k + 1)).collect();
    let scratch = Scratch::new();
    scratch.file("log.txt", steps);
    let message =
        "the classical method is dense and takes at most 3000 landmarks, here are 3002; use --method auto";
    scratch.refuses(&["build", "log.txt", "--method", "classical"], BAD_INPUT, message);
}
