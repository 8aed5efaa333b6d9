//! The log does not depend on how the text is cut, nor on the number of threads.

use proptest::prelude::*;

use super::super::blocks::Limits;
use super::super::read::Reading;
use super::super::source::Source;
use super::*;

/// Reads with blocks of some size on some threads; a small limit of the line length is kept.
fn read_cut(
    text: &[u8],
    format: LogFormat,
    on_bad_line: OnBadLine,
    block_bytes: usize,
    threads: usize,
) -> Result<(SightingLog, Vec<LogProblem>, u64), String> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| {
        let mut reading = Reading::new(on_bad_line, &Silent);
        reading.rules.limits = Limits { block_bytes, line_bytes: 60 };
        let source = Source::new("log", text, &Silent).unwrap();
        reading.source(source, Some(format)).map_err(|error| error.to_string())?;
        let (problems, bad_lines) = (std::mem::take(&mut reading.problems), reading.bad_lines);
        Ok((reading.finish(), problems, bad_lines))
    })
}

/// Lines of all sorts, few of them bad.
fn line(format: LogFormat) -> BoxedStrategy<String> {
    let ids = prop::collection::vec("[A-H]{1,2}", 0..6);
    match format {
        LogFormat::Jsonl => prop_oneof![
            8 => ids.prop_map(|ids| format!("{{\"seen\": {ids:?}}}")),
            1 => Just(String::new()),
            1 => Just(r#"{"t": 1e0, "seen": ["\u0041\u0041"]}"#.into()),
            1 => Just("{".into()),
            1 => Just("x".repeat(61)),
            1 => Just("x".repeat(200)),
        ]
        .boxed(),
        LogFormat::Csv => prop_oneof![
            6 => ("[1-9]{1,2}", "[A-H]{1,2}").prop_map(|(step, id)| format!("{step},{id}")),
            1 => Just("1,\"A\"".into()),
            1 => Just(String::new()),
            1 => Just("1".into()),
        ]
        .boxed(),
        LogFormat::Text => ids.prop_map(|ids| ids.join(" ")).boxed(),
    }
}

fn text(format: LogFormat) -> impl Strategy<Value = String> {
    let header = if format == LogFormat::Csv { "step,landmark\n" } else { "" };
    let lines = prop::collection::vec((line(format), prop::sample::select(vec!["\n", "\r\n"])), 0..40);
    (lines, any::<bool>()).prop_map(move |(lines, open_end)| {
        let mut text: String = lines.into_iter().map(|(line, end)| line + end).collect();
        text.insert_str(0, header);
        if open_end {
            text.truncate(text.trim_end().len());
        }
        text
    })
}

fn any_log() -> impl Strategy<Value = (LogFormat, String)> {
    prop::sample::select(vec![LogFormat::Jsonl, LogFormat::Csv, LogFormat::Text])
        .prop_flat_map(|format| (Just(format), text(format)))
}

proptest! {
    #[test]
    fn blocks_and_threads_leave_no_trace(
        (format, text) in any_log(),
        block_bytes in 1..300_usize,
        threads in 1..4_usize,
    ) {
        for on_bad_line in [OnBadLine::Stop, OnBadLine::Gather { keep: 3 }] {
            let whole = read_cut(text.as_bytes(), format, on_bad_line, 1 << 20, 1);
            let cut = read_cut(text.as_bytes(), format, on_bad_line, block_bytes, threads);
            prop_assert_eq!(cut, whole);
        }
    }
}

#[test]
fn names_are_numbered_by_first_appearance_across_blocks() {
    // Every block brings names of its own and names that another block of the batch brings too.
    let text: String = (0..500).map(|step| format!("n{} n{} n{}\n", step, step / 2, 499 - step)).collect();
    let whole = read_cut(text.as_bytes(), LogFormat::Text, OnBadLine::Stop, 1 << 20, 1).unwrap().0;
    let mut expected: Vec<String> = Vec::new();
    for name in text.split_whitespace() {
        if !expected.iter().any(|known| known == name) {
            expected.push(name.into());
        }
    }
    assert_eq!(whole.names().iter().collect::<Vec<_>>(), expected);
    for threads in [1, 2, 5] {
        let cut = read_cut(text.as_bytes(), LogFormat::Text, OnBadLine::Stop, 100, threads).unwrap().0;
        assert_eq!(cut, whole);
    }
}
