//! What can go wrong between a log and a map.

use std::path::PathBuf;

/// Why a log could not be read or a map not be built, read or written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MapError {
    /// A line of an input file does not say what its format asks.
    #[error("{file}:{line}: {what}")]
    BadLine {
        /// File as the user named it, `<stdin>` for standard input.
        file: String,
        /// Line, counted from 1.
        line: u64,
        /// What is wrong; what to do.
        what: String,
    },
    /// A file could not be opened, read or written.
    #[error("{}: {what}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What was tried and what to do.
        what: String,
        /// The system's own words.
        #[source]
        source: std::io::Error,
    },
    /// Neither the name nor the first bytes of a log tell its format.
    #[error(
        "{file}: cannot tell the log format from the name or the first line; \
         name it (--format jsonl, csv or text)"
    )]
    UnknownFormat {
        /// File as the user named it, `<stdin>` for standard input.
        file: String,
    },
    /// A log was read to its end without a step.
    #[error("{sources}: no step in the log; a step is a line like {{\"t\": 12.5, \"seen\": [\"A\", \"B\"]}}")]
    NoSteps {
        /// The files read, as the user named them.
        sources: String,
    },
    /// A log has more steps than can be counted.
    #[error("the log has {steps} steps, at most {limit} can be counted; split it", limit = u32::MAX)]
    TooManySteps {
        /// Steps of the log.
        steps: usize,
    },
    /// Counts given by the caller contradict each other.
    #[error("{what}")]
    BadCounts {
        /// Which, and what is asked.
        what: String,
    },
    /// The caller's [`crate::Observer`] asked to stop.
    #[error("interrupted")]
    Interrupted,
}
