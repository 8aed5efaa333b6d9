//! What each format means.

use super::*;

fn jsonl(text: &str) -> SightingLog {
    read(text, LogFormat::Jsonl).unwrap()
}

#[test]
fn a_jsonl_line_is_a_step() {
    let log = jsonl("{\"t\": 0, \"seen\": [\"A\", \"B\"]}\n{\"t\":1.5,\"seen\":[\"C\",\"A\"]}\n");
    assert_eq!(steps(&log), [vec!["A", "B"], vec!["A", "C"]]);
    assert_eq!(log.names().iter().collect::<Vec<_>>(), ["A", "B", "C"]);
}

#[test]
fn jsonl_without_time_with_other_keys_and_in_any_order() {
    let log = jsonl(
        r#"{"seen": ["A"]}
        {"t": null, "seen": ["B"]}
        {"seen": ["C"], "t": -0.5e3}
        {"robot": {"seen": [["x"], "}"]}, "seen": ["D"], "pose": [1, 2, null]}"#,
    );
    assert_eq!(steps(&log), [["A"], ["B"], ["C"], ["D"]]);
}

#[test]
fn integers_are_ids_by_their_decimal_text() {
    let log = jsonl(r#"{"seen": [7, "7", -12, 0, 18446744073709551615, -9223372036854775808]}"#);
    assert_eq!(steps(&log), [["7", "-12", "0", "18446744073709551615", "-9223372036854775808"]]);
    assert_eq!(log.summary().duplicates, 1);
}

#[test]
fn escapes_mean_the_character_they_stand_for() {
    // \u0041 is A; \u00e9 is e with acute; \ud83e\udd16 is the surrogate pair of U+1F916.
    let log = jsonl(r#"{"seen": ["\u0041", "A", "caf\u00e9", "\ud83e\udd16", "a\tb\"c\\d\/e"]}"#);
    assert_eq!(steps(&log), [["A", "caf\u{e9}", "\u{1F916}", "a\tb\"c\\d/e"]]);
    assert_eq!(jsonl("{\"seen\": [\"caf\u{e9}\"]}").names().name(LandmarkId(0)), "caf\u{e9}");
}

#[test]
fn blank_jsonl_lines_mean_nothing_and_an_empty_list_is_a_step() {
    let log = jsonl("\n{\"seen\": []}\r\n  \t\r\n{\"seen\": [\"A\"]}");
    assert_eq!(steps(&log), [vec![], vec!["A"]]);
    assert_eq!(log.summary().lines, 4);
}

#[test]
fn a_text_line_is_a_step_and_a_blank_one_an_empty_step() {
    let log = read("A B\r\n\n  C\tA  \n", LogFormat::Text).unwrap();
    assert_eq!(steps(&log), [vec!["A", "B"], vec![], vec!["A", "C"]]);
}

#[test]
fn csv_rows_of_one_step_follow_each_other() {
    let log = read("step,landmark\n10,A\n10,B\n\n2,C\n2,A\r\n", LogFormat::Csv).unwrap();
    assert_eq!(steps(&log), [["A", "B"], ["A", "C"]]);
}

#[test]
fn csv_columns_may_come_in_any_order_beside_others_and_be_quoted() {
    let text = "time, landmark , x,step\n1,\"A, \"\"red\"\"\",,s1\n1, B ,2,s1\n2,B,\"\",\"s2\"\r\n";
    let log = read(text, LogFormat::Csv).unwrap();
    assert_eq!(steps(&log), [vec!["A, \"red\"", "B"], vec!["B"]]);
}

#[test]
fn a_landmark_counts_once_a_step_in_every_format() {
    let texts = [
        (LogFormat::Jsonl, r#"{"seen": ["B", "A", "B", "B"]}"#),
        (LogFormat::Csv, "step,landmark\n1,B\n1,A\n1,B\n1,B"),
        (LogFormat::Text, "B A B B"),
    ];
    for (format, text) in texts {
        let log = read(text, format).unwrap();
        assert_eq!(steps(&log), [["B", "A"]], "{format:?}");
        assert_eq!(log.summary().duplicates, 2, "{format:?}");
    }
}

#[test]
fn a_byte_order_mark_is_no_part_of_the_text() {
    let texts = [
        (LogFormat::Jsonl, "\u{FEFF}{\"seen\": [\"A\"]}"),
        (LogFormat::Csv, "\u{FEFF}step,landmark\n1,A"),
        (LogFormat::Text, "\u{FEFF}A"),
    ];
    for (format, text) in texts {
        assert_eq!(steps(&read(text, format).unwrap()), [["A"]], "{format:?}");
    }
}

#[test]
fn the_summary_counts_steps_by_their_size() {
    let log = read("A B\n\nC\nA A\nA B C\n\n", LogFormat::Text).unwrap();
    let wanted = LogSummary {
        lines: 6,
        steps: 6,
        empty_steps: 2,
        single_steps: 2,
        shared_steps: 2,
        largest_step: 3,
        // 2 + 0 + 1 + 1 + 3 + 0
        sightings: 7,
        duplicates: 1,
        landmarks: 3,
    };
    assert_eq!(log.summary(), wanted);
}

#[test]
fn steps_held_in_memory_make_the_same_log() {
    let log = SightingLog::from_steps([vec!["A", "B"], vec![], vec!["C", "A", "C"]]);
    assert_eq!(steps(&log), [vec!["A", "B"], vec![], vec!["A", "C"]]);
    assert_eq!(log.summary().duplicates, 1);
    assert_eq!(log.step(2), [0, 2]);
    assert_eq!((log.steps(), log.sightings()), (3, 4));
    assert_eq!(SightingLog::from_steps(Vec::<Vec<&str>>::new()).steps(), 0);
}
