//! Standard input, packed logs, and readers of standard output that go away.

use std::io::Write;
use std::process::{Command, Stdio};

use flate2::{Compression, write::GzEncoder};

use crate::scratch::{Run, SQUARE, Scratch};

#[test]
fn a_log_is_the_same_log_from_stdin_and_packed() {
    let scratch = Scratch::with_square();
    let mut packer = GzEncoder::new(Vec::new(), Compression::default());
    packer.write_all(SQUARE.as_bytes()).unwrap();
    scratch.file("gzipped.jsonl.gz", packer.finish().unwrap());
    scratch.file("zipped.jsonl.zst", zstd::encode_all(SQUARE.as_bytes(), 0).unwrap());
    scratch.file(
        "table.csv",
        "step,landmark\n1,A\n1,B\n2,B\n2,C\n3,C\n3,D\n4,D\n4,A\n5,A\n5,B\n5,C\n6,C\n6,D\n6,A\n",
    );
    for log in ["square.jsonl", "gzipped.jsonl.gz", "zipped.jsonl.zst", "table.csv"] {
        scratch.succeeds(&["build", log, "-q"]);
    }
    let map = scratch.read("square.map.json");
    for other in ["gzipped", "zipped", "table"] {
        assert_eq!(scratch.read(&format!("{other}.map.json")), map);
    }
    let run = Run::of(scratch.command(&["build", "-", "-q"]).write_stdin(SQUARE));
    assert_eq!(run.code, Some(0), "{run:?}");
    assert_eq!(scratch.read("stdin.map.json"), map);
    let run = Run::of(
        scratch.command(&["build", "-", "--format", "text", "-o", "-"]).write_stdin("A B\nB C\nC A\n"),
    );
    assert_eq!(run.json()["landmarks"][2]["id"], "C");
}

#[test]
fn bad_input_from_stdin_is_called_so() {
    let scratch = Scratch::new();
    let run = Run::of(scratch.command(&["build", "-"]).write_stdin("{\"seen\": [\"A\"]}\n{\n"));
    assert_eq!(run.code, Some(3));
    assert!(run.stderr.starts_with("<stdin>:2: "), "{}", run.stderr);
}

#[test]
fn a_reader_that_goes_away_is_no_failure() {
    let scratch = Scratch::with_map();
    for arguments in [
        &["export", "square.map.json", "--to", "csv"][..],
        &["info", "square.map.json"],
        &["build", "square.jsonl", "-o", "-", "-q"],
        &["demo", "-q"],
    ] {
        let mut run = Command::new(env!("CARGO_BIN_EXE_covimap"))
            .current_dir(scratch.path())
            .args(arguments)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        drop(run.stdout.take());
        let output = run.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{arguments:?}");
        assert_eq!(String::from_utf8(output.stderr).unwrap(), "");
    }
}

#[test]
#[cfg(target_os = "linux")]
fn a_full_stdout_is_a_failure() {
    let scratch = Scratch::with_map();
    let output = Command::new(env!("CARGO_BIN_EXE_covimap"))
        .current_dir(scratch.path())
        .args(["info", "square.map.json"])
        .stdout(std::fs::File::options().write(true).open("/dev/full").unwrap())
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(String::from_utf8(output.stderr).unwrap().contains("no space is left"));
}
