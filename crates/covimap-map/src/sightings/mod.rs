//! Logs of sightings: which landmarks were seen together, step by step.

mod blocks;
mod check;
mod csv;
mod format;
mod interner;
mod jsonl;
mod problem;
mod read;
mod source;
mod text;
mod tokens;
mod write;

use std::io::Read;
use std::path::Path;

pub use check::LogCheck;
pub use format::LogFormat;
pub use problem::LogProblem;
pub use read::{MAX_ID_BYTES, MAX_LINE_BYTES};
pub use write::JsonlWriter;

use crate::{LandmarkNames, MapError, Observer, Stage};
use problem::OnBadLine;
use read::Reading;
use source::Source;
use tokens::{LogBuilder, Tokens};

/// A log of sightings, compact: 4 bytes a sighting and 8 a step.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SightingLog {
    names: LandmarkNames,
    /// Step t: `starts[t]..starts[t + 1]` of `seen`.
    starts: Vec<usize>,
    /// Landmarks, ascending within a step.
    seen: Vec<u32>,
    lines: u64,
    duplicates: u64,
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
    /// # Errors
    ///
    /// [`MapError::BadLine`], [`MapError::Io`], [`MapError::UnknownFormat`], [`MapError::NoSteps`],
    /// [`MapError::Interrupted`].
    pub fn read<P: AsRef<Path>>(
        paths: &[P],
        format: Option<LogFormat>,
        observer: &dyn Observer,
    ) -> Result<Self, MapError> {
        let mut reading = Reading::new(OnBadLine::Stop, observer);
        reading.paths(paths, format)?;
        reading.finish().with_steps(|| {
            paths.iter().map(|path| path.as_ref().display().to_string()).collect::<Vec<_>>().join(", ")
        })
    }

    /// Reads a stream; `name` is what messages call it.
    ///
    /// # Errors
    ///
    /// [`MapError::BadLine`], [`MapError::Io`], [`MapError::UnknownFormat`], [`MapError::NoSteps`],
    /// [`MapError::Interrupted`].
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

    /// Makes a log of steps held in memory. IDs are taken as they are.
    pub fn from_steps<I>(steps: I) -> Self
    where
        I: IntoIterator,
        I::Item: IntoIterator<Item: AsRef<str>>,
    {
        let mut builder = LogBuilder::new();
        let mut tokens = Tokens::default();
        for step in steps {
            tokens.push_step(&builder.names, step);
        }
        builder.absorb(vec![tokens]);
        Self::from_builder(builder, 0)
    }

    fn from_builder(builder: LogBuilder, lines: u64) -> Self {
        let LogBuilder { names, mut seen, mut starts, duplicates } = builder;
        seen.shrink_to_fit();
        starts.shrink_to_fit();
        Self { names: names.into_names(), starts, seen, lines, duplicates }
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
