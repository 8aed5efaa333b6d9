//! Logs that are wrong: each gets an error that says where and what to do.

use std::io::{self, Read};

use proptest::prelude::*;

use super::*;

const GOOD: &str = "{\"seen\": [\"A\", \"B\"]}\n";

/// The message about line 3 of a JSONL log.
fn third_line(line: impl AsRef<[u8]>) -> String {
    let text = [GOOD.as_bytes(), b"\n", line.as_ref(), b"\n", GOOD.as_bytes()].concat();
    message(read(text, LogFormat::Jsonl))
}

#[test]
fn invalid_json() {
    assert_eq!(
        third_line(r#"{"t": 3, "seen": ["A", "B"}"#),
        "log:3: invalid JSON: expected `,` or `]` at column 27; a step is a line like {\"t\": 12.5, \"seen\": \
         [\"A\", \"B\"]}"
    );
    let bad = [
        "seen: A",
        r#"{"seen": ["A"]} {"seen": ["B"]}"#,
        r#"{"seen": ["A",]}"#,
        r#"{"seen": ["A"],}"#,
        r#"{"seen": ["A"]"#,
        r#"{"seen": ["A]}"#,
        r#"{"seen": [01]}"#,
        r#"{"seen": ["\ud800"]}"#,
        r#"{"t": 01, "seen": []}"#,
        r#"{"t": 1., "seen": []}"#,
        r#"{"t": NaN, "seen": []}"#,
        r#"{"t": 1e999, "seen": []}"#,
        "{\"seen\": [\"a\tb\"]}",
        "{\"seen\": [\"A\"]}\0",
    ];
    for line in bad {
        assert!(third_line(line).starts_with("log:3: invalid JSON: "), "{line}");
    }
}

#[test]
fn json_that_is_no_step() {
    let bad = [
        (r#"{"t": 1, "seen": "A"}"#, "string \"A\", expected `seen` to be a list of IDs"),
        (r#"{"seen": null}"#, "null, expected `seen` to be a list of IDs"),
        (r#"{"seen": {"A": 1}}"#, "map, expected `seen` to be a list of IDs"),
        (r#"{"seen": ["A", 1.5]}"#, "floating point `1.5`, expected an ID"),
        (r#"{"seen": [-0]}"#, "expected an ID"),
        (r#"{"seen": [18446744073709551616]}"#, "an integer of at most 64 bits"),
        (r#"{"seen": ["A", null]}"#, "null, expected an ID"),
        (r#"{"seen": [true]}"#, "boolean `true`, expected an ID"),
        (r#"{"seen": [["A"]]}"#, "sequence, expected an ID"),
        (r#"{"t": 3}"#, "missing field `seen`"),
        (r#"{"t": 3, "Seen": ["A"]}"#, "missing field `seen`"),
        (r#"{"seen": ["A"], "seen": ["B"]}"#, "duplicate field `seen`"),
        (r#"{"t": 1, "seen": [], "t": 2}"#, "duplicate field `t`"),
        (r#"{"t": "noon", "seen": []}"#, "`t` must be a number or null at column"),
        (r#"["A", "B"]"#, "expected an object with a list `seen`"),
        ("17", "expected an object with a list `seen`"),
    ];
    for (line, what) in bad {
        let message = third_line(line);
        assert!(message.starts_with("log:3: not a step: "), "{message}");
        assert!(message.contains(what), "{message}");
    }
}

#[test]
fn a_message_repeats_little_of_a_long_line() {
    let line = format!(r#"{{"seen": "{}"}}"#, "x".repeat(100_000));
    assert!(third_line(line).len() < 400);
}

#[test]
fn invalid_utf8() {
    assert_eq!(
        third_line(b"{\"seen\": [\"A\xFF\"]}"),
        // `{"seen": ["A` are 12 bytes.
        "log:3: byte 13 of the line, 0xFF, is not valid UTF-8; save the log as UTF-8 text"
    );
    let text = message(read(b"A B\nC \xC3\n", LogFormat::Text));
    assert!(text.starts_with("log:2: byte 3 of the line, 0xC3, is not"), "{text}");
}

#[test]
fn ids_that_can_only_be_a_mistake() {
    assert!(third_line(r#"{"seen": ["A", ""]}"#).starts_with("log:3: an ID is empty; "));
    let longest = "x".repeat(MAX_ID_BYTES);
    assert_eq!(steps(&read(&longest, LogFormat::Text).unwrap()), [[longest.as_str()]]);
    let texts = [
        (LogFormat::Jsonl, format!("\n{{\"seen\": [\"{}\"]}}", "x".repeat(10_000))),
        (LogFormat::Csv, format!("step,landmark\n1,{}", "x".repeat(10_000))),
        (LogFormat::Text, format!("A\n{}", "x".repeat(10_000))),
    ];
    for (format, text) in texts {
        let wanted = format!(
            "log:2: the ID `{}...` has 10000 bytes, at most 4096 are allowed; use shorter IDs",
            "x".repeat(40)
        );
        assert_eq!(message(read(text, format)), wanted);
    }
}

/// A line without end.
struct Endless;

impl Read for Endless {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        buffer.fill(b'x');
        Ok(buffer.len())
    }
}

#[test]
fn a_line_over_the_limit_is_not_read_to_its_end() {
    for format in [LogFormat::Jsonl, LogFormat::Csv, LogFormat::Text] {
        let stream = GOOD.as_bytes().chain(Endless);
        let result = SightingLog::read_from(stream, "log", Some(format), &Silent);
        let line = if format == LogFormat::Csv { 1 } else { 2 };
        let text = message(result);
        assert!(text.starts_with(&format!("log:{line}: ")), "{text}");
        if format != LogFormat::Csv {
            assert_eq!(
                text,
                "log:2: the line is longer than 16777216 bytes; write one step a line, or split this step"
            );
        }
    }
}

#[test]
fn the_longest_line_is_read() {
    let line = format!("{}{GOOD}", " ".repeat(MAX_LINE_BYTES - (GOOD.len() - 1)));
    assert_eq!(steps(&read(format!("{line}{GOOD}"), LogFormat::Jsonl).unwrap()), [["A", "B"], ["A", "B"]]);
    let text = message(read(format!("{GOOD} {line}"), LogFormat::Jsonl));
    assert!(text.starts_with("log:2: the line is longer than "), "{text}");
}

#[test]
fn csv_without_header() {
    assert_eq!(
        message(read("1,A\n1,B\n", LogFormat::Csv)),
        "log:1: the header must name the columns `step` and `landmark`, but the first line is `1,A`; put \
         `step,landmark` in front, with a comma between"
    );
    let text = message(read("\nstep;landmark\n1;A\n", LogFormat::Csv));
    assert!(text.starts_with("log:2: the header must name the columns"), "{text}");
}

#[test]
fn broken_csv_rows() {
    let bad = [
        ("3", "the row has 1 fields, the header has 2; give every row 2"),
        ("3,A,", "the row has 3 fields, the header has 2; give every row 2"),
        ("3,", "an ID is empty; "),
        (" ,A", "the step is empty; "),
        ("3,\"A", "a quoted field is not closed on its line; "),
        ("1,C", "step `1` has rows further up, with other steps between; "),
    ];
    for (row, what) in bad {
        let text = message(read(format!("step,landmark\n1,A\n\n2,B\n{row}\n4,D\n"), LogFormat::Csv));
        assert!(text.starts_with(&format!("log:5: {what}")), "{text}");
    }
}

#[test]
fn no_step_at_all() {
    let texts = [
        (LogFormat::Jsonl, ""),
        (LogFormat::Jsonl, "\n \n"),
        (LogFormat::Csv, ""),
        (LogFormat::Csv, "step,landmark\n"),
        (LogFormat::Text, ""),
    ];
    for (format, text) in texts {
        let error = read(text, format).unwrap_err();
        assert!(matches!(error, MapError::NoSteps { .. }), "{format:?}: {error}");
        assert_eq!(
            error.to_string(),
            "log: no step in the log; a step is a line like {\"t\": 12.5, \"seen\": [\"A\", \"B\"]}"
        );
    }
}

#[test]
fn text_of_unknown_format() {
    let open = |text: &str| SightingLog::read_from(text.as_bytes(), "log", None, &Silent);
    assert_eq!(steps(&open(&format!("\n {GOOD}")).unwrap()), [["A", "B"]]);
    let error = open("A B\n").unwrap_err();
    assert!(matches!(error, MapError::UnknownFormat { .. }));
    assert_eq!(
        error.to_string(),
        "log: cannot tell the log format from the name or the first line; name it (--format jsonl, csv or \
         text)"
    );
}

proptest! {
    #[test]
    fn no_bytes_at_all_make_the_reader_panic(
        bytes in prop::collection::vec(prop_oneof![any::<u8>(), prop::sample::select(&b"{}[]\",:\n \\1atesn"[..])], 0..200),
    ) {
        for format in [LogFormat::Jsonl, LogFormat::Csv, LogFormat::Text] {
            if let Err(error) = read(&bytes, format) {
                let expected = matches!(error, MapError::BadLine { .. } | MapError::NoSteps { .. });
                prop_assert!(expected, "{}", error);
            }
        }
    }
}
