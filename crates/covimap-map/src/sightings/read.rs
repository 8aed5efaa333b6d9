//! Streams in, a log out: blocks are read while the ones before them are tokenised.

use std::borrow::Cow;
use std::io::Read;
use std::path::Path;

use rayon::prelude::*;

use super::blocks::{Block, Blocks, Limits};
use super::csv::Rows;
use super::format::LogFormat;
use super::interner::Interner;
use super::problem::{LogProblem, OnBadLine, Problems};
use super::source::{self, Source};
use super::tokens::{LogBuilder, Tokens};
use super::{SightingLog, jsonl, text};
use crate::{MapError, Observer, Stage};

/// Longest ID in bytes.
pub const MAX_ID_BYTES: usize = 4096;

/// Longest line in bytes: 16 MiB, a step of a million sightings.
pub const MAX_LINE_BYTES: usize = 16 << 20;

const LIMITS: Limits = Limits { block_bytes: 2 << 20, line_bytes: MAX_LINE_BYTES };

/// Reads one line into `ids`; `false` if the line is no step, and says what is wrong with it.
type LineParser = for<'a> fn(&'a str, &mut Vec<Cow<'a, str>>) -> Result<bool, String>;

/// Reads streams one after the other into one log.
pub(super) struct Reading<'a> {
    builder: LogBuilder,
    lines: u64,
    pub(super) problems: Vec<LogProblem>,
    pub(super) bad_lines: u64,
    on_bad_line: OnBadLine,
    limits: Limits,
    observer: &'a dyn Observer,
}

impl<'a> Reading<'a> {
    pub(super) fn new(on_bad_line: OnBadLine, observer: &'a dyn Observer) -> Self {
        Self {
            builder: LogBuilder::new(),
            lines: 0,
            problems: Vec::new(),
            bad_lines: 0,
            on_bad_line,
            limits: LIMITS,
            observer,
        }
    }

    /// Reads files in the order given.
    pub(super) fn paths<P: AsRef<Path>>(
        &mut self,
        paths: &[P],
        format: Option<LogFormat>,
    ) -> Result<(), MapError> {
        self.observer.started(Stage::Read, source::total_bytes(paths));
        for path in paths.iter().map(AsRef::as_ref) {
            let source = Source::open(path, self.observer)?;
            self.source(source, format.or_else(|| LogFormat::from_path(path)))?;
        }
        self.observer.finished(Stage::Read);
        Ok(())
    }

    /// Reads one stream to its end.
    pub(super) fn source(&mut self, source: Source<'_>, format: Option<LogFormat>) -> Result<(), MapError> {
        let Source { name, text } = source;
        let mut blocks = Blocks::new(text, self.limits);
        let first = blocks.batch(1);
        let shown = || LogFormat::from_text(first.first().map_or(&[], |block| &block.text));
        let format = format.or_else(shown).ok_or_else(|| MapError::UnknownFormat { file: name.clone() })?;
        match format {
            LogFormat::Jsonl => self.lines(&name, first, &mut blocks, jsonl::parse_line)?,
            LogFormat::Text => self.lines(&name, first, &mut blocks, text::parse_line)?,
            LogFormat::Csv => self.rows(&name, first, &mut blocks)?,
        }
        self.lines += blocks.lines();
        Ok(())
    }

    /// Formats in which a line stands for itself.
    fn lines<R: Read + Send>(
        &mut self,
        name: &str,
        first: Vec<Block>,
        blocks: &mut Blocks<R>,
        parse: LineParser,
    ) -> Result<(), MapError> {
        let (on_bad_line, limits) = (self.on_bad_line, self.limits);
        let mut batch = first;
        while !batch.is_empty() {
            self.check_interrupt()?;
            let known = &self.builder.names;
            let tokenise = |block: &Block| tokenise(block, known, parse, limits, on_bad_line);
            let (tokens, next) = rayon::join(
                || batch.par_iter().map(tokenise).collect::<Vec<_>>(),
                || blocks.batch(2 * rayon::current_num_threads()),
            );
            for block in &tokens {
                self.note(name, &block.problems)?;
            }
            self.builder.absorb(tokens);
            batch = next;
        }
        Ok(())
    }

    /// Rows of a table, of which several make a step.
    fn rows<R: Read + Send>(
        &mut self,
        name: &str,
        first: Vec<Block>,
        blocks: &mut Blocks<R>,
    ) -> Result<(), MapError> {
        let mut rows = Rows::default();
        let mut batch = first;
        while !batch.is_empty() {
            self.check_interrupt()?;
            let (builder, limits, on_bad_line) = (&mut self.builder, self.limits, self.on_bad_line);
            let (problems, next) = rayon::join(
                || {
                    let read = |line: &str| rows.line(line, builder);
                    each_line(&batch[0], limits, on_bad_line, read)
                },
                || blocks.batch(1),
            );
            self.note(name, &problems)?;
            batch = next;
        }
        rows.end(&mut self.builder);
        Ok(())
    }

    pub(super) fn check_interrupt(&self) -> Result<(), MapError> {
        if self.observer.interrupted() { Err(MapError::Interrupted) } else { Ok(()) }
    }

    /// Takes over the problems of a block; the first one ends the reading if that is asked for.
    fn note(&mut self, file: &str, problems: &Problems) -> Result<(), MapError> {
        let problem =
            |(line, what): &(u64, String)| LogProblem { file: file.into(), line: *line, what: what.clone() };
        let found = problems.first.iter().map(problem);
        match self.on_bad_line {
            OnBadLine::Stop => found.take(1).try_for_each(|problem| Err(problem.into())),
            OnBadLine::Gather { keep } => {
                self.bad_lines += problems.count;
                let room = keep - self.problems.len();
                self.problems.extend(found.take(room));
                Ok(())
            }
        }
    }

    /// The log read so far.
    pub(super) fn finish(self) -> SightingLog {
        SightingLog::from_builder(self.builder, self.lines)
    }
}

/// Makes steps of the lines of a block.
fn tokenise(
    block: &Block,
    known: &Interner,
    parse: LineParser,
    limits: Limits,
    on_bad_line: OnBadLine,
) -> Tokens {
    let mut tokens = Tokens::default();
    let mut ids = Vec::new();
    tokens.problems = each_line(block, limits, on_bad_line, |line| {
        ids.clear();
        if parse(line, &mut ids)? {
            ids.iter().try_for_each(|id| check_id(id))?;
            tokens.push_step(known, &ids);
        }
        Ok(())
    });
    tokens
}

/// Hands the lines of a block on one by one, and returns those that were refused.
fn each_line<'b>(
    block: &'b Block,
    limits: Limits,
    on_bad_line: OnBadLine,
    mut read: impl FnMut(&'b str) -> Result<(), String>,
) -> Problems {
    let mut problems = Problems::default();
    for (number, line) in (block.first_line..).zip(lines(&block.text)) {
        if let Err(what) = as_text(line, limits).and_then(&mut read) {
            problems.push(on_bad_line, number, what);
            if on_bad_line == OnBadLine::Stop {
                return problems;
            }
        }
    }
    if let Some(fault) = &block.fault {
        problems.push(on_bad_line, fault.line, fault.what.clone());
    }
    problems
}

/// The lines of a block without their line ends; the last one may have none.
fn lines(text: &[u8]) -> impl Iterator<Item = &[u8]> {
    let mut rest = text;
    std::iter::from_fn(move || {
        if rest.is_empty() {
            return None;
        }
        let end = memchr::memchr(b'\n', rest).unwrap_or(rest.len());
        let line = &rest[..end];
        rest = rest.get(end + 1..).unwrap_or_default();
        Some(line)
    })
}

/// A line as text.
fn as_text(line: &[u8], limits: Limits) -> Result<&str, String> {
    if line.len() > limits.line_bytes {
        return Err(limits.too_long());
    }
    std::str::from_utf8(line).map_err(|error| {
        let at = error.valid_up_to();
        format!(
            "byte {} of the line (0x{:02X}) is not valid UTF-8; save the log as UTF-8 text",
            at + 1,
            line[at]
        )
    })
}

/// Refuses IDs that can only be a mistake.
pub(super) fn check_id(id: &str) -> Result<(), String> {
    if id.is_empty() {
        return Err("an ID is empty; give every landmark a name or leave it out".into());
    }
    if id.len() > MAX_ID_BYTES {
        let (start, length) = (id.chars().take(20).collect::<String>(), id.len());
        return Err(format!(
            "the ID `{start}...` has {length} bytes, at most {MAX_ID_BYTES} are allowed; use shorter IDs"
        ));
    }
    Ok(())
}
