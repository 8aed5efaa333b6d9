//! Ctrl-C.

#![cfg(unix)]

use std::io::Write;
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::Duration;

use crate::scratch::{SQUARE, Scratch};

/// A run that reads an endless input.
fn endless(scratch: &Scratch, arguments: &[&str]) -> Child {
    Command::new(env!("CARGO_BIN_EXE_covimap"))
        .current_dir(scratch.path())
        .args(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

const BUILD: &[&str] = &["build", "-", "-o", "map.json"];

fn signal(run: &Child, name: &str) {
    let sent = Command::new("kill").args([&format!("-{name}"), &run.id().to_string()]).status().unwrap();
    assert!(sent.success());
}

#[test]
fn an_interrupted_build_leaves_nothing_behind() {
    for name in ["INT", "TERM"] {
        let scratch = Scratch::new();
        let mut run = endless(&scratch, BUILD);
        let mut log = run.stdin.take().unwrap();
        let block = SQUARE.repeat(10_000);
        // More than a pipe holds: the program is reading now.
        log.write_all(block.as_bytes()).unwrap();
        signal(&run, name);
        while log.write_all(block.as_bytes()).is_ok() {}
        let output = run.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(130));
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(said, "covimap: stopping; once more stops at once\ncovimap: interrupted\n");
        assert_eq!(String::from_utf8(output.stdout).unwrap(), "");
        assert!(scratch.names().is_empty());
    }
}

#[test]
fn an_interrupted_update_leaves_state_and_map_as_they_were() {
    let scratch = Scratch::with_square();
    scratch.succeeds(&["build", "square.jsonl", "--state", "s", "-o", "map.json", "-q"]);
    let (state, map) = (std::fs::read(scratch.path().join("s")).unwrap(), scratch.read("map.json"));
    let mut run = endless(&scratch, &["update", "s", "-", "-o", "map.json"]);
    let mut log = run.stdin.take().unwrap();
    let block = SQUARE.repeat(10_000);
    log.write_all(block.as_bytes()).unwrap();
    signal(&run, "INT");
    while log.write_all(block.as_bytes()).is_ok() {}
    assert_eq!(run.wait().unwrap().code(), Some(130));
    assert_eq!(scratch.names(), ["map.json", "s", "square.jsonl"]);
    assert_eq!(std::fs::read(scratch.path().join("s")).unwrap(), state);
    assert_eq!(scratch.read("map.json"), map);
}

#[test]
fn a_command_that_cannot_stop_by_itself_ends_at_once() {
    let scratch = Scratch::new();
    let mut run = endless(&scratch, &["info", "-"]);
    let mut map = run.stdin.take().unwrap();
    // More than a pipe holds: the program is reading now.
    map.write_all(&vec![b' '; 1 << 20]).unwrap();
    signal(&run, "INT");
    assert_eq!(run.wait().unwrap().code(), Some(130));
    drop(map);
}

#[test]
fn a_second_interrupt_ends_a_build_that_waits() {
    let scratch = Scratch::new();
    let mut run = endless(&scratch, BUILD);
    let mut log = run.stdin.take().unwrap();
    log.write_all(SQUARE.repeat(10_000).as_bytes()).unwrap();
    // The log stays open and says no more, so the program waits for it.
    while run.try_wait().unwrap().is_none() {
        signal(&run, "INT");
    }
    assert_eq!(run.wait().unwrap().code(), Some(130));
    assert!(scratch.names().is_empty());
    drop(log);
}

#[test]
fn work_that_does_not_come_to_its_end_is_ended() {
    let scratch = Scratch::new();
    let mut run = endless(&scratch, BUILD);
    let mut log = run.stdin.take().unwrap();
    log.write_all(SQUARE.repeat(10_000).as_bytes()).unwrap();
    // The log stays open and says no more; nobody presses Ctrl-C again.
    signal(&run, "INT");
    assert_eq!(run.wait().unwrap().code(), Some(130));
    assert!(scratch.names().is_empty());
    drop(log);
}

#[test]
fn a_build_ends_in_good_order_at_any_time() {
    let scratch = Scratch::new();
    scratch.succeeds(&["simulate", "hall", "--landmarks", "1500", "-q", "-o", "hall"]);
    let mut interrupted = 0;
    for milliseconds in [10, 150, 300, 450, 600, 750, 900] {
        let run =
            endless(&scratch, &["build", "hall/observations.jsonl", "-o", "map.json", "--threads", "1"]);
        thread::sleep(Duration::from_millis(milliseconds));
        signal(&run, "INT");
        let output = run.wait_with_output().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        if output.status.code() == Some(130) {
            assert!(said.ends_with("covimap: interrupted\n"), "{said}");
            assert_eq!(scratch.names(), ["hall"], "after {milliseconds} ms");
            interrupted += 1;
        } else {
            // It was done first, and its map is whole.
            assert_eq!(output.status.code(), Some(0), "{said}");
            scratch.succeeds(&["info", "map.json"]);
            std::fs::remove_file(scratch.path().join("map.json")).unwrap();
        }
    }
    assert!(interrupted > 0, "no build takes so little");
}
