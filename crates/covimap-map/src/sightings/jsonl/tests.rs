use proptest::prelude::*;

use super::*;

fn scanned(line: &str) -> Option<Vec<Cow<'_, str>>> {
    let mut ids = Vec::new();
    scan(line.as_bytes(), line, &mut ids)?;
    Some(ids)
}

#[test]
fn plain_lines_are_scanned() {
    let lines = [
        r#"{"t": 12.5, "seen": ["A", "B"]}"#,
        r#"{"t":null,"seen":["A","B"]}"#,
        r#" { "seen" : [ "A" , "B" ] , "t" : -0.25 } "#,
        "{\"seen\":[\"A\",\"B\"]}\r",
    ];
    for line in lines {
        assert_eq!(scanned(line).unwrap(), ["A", "B"], "{line}");
    }
    assert_eq!(
        scanned(r#"{"seen": [0, -7, 123456789012345678]}"#).unwrap(),
        ["0", "-7", "123456789012345678"]
    );
    assert_eq!(scanned("{\"seen\": [\"caf\u{e9}\", \"\"]}").unwrap(), ["caf\u{e9}", ""]);
    assert!(scanned(r#"{"seen": []}"#).unwrap().is_empty());
}

#[test]
fn other_lines_are_left_to_the_parser() {
    let right = [
        r#"{"seen": ["\n"]}"#,
        r#"{"seen": [1234567890123456789]}"#,
        r#"{"t": 1e5, "seen": []}"#,
        r#"{"seen": [], "more": 1}"#,
    ];
    for line in right {
        assert_eq!(scanned(line), None, "{line}");
        assert!(parse(line).is_ok(), "{line}");
    }
}

#[test]
fn a_bad_line_leaves_no_ids() {
    let mut shown = Shown { ids: vec![Cow::Borrowed("before")], ranges: Vec::new() };
    assert!(parse_line(r#"{"seen": ["A", "B"]"#, &mut shown).is_err());
    assert!(!parse_line("  ", &mut shown).unwrap());
    assert_eq!(shown.ids, ["before"]);
    assert!(parse_line(r#"{"seen": ["\u0041", 1]}"#, &mut shown).unwrap());
    assert_eq!(shown.ids, ["before", "A", "1"]);
    assert!(shown.ranges.is_empty());
}

#[test]
fn ranges_belong_to_what_is_seen() {
    let mut shown = Shown { ids: vec![Cow::Borrowed("before")], ranges: Vec::new() };
    let line = r#"{"seen": ["A", 7, "B"], "ranges": {"B": 1.5, "7": 2}, "t": 1}"#;
    assert!(parse_line(line, &mut shown).unwrap());
    assert_eq!(shown.ranges, [(3, 1.5), (2, 2.0)]);
    let refused = |ranges: &str| {
        parse_line(&format!(r#"{{"seen": ["A", "B"], "ranges": {ranges}}}"#), &mut Shown::default())
            .unwrap_err()
    };
    assert!(refused(r#"{"C": 1}"#).starts_with("a range to `C`, which `seen` does not list"));
    assert!(refused(r#"{"A": -1}"#).starts_with("the range to `A` is -1; give metres above 0"));
    assert!(refused(r#"{"A": 0}"#).starts_with("the range to `A` is 0"));
    assert!(refused(r#"{"A": 1, "A": 2}"#).contains("two ranges to `A`"));
    assert!(refused(r#"{"A": NaN}"#).starts_with("invalid JSON"));
    assert!(refused(r#"{"A": 1e999}"#).contains("number out of range"));
    assert!(refused(r#"{"A": "near"}"#).starts_with("not a step"));
    assert!(refused("[1, 2]").contains("`ranges` to be an object of metres by ID"));
}

/// Pieces of which lines are made, right ones and almost right ones.
const PIECES: &[&str] = &[
    "{",
    "}",
    "[",
    "]",
    ",",
    ":",
    " ",
    "\t",
    "\r",
    "\u{b}",
    "\"",
    "\\",
    "\"seen\"",
    "\"t\"",
    "\"A\"",
    "\"\u{e9}\"",
    "\"\\u0041\"",
    "null",
    "nul",
    "0",
    "-0",
    "01",
    "-",
    "1",
    "1.5",
    "1.",
    ".5",
    "1e3",
    "1e999",
    "12345678901234567890",
    "true",
    "\"seen\":[\"A\",1]",
    "\"t\":0.5,",
    "\u{1}",
];

/// Lines near the right ones: a right line in which some pieces are put in or taken out.
fn line() -> impl Strategy<Value = String> {
    let right = ["{", "\"t\"", ":", "1.5", ",", "\"seen\"", ":", "[", "\"A\"", ",", "7", "]", "}"];
    let edit = (0..right.len(), any::<bool>(), prop::sample::select(PIECES));
    prop::collection::vec(edit, 0..4).prop_map(move |edits| {
        let mut pieces = right.to_vec();
        for (place, replace, piece) in edits {
            pieces.splice(place..place + usize::from(replace), [piece]);
        }
        pieces.concat()
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(4096))]

    #[test]
    fn the_scanner_says_what_the_parser_says_or_nothing(line in line()) {
        if let Some(ids) = scanned(&line) {
            prop_assert_eq!(Ok(ids), parse(&line).map(|step| step.seen));
        }
    }

    #[test]
    fn any_order_of_pieces_is_safe_to_scan(
        pieces in prop::collection::vec(prop::sample::select(PIECES), 0..16),
    ) {
        let line = pieces.concat();
        if let Some(ids) = scanned(&line) {
            prop_assert_eq!(Ok(ids), parse(&line).map(|step| step.seen));
        }
    }
}
