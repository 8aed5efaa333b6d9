//! Output that cannot be written: exit code 1, old files untouched, nothing half-written.

use std::fs;
use std::process::Command;

use crate::scratch::Scratch;

const FAILURE: i32 = 1;

#[test]
fn a_place_that_takes_no_file_is_found_before_the_work() {
    let scratch = Scratch::with_square();
    fs::create_dir(scratch.path().join("folder")).unwrap();
    for (place, message) in [
        (
            "no/map.json",
            "covimap: no/map.json: cannot be written: its folder does not exist; create the folder first",
        ),
        ("folder", "covimap: folder: cannot be written: it is a folder; give the name of a file"),
        ("square.jsonl/map.json", "its folder does not exist"),
    ] {
        scratch.refuses(&["build", "square.jsonl", "-o", place], FAILURE, message);
        // Even an unreadable log is not looked at.
        scratch.refuses(&["build", "missing.jsonl", "-o", place], FAILURE, message);
    }
    scratch.succeeds(&["build", "square.jsonl", "-q"]);
    scratch.refuses(&["export", "square.map.json", "--to", "svg", "-o", "folder"], FAILURE, "it is a folder");
    scratch.refuses(&["demo", "-o", "no/demo.svg"], FAILURE, "its folder does not exist");
}

#[test]
fn a_protected_map_stays_as_it_is() {
    let scratch = Scratch::with_square();
    let old = scratch.file("old.json", "old");
    let mut rights = fs::metadata(&old).unwrap().permissions();
    rights.set_readonly(true);
    fs::set_permissions(&old, rights).unwrap();
    scratch.refuses(&["build", "square.jsonl", "-o", "old.json"], FAILURE, "no permission");
    assert_eq!(scratch.read("old.json"), "old");
}

#[test]
fn bad_input_leaves_an_old_map_alone() {
    let scratch = Scratch::with_map();
    let map = scratch.read("square.map.json");
    scratch.file("square.jsonl", "{\n");
    scratch.refuses(&["build", "square.jsonl"], 3, "square.jsonl:1: ");
    assert_eq!(scratch.read("square.map.json"), map);
}

#[test]
#[cfg(target_os = "linux")]
fn a_full_device() {
    let scratch = Scratch::with_square();
    let message = "covimap: /dev/full: cannot be written: no space is left; free some or choose another place\n  cause: ";
    scratch.refuses(&["build", "square.jsonl", "-o", "/dev/full"], FAILURE, message);
}

/// Fills a small file system of its own and builds into it. Needs the right to mount one, which
/// is not everywhere given; the full device above then has to do.
#[test]
#[cfg(target_os = "linux")]
fn a_full_disk() {
    const SCRIPT: &str = r#"
        mkdir disk && mount -t tmpfs -o size=64k none disk || exit 99
        echo old > disk/map.json
        cat /dev/zero > disk/filler 2> /dev/null
        "$1" build square.jsonl -o disk/map.json
        echo "code $?, $(cat disk/map.json), $(ls -A disk | tr '\n' ' ')"
    "#;
    let scratch = Scratch::with_square();
    let output = Command::new("unshare")
        .args(["--map-root-user", "--mount", "sh", "-c", SCRIPT, "sh", env!("CARGO_BIN_EXE_covimap")])
        .current_dir(scratch.path())
        .output();
    let Ok(output) = output else { return eprintln!("skipped: there is no unshare program") };
    let text = |bytes| String::from_utf8(bytes).unwrap();
    let (said, complaint) = (text(output.stdout), text(output.stderr));
    if !said.starts_with("code ") {
        return eprintln!("skipped: no file system can be mounted here: {complaint}");
    }
    assert_eq!(said, "code 1, old, filler map.json \n");
    assert!(complaint.contains("covimap: disk/map.json: cannot be written: no space is left"), "{complaint}");
}
