//! Ctrl-C.

#![cfg(unix)]

use std::io::Write;
use std::process::{Child, Command, Stdio};

use crate::scratch::{SQUARE, Scratch};

/// A build that reads an endless log.
fn endless(scratch: &Scratch) -> Child {
    Command::new(env!("CARGO_BIN_EXE_covimap"))
        .current_dir(scratch.path())
        .args(["build", "-", "-o", "map.json"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap()
}

fn signal(run: &Child, name: &str) {
    let sent = Command::new("kill").args([&format!("-{name}"), &run.id().to_string()]).status().unwrap();
    assert!(sent.success());
}

#[test]
fn an_interrupted_build_leaves_nothing_behind() {
    for name in ["INT", "TERM"] {
        let scratch = Scratch::new();
        let mut run = endless(&scratch);
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
fn a_second_interrupt_ends_a_build_that_waits() {
    let scratch = Scratch::new();
    let mut run = endless(&scratch);
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
