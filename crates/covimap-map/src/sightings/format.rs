//! The formats a log can have.

use std::path::Path;

/// How a log is written; see the module documentation of the crate's log reader.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LogFormat {
    /// One JSON object a step: `{"t": 12.5, "seen": ["A", "B"]}`.
    Jsonl,
    /// Header `step,landmark`, then one sighting a row.
    Csv,
    /// One step a line, IDs separated by white space.
    Text,
}

impl LogFormat {
    /// The format that a file name stands for, `.gz` and `.zst` aside:
    /// `jsonl`, `ndjson`, `json`; `csv`; `txt`, `text`. `None` for any other.
    #[must_use]
    pub fn from_path(path: &Path) -> Option<Self> {
        let mut path = path.to_path_buf();
        if matches!(extension(&path).as_deref(), Some("gz" | "zst")) {
            path.set_extension("");
        }
        match extension(&path)?.as_str() {
            "jsonl" | "ndjson" | "json" => Some(Self::Jsonl),
            "csv" => Some(Self::Csv),
            "txt" | "text" => Some(Self::Text),
            _ => None,
        }
    }

    /// What the text itself shows: an object is JSONL, and so is nothing at all.
    pub(super) fn from_text(text: &[u8]) -> Option<Self> {
        match text.trim_ascii_start().first() {
            None | Some(b'{') => Some(Self::Jsonl),
            Some(_) => None,
        }
    }
}

fn extension(path: &Path) -> Option<String> {
    Some(path.extension()?.to_str()?.to_ascii_lowercase())
}
