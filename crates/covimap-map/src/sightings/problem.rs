//! Lines that do not say what their format asks.

use crate::MapError;

/// A refused line of a log.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LogProblem {
    /// File as the user named it, `<stdin>` for standard input.
    pub file: String,
    /// Line, counted from 1.
    pub line: u64,
    /// What is wrong; what to do.
    pub what: String,
}

impl std::fmt::Display for LogProblem {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}:{}: {}", self.file, self.line, self.what)
    }
}

impl From<LogProblem> for MapError {
    fn from(problem: LogProblem) -> Self {
        Self::BadLine { file: problem.file, line: problem.line, what: problem.what }
    }
}

/// What to do about a bad line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum OnBadLine {
    /// Read no further.
    Stop,
    /// Leave the line out, keep what was wrong with the first few, and go on.
    Gather {
        /// How many to keep.
        keep: usize,
    },
}

/// The bad lines of one block of text, in order.
#[derive(Debug, Default)]
pub(super) struct Problems {
    /// Line and what is wrong with it, of the first few.
    pub(super) first: Vec<(u64, String)>,
    /// How many there are in all.
    pub(super) count: u64,
}

impl Problems {
    pub(super) fn push(&mut self, on_bad_line: OnBadLine, line: u64, what: String) {
        let keep = match on_bad_line {
            OnBadLine::Stop => 1,
            OnBadLine::Gather { keep } => keep,
        };
        if self.first.len() < keep {
            self.first.push((line, what));
        }
        self.count += 1;
    }
}
