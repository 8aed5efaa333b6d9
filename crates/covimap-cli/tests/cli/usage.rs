//! Wrong use: exit code 2 and what to give instead.

use crate::scratch::Scratch;

const USAGE: i32 = 2;

#[test]
fn no_command_and_unknown_ones() {
    let scratch = Scratch::new();
    scratch.refuses(&[], USAGE, "Usage: covimap [OPTIONS] <COMMAND>");
    scratch.refuses(&["map"], USAGE, "unrecognized subcommand 'map'");
    scratch.refuses(&["build"], USAGE, "<LOG>...");
    scratch.refuses(&["build", "log.jsonl", "--fast"], USAGE, "unexpected argument '--fast'");
    scratch.refuses(&["export", "map.json", "--to", "dxf"], USAGE, "[possible values: csv, svg");
}

#[test]
fn help_and_version_are_results() {
    let scratch = Scratch::new();
    let help = scratch.succeeds(&["--help"]);
    assert!(help.stdout.contains("covimap build run.jsonl") && help.stdout.contains("Exit codes:"));
    assert_eq!(scratch.succeeds(&["--version"]).stdout, concat!("covimap ", env!("CARGO_PKG_VERSION"), "\n"));
}

#[test]
fn a_number_of_threads_that_cannot_work() {
    let scratch = Scratch::with_square();
    let message = "give a number from 1 to 1024, or leave --threads out to use all cores";
    for wrong in ["0", "1025", "two", "-1"] {
        scratch.refuses(&["build", "square.jsonl", &format!("--threads={wrong}")], USAGE, message);
    }
    scratch.refuses(&["build", "square.jsonl", "--threads", "0"], USAGE, message);
    scratch.refuses(&["demo", "--threads", "0"], USAGE, message);
}

#[test]
fn settings_that_the_method_does_not_read() {
    let scratch = Scratch::with_square();
    for flag in ["--phi=phi1", "--alpha=0.2", "--lo=0", "--hi=1", "--no-tic"] {
        let name = flag.split('=').next().unwrap();
        let message = format!("{name} is a setting of --method classical; add that or leave {name} out");
        scratch.refuses(&["build", "square.jsonl", flag], USAGE, &message);
        scratch.succeeds(&["build", "square.jsonl", flag, "--method", "classical", "-q", "-o", "/dev/null"]);
    }
    let message = "--distance is a setting of --method auto; leave one of the two out";
    scratch.refuses(
        &["build", "square.jsonl", "--method", "classical", "--distance", "lens"],
        USAGE,
        message,
    );
    scratch.file("truth.csv", "id,x,y\n");
    scratch.succeeds(&["build", "square.jsonl", "-q"]);
    scratch.refuses(
        &["export", "square.map.json", "--to", "csv", "--truth", "truth.csv"],
        USAGE,
        "--truth is drawn by --to svg alone; leave it out",
    );
}

#[test]
fn settings_out_of_range() {
    let scratch = Scratch::with_square();
    for (flag, message) in [
        ("--alpha=-1", "setting classical.alpha is -1; give a positive number"),
        ("--alpha=nan", "setting classical.alpha is NaN"),
        ("--lo=-0.5", "setting classical.lo is -0.5"),
        ("--hi=0.05", "setting classical.hi is 0.05"),
    ] {
        scratch.refuses(&["build", "square.jsonl", "--method", "classical", flag], USAGE, message);
    }
}

#[test]
fn two_results_for_one_place() {
    let scratch = Scratch::with_square();
    scratch.refuses(
        &["build", "square.jsonl", "--json", "-o", "-"],
        USAGE,
        "--json and --output - both want stdout",
    );
    let before = scratch.read("square.jsonl");
    scratch.refuses(
        &["build", "square.jsonl", "-o", "./square.jsonl"],
        USAGE,
        "the map would replace the log square.jsonl; give another --output",
    );
    assert_eq!(scratch.read("square.jsonl"), before);
}
