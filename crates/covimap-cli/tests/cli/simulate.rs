//! `covimap simulate`.

use std::fs;

use crate::scratch::Scratch;

const USAGE: i32 = 2;

/// The arguments of a small hall into the folder `out`, and more.
fn hall<'a>(more: &[&'a str]) -> Vec<&'a str> {
    [
        &["simulate", "hall", "--landmarks", "40", "--steps-per-landmark", "5", "--seed", "3", "-o", "out"],
        more,
    ]
    .concat()
}

#[test]
fn log_truth_and_summary_fit_together() {
    let scratch = Scratch::new();
    let run = scratch.succeeds(&hall(&[]));
    let summary = run.json();
    assert_eq!(run.stdout.lines().count(), 1);
    assert_eq!((&summary["world"], &summary["seed"]), (&"hall".into(), &3.into()));
    assert_eq!((&summary["landmarks"], &summary["steps"]), (&40.into(), &200.into()));
    assert_eq!(summary["observations"], "out/observations.jsonl");
    assert_eq!(summary["truth"], "out/truth.csv");
    assert_eq!(scratch.names(), ["out"]);
    let check = scratch.succeeds(&["check", "out/observations.jsonl", "--json"]).json();
    assert_eq!(check["summary"]["steps"], 200);
    assert_eq!(check["summary"]["sightings"], summary["sightings"]);
    assert_eq!(scratch.read("out/truth.csv").lines().count(), 41);
    scratch.succeeds(&["build", "out/observations.jsonl", "-o", "map.json", "-q"]);
    let found = scratch.succeeds(&["evaluate", "map.json", "out/truth.csv", "--json"]).json();
    assert_eq!(found["n"].as_u64().unwrap() + summary["never_seen"].as_u64().unwrap(), 40);
    // A random map has half of its triangles wrong.
    assert!(found["orientation_error"].as_f64().unwrap() < 0.2, "{found}");
}

#[test]
fn the_seed_alone_decides_over_the_bytes() {
    let scratch = Scratch::new();
    let files = |more: &[&str]| {
        scratch.succeeds(&hall(more));
        ["observations.jsonl", "truth.csv"].map(|name| scratch.read(&format!("out/{name}")))
    };
    let first = files(&[]);
    assert!(files(&["-q"]) == first);
    scratch.succeeds(&[
        "simulate",
        "hall",
        "--landmarks",
        "40",
        "--steps",
        "200",
        "--seed",
        "3",
        "-o",
        "same",
    ]);
    assert!(scratch.read("same/observations.jsonl") == first[0]);
    scratch.succeeds(&[
        "simulate",
        "hall",
        "--landmarks",
        "40",
        "--steps",
        "200",
        "--seed",
        "4",
        "-o",
        "other",
    ]);
    assert!(scratch.read("other/observations.jsonl") != first[0]);
    assert!(scratch.read("other/truth.csv") != first[1]);
}

#[test]
fn every_world_can_be_simulated() {
    let scratch = Scratch::new();
    for world in ["hall", "ring", "horseshoe", "blocks", "spiral", "office", "two-rooms", "corridor-tree"] {
        let run = scratch.succeeds(&["simulate", world, "--landmarks", "200", "--steps", "100", "-o", world]);
        assert_eq!((&run.json()["world"], &run.json()["steps"]), (&world.into(), &100.into()));
    }
    let run = scratch.succeeds(&["simulate", "paper-room", "--steps", "100", "-o", "room"]);
    assert_eq!(run.json()["landmarks"], 15);
    assert!(scratch.read("room/truth.csv").contains("\nob14,"));
}

/// The log that an option gives, of the small hall unless another world is named.
fn log_with(scratch: &Scratch, world: &[&str], option: &str) -> String {
    let world = if world.is_empty() { &["hall", "--landmarks", "40"] } else { world };
    scratch.succeeds(&[&["simulate"], world, &["--steps", "1000", "-o", "out", option]].concat());
    scratch.read("out/observations.jsonl") + &scratch.read("out/truth.csv")
}

#[test]
fn every_option_changes_what_comes_out() {
    let scratch = Scratch::new();
    let hall: &[&str] = &[];
    let room: &[&str] = &["paper-room"];
    let worlds: [(&[&str], &[&str]); 8] = [
        (
            hall,
            &[
                "--density=5",
                "--contrast=4",
                "--diameter=0.05",
                "--min-gap=0.1",
                "--id-prefix=P",
                "--motion=patrol",
                "--robots=3",
                "--turn=90",
                "--step=0.05,0.1",
                "--clearance=0.3",
                "--range=0.4",
                "--edge=0.1",
                "--detection=0.5",
                "--view=90",
                "--detectability=0.2,1",
                "--missed=0.3",
                "--mistaken=0.3",
                "--range-noise=0.1",
            ],
        ),
        (room, &["--side=2", "--density=4", "--threshold=4,8", "--steepness=50", "--recognition=range"]),
        (&["blocks", "--landmarks", "200"], &["--street=2", "--building=3"]),
        (&["spiral", "--landmarks", "200"], &["--corridor=2", "--wall=0.4"]),
        (&["office", "--landmarks", "2000"], &["--room=2", "--door=1.2", "--missing-doors=1"]),
        (&["two-rooms", "--landmarks", "100"], &["--door=1.2"]),
        (&["corridor-tree", "--landmarks", "200"], &["--corridor=1.5", "--pitch=4"]),
        (&["hall", "--landmarks", "200", "--motion", "sweep"], &["--lane=1"]),
    ];
    for (world, options) in worlds {
        let plain = log_with(&scratch, world, "-q");
        for option in options {
            assert!(log_with(&scratch, world, option) != plain, "{world:?} {option}");
        }
    }
}

#[test]
fn options_that_nothing_reads_are_refused() {
    let scratch = Scratch::new();
    for (option, message) in [
        ("--side=2", "--side means nothing with hall; leave it out"),
        ("--street=2", "--street means nothing with hall; leave it out"),
        ("--building=2", "--building means nothing with hall; leave it out"),
        ("--corridor=2", "--corridor means nothing with hall; leave it out"),
        ("--wall=2", "--wall means nothing with hall; leave it out"),
        ("--pitch=2", "--pitch means nothing with hall; leave it out"),
        ("--room=2", "--room means nothing with hall; leave it out"),
        ("--door=2", "--door means nothing with hall; leave it out"),
        ("--missing-doors=0", "--missing-doors means nothing with hall; leave it out"),
        ("--lane=2", "--lane means nothing with --motion wander; leave it out"),
        ("--threshold=5", "--threshold means nothing with recognition by range; leave it out"),
        ("--steepness=50", "--steepness means nothing with recognition by range; leave it out"),
    ] {
        scratch.refuses(&hall(&[option]), USAGE, message);
    }
    for option in ["--range=1", "--edge=1", "--detection=1"] {
        let message = "means nothing with recognition by visual angle; leave it out";
        scratch.refuses(&["simulate", "paper-room", "-o", "out", option], USAGE, message);
    }
    scratch.refuses(
        &["simulate", "paper-room", "-o", "out", "--side=2", "--density=5"],
        USAGE,
        "--density means nothing with --side; leave it out",
    );
    scratch.refuses(&hall(&["--steps=5"]), USAGE, "cannot be used with");
}

#[test]
fn settings_that_cannot_be_simulated() {
    let scratch = Scratch::new();
    scratch.refuses(&["simulate", "castle", "-o", "out"], USAGE, "[possible values: hall, ring,");
    scratch.refuses(&["simulate", "hall"], USAGE, "--output <DIR>");
    scratch.refuses(&hall(&["--missed=1.5"]), USAGE, "covimap: missed is 1.5; it must be between 0 and 1");
    scratch.refuses(
        &hall(&["--recognition=visual-angle"]),
        USAGE,
        "landmarks of diameter 0 have no visual angle",
    );
    scratch.refuses(&hall(&["--step=short"]), USAGE, "give one number, or the least and the greatest");
    let crowded = ["simulate", "paper-room", "--landmarks=500", "--side=1.5", "-o", "out"];
    scratch.refuses(&crowded, USAGE, "of 500 landmarks found a place");
}

#[test]
fn a_place_that_takes_no_file_leaves_neither() {
    let scratch = Scratch::new();
    fs::create_dir_all(scratch.path().join("out/observations.jsonl")).unwrap();
    scratch.refuses(&hall(&[]), 1, "out/observations.jsonl: cannot be written: it is a folder");
    assert_eq!(fs::read_dir(scratch.path().join("out")).unwrap().count(), 1);
    scratch.file("file", "");
    scratch.refuses(&["simulate", "hall", "-o", "file"], 1, "a file stands where a folder is wanted");
}

#[test]
fn ranges_make_a_map_in_metres() {
    let scratch = Scratch::new();
    scratch.succeeds(&hall(&["--range-noise", "0.02"]));
    assert!(scratch.read("out/observations.jsonl").contains("\"ranges\": {"));
    scratch.succeeds(&["build", "out/observations.jsonl", "-o", "map.json", "-q"]);
    let report = &scratch.succeeds(&["info", "map.json", "--json"]).json();
    assert!(report.to_string().contains("scale_error"), "{report}");
    scratch.refuses(&hall(&["--range-noise=-1"]), USAGE, "covimap: range noise is -1; it must be at least 0");
}
