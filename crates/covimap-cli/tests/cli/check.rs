//! `covimap check`.

use crate::scratch::Scratch;

#[test]
fn a_good_log_is_counted() {
    let scratch = Scratch::new();
    scratch.file("log.txt", "A B A\n\nC\nA B C\n");
    let run = scratch.succeeds(&["check", "log.txt"]);
    assert_eq!(run.stderr, "");
    for line in [
        "lines                     4\n",
        "steps                     4\n",
        "  with nothing seen       1\n",
        "  with one landmark       1\n",
        "  with two or more        2\n",
        "most landmarks in a step  3\n",
        "sightings                 6\n",
        "repeated within a step    1\n",
    ] {
        assert!(run.stdout.contains(line), "{line:?} is not in {}", run.stdout);
    }
    let object = scratch.succeeds(&["check", "log.txt", "--json"]).json();
    assert_eq!(object["summary"]["landmarks"], 3);
    assert_eq!(object["bad_lines"], 0);
}

#[test]
fn all_bad_lines_are_counted_and_the_first_ones_listed() {
    let scratch = Scratch::new();
    scratch
        .file("log.jsonl", "{\"seen\": [\"A\", \"B\"]}\n{\"seen\": 1}\n[]\n{\"seen\": [\"B\", \"C\"]}\n{\n");
    let run = scratch.run(&["check", "log.jsonl", "--list", "2"]);
    assert_eq!(run.code, Some(3));
    let said: Vec<_> = run.stderr.lines().collect();
    assert!(said[0].starts_with("log.jsonl:2: ") && said[1].starts_with("log.jsonl:3: "), "{said:?}");
    assert_eq!(said[2..], ["and 1 bad line more; --list N lists N of them"]);
    assert!(run.stdout.contains("bad lines                 3\n"), "{}", run.stdout);

    let run = scratch.run(&["check", "log.jsonl", "--json", "-q"]);
    assert_eq!(run.code, Some(3));
    let object = run.json();
    assert_eq!(object["summary"]["shared_steps"], 2);
    assert_eq!(object["problems"][2]["line"], 5);
    assert_eq!(object["problems"][2]["file"], "log.jsonl");
}

#[test]
fn a_log_that_makes_no_map_is_warned_of() {
    let scratch = Scratch::new();
    scratch.file("log.txt", "A\nB\n");
    let run = scratch.succeeds(&["check", "log.txt"]);
    assert!(run.stderr.starts_with("warning: no step shows two landmarks"), "{}", run.stderr);
    assert_eq!(scratch.succeeds(&["check", "-q", "log.txt"]).stderr, "");
}
