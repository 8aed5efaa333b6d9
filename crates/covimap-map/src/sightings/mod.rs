//! Logs of sightings: which landmarks were seen together, step by step.
//!
//! | format | a step | ID |
//! |---|---|---|
//! | [`LogFormat::Jsonl`] | a line `{"t": 12.5, "seen": ["A", "B"]}` | string, or integer taken as its decimal text |
//! | [`LogFormat::Csv`] | rows `step,landmark` that follow each other, under that header | field |
//! | [`LogFormat::Text`] | a line `A B` | anything without white space |
//!
//! Steps are in the order of the file, which is their order in time. Common to all formats:
//!
//! - An ID is a text of 1 to [`MAX_ID_BYTES`] bytes; `12` and `"12"` are the same landmark. An ID
//!   that occurs again within its step counts once ([`LogSummary::duplicates`] tells how often).
//! - The text is UTF-8, with or without a byte-order mark, lines end in `\n` or `\r\n` and have at
//!   most [`MAX_LINE_BYTES`] bytes. Compression by gzip or zstd is seen and undone.
//! - A step in which nothing was seen is `{"seen": []}` or a blank line of plain text; CSV cannot
//!   say it. Blank lines of JSONL and CSV mean nothing.
//! - JSONL: `t` may be missing or null; `"ranges": {"A": 1.25}` gives the distance in metres from the robot to some of
//!   those seen; other keys are ignored. CSV: other columns are ignored.
//!
//! # Memory and speed
//!
//! The text is never held, only the log made of it: 4 bytes a sighting, 8 a step, and the names.
//! Blocks of 2 MiB are taken apart in parallel; the result does not depend on the number of threads.

mod blocks;
mod check;
mod csv;
mod format;
mod interner;
mod join;
mod jsonl;
mod lines;
mod problem;
mod read;
mod shown;
mod source;
mod text;
mod tokens;
mod write;

use std::io::Read;
use std::path::Path;

pub use check::LogCheck;
pub use format::LogFormat;
pub use lines::MAX_ID_BYTES;
pub use problem::LogProblem;
pub use read::MAX_LINE_BYTES;
pub use write::JsonlWriter;

use crate::{LandmarkNames, MapError, Observer, Stage};
use problem::OnBadLine;
use read::Reading;
use source::Source;
use tokens::LogBuilder;

/// A log of sightings, compact: 4 bytes a sighting and 8 a step.
///
/// ```
/// use covimap_map::{LandmarkId, Silent, SightingLog};
///
/// let text = r#"{"t": 0, "seen": ["door", "desk"]}
/// {"t": 1, "seen": ["desk", "lamp", "desk"]}"#;
/// let log = SightingLog::read_from(text.as_bytes(), "robot.jsonl", None, &Silent)?;
/// assert_eq!(log.names().iter().collect::<Vec<_>>(), ["door", "desk", "lamp"]);
/// assert_eq!(log.step(1), [1, 2]);
/// assert_eq!(log.summary().duplicates, 1);
/// # Ok::<(), covimap_map::MapError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct SightingLog {
    names: LandmarkNames,
    /// Step t: `starts[t]..starts[t + 1]` of `seen`.
    starts: Vec<usize>,
    /// Landmarks, ascending within a step.
    seen: Vec<u32>,
    /// By step and landmark.
    ranges: Vec<Range>,
    lines: u64,
    duplicates: u64,
}

/// How far a landmark was from the robot, where the log tells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// Step that shows the landmark, counted from 0.
    pub step: usize,
    /// Number of the landmark.
    pub landmark: u32,
    /// Distance from the robot, metres, `> 0`.
    pub metres: f64,
}

/// What a log holds, in numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
pub struct LogSummary {
    /// Lines of text, blank ones included; 0 for a log that was not read from text.
    pub lines: u64,
    /// Steps, empty ones included.
    pub steps: u64,
    /// Steps in which nothing was seen.
    pub empty_steps: u64,
    /// Steps with a single landmark: they tell how often it was seen, but nothing of where it is.
    pub single_steps: u64,
    /// Steps with two landmarks or more: what a map is made from.
    pub shared_steps: u64,
    /// Most landmarks in one step.
    pub largest_step: u64,
    /// Sightings, each landmark once a step.
    pub sightings: u64,
    /// IDs that occurred again within their step; they are not counted as sightings.
    pub duplicates: u64,
    /// Landmarks seen at least once.
    pub landmarks: u64,
}

impl SightingLog {
    /// Reads files as one log, in the order given; `-` is standard input.
    ///
    /// The format is `format`, or what [`LogFormat::from_path`] makes of the name, or JSONL if the
    /// text begins with `{`. Tells the observer of [`Stage::Read`], counted in bytes on disk.
    ///
    /// # Errors
    ///
    /// - [`MapError::Io`]: a file is missing, a directory, or not readable.
    /// - [`MapError::UnknownFormat`]: neither the name nor the first character tells the format.
    /// - [`MapError::BadLine`]: the first line that is no step of its format, is no UTF-8, is longer
    ///   than [`MAX_LINE_BYTES`], or in which compressed data break off.
    /// - [`MapError::NoSteps`]: there is no step in any of the files.
    /// - [`MapError::Interrupted`]: the observer asked for it.
    pub fn read<P: AsRef<Path>>(
        paths: &[P],
        format: Option<LogFormat>,
        observer: &dyn Observer,
    ) -> Result<Self, MapError> {
        let mut reading = Reading::new(OnBadLine::Stop, observer);
        reading.paths(paths, format)?;
        let names = || paths.iter().map(|path| path.as_ref().display().to_string());
        reading.finish().with_steps(|| names().collect::<Vec<_>>().join(", "))
    }

    /// Reads a stream; `name` is what messages call it. Its format is `format`, or JSONL if it
    /// begins with `{`.
    ///
    /// # Errors
    ///
    /// As [`SightingLog::read`].
    pub fn read_from(
        stream: impl Read + Send,
        name: &str,
        format: Option<LogFormat>,
        observer: &dyn Observer,
    ) -> Result<Self, MapError> {
        let mut reading = Reading::new(OnBadLine::Stop, observer);
        observer.started(Stage::Read, None);
        reading.source(Source::new(name, stream, observer)?, format)?;
        observer.finished(Stage::Read);
        reading.finish().with_steps(|| name.into())
    }

    /// Makes a log of steps held in memory. IDs are taken as they are, without a limit.
    pub fn from_steps<I>(steps: I) -> Self
    where
        I: IntoIterator,
        I::Item: IntoIterator<Item: AsRef<str>>,
    {
        let mut builder = LogBuilder::new();
        for step in steps {
            for id in step {
                builder.push_sighting(id.as_ref());
            }
            builder.end_step();
        }
        Self::from_builder(builder, 0)
    }

    fn from_builder(builder: LogBuilder, lines: u64) -> Self {
        let LogBuilder { names, mut seen, mut starts, mut ranges, duplicates } = builder;
        ranges.sort_by_key(|range| (range.step, range.landmark));
        ranges.shrink_to_fit();
        seen.shrink_to_fit();
        starts.shrink_to_fit();
        Self { names: names.into_names(), starts, seen, ranges, lines, duplicates }
    }

    fn with_steps(self, sources: impl FnOnce() -> String) -> Result<Self, MapError> {
        if self.steps() == 0 { Err(MapError::NoSteps { sources: sources() }) } else { Ok(self) }
    }

    /// Number of steps T, empty ones included.
    #[must_use]
    pub fn steps(&self) -> usize {
        self.starts.len() - 1
    }

    /// Number of sightings over all steps.
    #[must_use]
    pub fn sightings(&self) -> usize {
        self.seen.len()
    }

    /// String IDs, in the order of first appearance.
    #[must_use]
    pub fn names(&self) -> &LandmarkNames {
        &self.names
    }

    /// The landmarks of a step ([`crate::LandmarkId`] numbers), ascending, each once.
    ///
    /// # Panics
    ///
    /// If there is no such step.
    #[must_use]
    pub fn step(&self, step: usize) -> &[u32] {
        &self.seen[self.starts[step]..self.starts[step + 1]]
    }

    /// The log with these ranges instead of its own, in any order.
    ///
    /// # Errors
    ///
    /// [`MapError::BadRange`] for one to a landmark that its step does not show, or that is not positive and finite.
    pub fn with_ranges(mut self, mut ranges: Vec<Range>) -> Result<Self, MapError> {
        let is_seen = |range: &Range| {
            range.step < self.steps() && self.step(range.step).binary_search(&range.landmark).is_ok()
        };
        let is_good = |range: &Range| is_seen(range) && range.metres > 0.0 && range.metres.is_finite();
        if let Some(&Range { step, landmark, metres }) = ranges.iter().find(|range| !is_good(range)) {
            return Err(MapError::BadRange { step, landmark, metres });
        }
        ranges.sort_by_key(|range| (range.step, range.landmark));
        self.ranges = ranges;
        Ok(self)
    }

    /// All ranges, by step and landmark; none unless the log tells some.
    #[must_use]
    pub fn ranges(&self) -> &[Range] {
        &self.ranges
    }

    /// All steps in time order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = &[u32]> + Clone {
        self.starts.windows(2).map(|ends| &self.seen[ends[0]..ends[1]])
    }

    /// What the log holds, in numbers. O(T).
    #[must_use]
    pub fn summary(&self) -> LogSummary {
        let count = |wanted: fn(usize) -> bool| self.iter().filter(|step| wanted(step.len())).count() as u64;
        LogSummary {
            lines: self.lines,
            steps: self.steps() as u64,
            empty_steps: count(|size| size == 0),
            single_steps: count(|size| size == 1),
            shared_steps: count(|size| size >= 2),
            largest_step: self.iter().map(<[u32]>::len).max().unwrap_or(0) as u64,
            sightings: self.sightings() as u64,
            duplicates: self.duplicates,
            landmarks: self.names.len() as u64,
        }
    }
}

#[cfg(test)]
mod tests;
