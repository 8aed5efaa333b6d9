//! Files, compression, several logs as one, and looking through a whole log.

use std::fs;
use std::io::Write;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use tempfile::TempDir;

use super::*;

const TEXT: &str = "{\"seen\": [\"A\", \"B\"]}\n{\"seen\": [\"B\", \"C\"]}\n";

fn gzip(text: &[u8]) -> Vec<u8> {
    let mut packer = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::fast());
    packer.write_all(text).unwrap();
    packer.finish().unwrap()
}

fn zstd(text: &[u8]) -> Vec<u8> {
    zstd::encode_all(text, 1).unwrap()
}

/// A folder with files.
fn folder(files: &[(&str, &[u8])]) -> (TempDir, Vec<PathBuf>) {
    let folder = tempfile::tempdir().unwrap();
    let paths = files.iter().map(|(name, content)| {
        let path = folder.path().join(name);
        fs::write(&path, content).unwrap();
        path
    });
    let paths = paths.collect();
    (folder, paths)
}

fn read_file(name: &str, content: &[u8]) -> Result<SightingLog, MapError> {
    let (_folder, paths) = folder(&[(name, content)]);
    SightingLog::read(&paths, None, &Silent)
}

#[test]
fn the_name_tells_the_format() {
    let formats = [
        ("a.jsonl", Some(LogFormat::Jsonl)),
        ("a.b.NDJSON.gz", Some(LogFormat::Jsonl)),
        ("a.json", Some(LogFormat::Jsonl)),
        ("dir.csv/a.csv.zst", Some(LogFormat::Csv)),
        ("a.txt", Some(LogFormat::Text)),
        ("a.text.gz", Some(LogFormat::Text)),
        ("a.gz", None),
        ("a.dat", None),
        ("csv", None),
        ("-", None),
    ];
    for (name, format) in formats {
        assert_eq!(LogFormat::from_path(name.as_ref()), format, "{name}");
    }
    assert_eq!(steps(&read_file("a.csv", b"step,landmark\n1,A\n").unwrap()), [["A"]]);
    assert_eq!(steps(&read_file("a.txt", b"A B").unwrap()), [["A", "B"]]);
    assert_eq!(steps(&read_file("a.dat", TEXT.as_bytes()).unwrap()), [["A", "B"], ["B", "C"]]);
}

#[test]
fn compression_is_seen_whatever_the_name_says() {
    let text = TEXT.as_bytes();
    let two_members = [gzip(&text[..30]), gzip(&text[30..])].concat();
    let two_frames = [zstd(&text[..30]), zstd(&text[30..])].concat();
    for packed in [text.to_vec(), gzip(text), zstd(text), two_members, two_frames] {
        for name in ["a.jsonl", "a.jsonl.gz", "a.jsonl.zst"] {
            assert_eq!(steps(&read_file(name, &packed).unwrap()), [["A", "B"], ["B", "C"]]);
        }
    }
}

#[test]
fn compressed_data_that_break_off() {
    let text = TEXT.repeat(1000);
    for packed in [gzip(text.as_bytes()), zstd(text.as_bytes())] {
        let error = read_file("a.jsonl.gz", &packed[..packed.len() - 9]).unwrap_err().to_string();
        let (_, place) = error.split_once("a.jsonl.gz:").unwrap();
        let (line, what) = place.split_once(": ").unwrap();
        assert!((1..=2001).contains(&line.parse().unwrap()), "{error}");
        assert_eq!(what, "the compressed data break off here; the file is cut short, copy or pack it again");
    }
}

#[test]
fn compressed_data_that_are_damaged() {
    let mut packed = gzip(TEXT.as_bytes());
    let checksum = packed.len() - 8;
    packed[checksum] ^= 1;
    let error = read_file("a.jsonl.gz", &packed).unwrap_err().to_string();
    // Both lines were unpacked before the checksum showed that they are wrong.
    assert!(error.contains("a.jsonl.gz:3: reading fails here: "), "{error}");
    assert!(error.ends_with("is damaged, copy or pack it again"), "{error}");
}

#[test]
fn several_files_are_one_log_in_the_order_given() {
    let (_folder, paths) = folder(&[
        ("1.jsonl", TEXT.as_bytes()),
        ("2.csv", b"step,landmark\n1,D\n1,A\n"),
        ("3.txt", b"E C"),
        ("4.csv", b"step,landmark\n1,B\n"),
    ]);
    let log = SightingLog::read(&paths, None, &Silent).unwrap();
    let wanted = [vec!["A", "B"], vec!["B", "C"], vec!["A", "D"], vec!["C", "E"], vec!["B"]];
    assert_eq!(steps(&log), wanted);
    assert_eq!(log.summary().lines, 2 + 3 + 1 + 2);
}

#[test]
fn an_error_names_the_file_it_is_in() {
    let (_folder, paths) = folder(&[("1.jsonl", TEXT.as_bytes()), ("2.jsonl", b"{}\n")]);
    let error = SightingLog::read(&paths, None, &Silent).unwrap_err().to_string();
    assert!(error.starts_with(&format!("{}:1: not a step", paths[1].display())), "{error}");
}

#[test]
fn a_directory_or_a_missing_file_is_no_log() {
    let folder = tempfile::tempdir().unwrap();
    let error = SightingLog::read(&[folder.path()], None, &Silent).unwrap_err();
    assert!(matches!(error, MapError::Io { .. }));
    let name = folder.path().display();
    assert_eq!(error.to_string(), format!("{name}: is a directory; name the log file inside it"));
    let missing = folder.path().join("a.jsonl");
    let error = SightingLog::read(&[&missing], None, &Silent).unwrap_err();
    assert!(matches!(error, MapError::Io { .. }));
    let wanted = format!("{}: cannot be opened; check its name and rights", missing.display());
    assert_eq!(error.to_string(), wanted);
}

#[test]
fn check_gathers_bad_lines_and_goes_on() {
    let (_folder, paths) = folder(&[
        ("1.jsonl", b"{\"seen\": [\"A\", \"A\"]}\nx\n{\"seen\": [\"B\", 1.5]}\n\n{\"seen\": [\"C\"]}\n"),
        ("2.csv", b"step,landmark\n1,A\n2\n2,D\n1,E\n"),
        ("3.csv", b"1,A\n2,A\n"),
    ]);
    let check = SightingLog::check(&paths, None, 3, &Silent).unwrap();
    let places: Vec<_> = check.problems.iter().map(|problem| (&problem.file, problem.line)).collect();
    let names: Vec<_> = paths.iter().map(|path| path.display().to_string()).collect();
    assert_eq!(places, [(&names[0], 2), (&names[0], 3), (&names[1], 3)]);
    // Lines 2 and 3; rows 3 and 5; the header.
    assert_eq!(check.bad_lines, 5);
    let LogSummary { lines, steps, landmarks, sightings, duplicates, .. } = check.summary;
    // A and C of the first file, A and D of the second.
    assert_eq!((lines, steps, landmarks, sightings, duplicates), (12, 4, 3, 4, 1));
    let shown = check.problems[2].to_string();
    assert_eq!(shown, format!("{}:3: the row has 1 fields, the header has 2; give every row 2", names[1]));
}

#[test]
fn check_goes_on_behind_a_line_over_the_limit() {
    let mut text = TEXT.as_bytes().to_vec();
    text.resize(text.len() + 3 * MAX_LINE_BYTES, b'x');
    text.extend_from_slice(b"\n\n");
    text.extend_from_slice(TEXT.as_bytes());
    text.extend_from_slice(b"x");
    let (_folder, paths) = folder(&[("1.jsonl", &text)]);
    let check = SightingLog::check(&paths, None, 9, &Silent).unwrap();
    let lines: Vec<_> = check.problems.iter().map(|problem| problem.line).collect();
    assert_eq!((lines, check.bad_lines, check.summary.steps), (vec![3, 7], 2, 4));
    let empty = SightingLog::check(&[&paths[0]], Some(LogFormat::Csv), 0, &Silent).unwrap();
    assert_eq!((empty.bad_lines, empty.problems.len(), empty.summary.steps), (2, 0, 0));
}

/// Counts bytes, and asks to stop after some of them.
#[derive(Default)]
struct Watch {
    enough: Option<u64>,
    total: AtomicU64,
    bytes: AtomicU64,
    finished: AtomicBool,
}

impl Observer for Watch {
    fn started(&self, stage: Stage, total: Option<u64>) {
        assert_eq!(stage, Stage::Read);
        self.total.store(total.unwrap_or(0), Ordering::Relaxed);
    }
    fn advanced(&self, amount: u64) {
        self.bytes.fetch_add(amount, Ordering::Relaxed);
    }
    fn finished(&self, _: Stage) {
        self.finished.store(true, Ordering::Relaxed);
    }
    fn interrupted(&self) -> bool {
        self.enough.is_some_and(|enough| self.bytes.load(Ordering::Relaxed) >= enough)
    }
}

#[test]
fn the_observer_hears_of_every_byte_on_disk() {
    let packed = gzip(TEXT.as_bytes());
    let (_folder, paths) = folder(&[("1.jsonl", TEXT.as_bytes()), ("2.jsonl.gz", &packed)]);
    let watch = Watch::default();
    SightingLog::read(&paths, None, &watch).unwrap();
    let size = (TEXT.len() + packed.len()) as u64;
    assert_eq!(watch.total.into_inner(), size);
    assert_eq!(watch.bytes.into_inner(), size);
    assert!(watch.finished.into_inner());
}

#[test]
fn reading_stops_when_the_observer_asks_for_it() {
    let text = TEXT.repeat(200_000);
    for enough in [0, 10, 5_000_000] {
        for format in [LogFormat::Jsonl, LogFormat::Text, LogFormat::Csv] {
            let watch = Watch { enough: Some(enough), ..Watch::default() };
            let text = if format == LogFormat::Csv {
                &format!("step,landmark\n{}", "1,A\n".repeat(2_000_000))
            } else {
                &text
            };
            let result = SightingLog::read_from(text.as_bytes(), "log", Some(format), &watch);
            assert!(matches!(result, Err(MapError::Interrupted)), "{enough} {format:?}");
            assert!(!watch.finished.into_inner());
        }
    }
}
