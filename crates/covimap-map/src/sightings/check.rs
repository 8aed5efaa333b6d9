//! Looks through a whole log and says what is wrong with it, instead of stopping at the first line.

use std::path::Path;

use super::problem::OnBadLine;
use super::read::Reading;
use super::{LogFormat, LogProblem, LogSummary, SightingLog};
use crate::{MapError, Observer};

/// What a log holds and which of its lines are bad.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LogCheck {
    /// What the good lines hold.
    pub summary: LogSummary,
    /// The first bad lines, in order.
    pub problems: Vec<LogProblem>,
    /// How many lines are bad in all.
    pub bad_lines: u64,
}

impl SightingLog {
    /// Reads files as [`SightingLog::read`] does, but leaves bad lines out, counts them, and keeps
    /// the first `keep` of them.
    ///
    /// A file whose CSV header is bad or whose compressed data break off has one bad line, there.
    /// A log without a step is no error here: the summary says so.
    ///
    /// # Errors
    ///
    /// [`MapError::Io`], [`MapError::UnknownFormat`] and [`MapError::Interrupted`] as for
    /// [`SightingLog::read`].
    pub fn check<P: AsRef<Path>>(
        paths: &[P],
        format: Option<LogFormat>,
        keep: usize,
        observer: &dyn Observer,
    ) -> Result<LogCheck, MapError> {
        let mut reading = Reading::new(OnBadLine::Gather { keep }, observer);
        reading.paths(paths, format)?;
        let (problems, bad_lines) = (std::mem::take(&mut reading.problems), reading.bad_lines);
        Ok(LogCheck { summary: reading.finish().summary(), problems, bad_lines })
    }
}
