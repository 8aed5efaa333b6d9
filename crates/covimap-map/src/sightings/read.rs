//! Streams in, a log out: while some blocks are tokenised, the next ones are read.

use std::io::Read;
use std::path::Path;

use rayon::prelude::*;

use super::blocks::{Block, Blocks, Limits};
use super::csv::Rows;
use super::format::LogFormat;
use super::lines::{LineParser, Rules, each_line, tokenise};
use super::problem::{LogProblem, OnBadLine, Problems};
use super::source::{self, Source};
use super::tokens::LogBuilder;
use super::{SightingLog, jsonl, text};
use crate::{MapError, Observer, Stage};

/// Longest line in bytes: 16 MiB, which is a step of a million sightings. A longer one is an error,
/// and never held in memory as a whole.
pub const MAX_LINE_BYTES: usize = 16 << 20;

const LIMITS: Limits = Limits { block_bytes: 2 << 20, line_bytes: MAX_LINE_BYTES };

/// Reads streams one after the other into one log.
pub(super) struct Reading<'a> {
    pub(super) rules: Rules,
    builder: LogBuilder,
    lines: u64,
    pub(super) problems: Vec<LogProblem>,
    pub(super) bad_lines: u64,
    observer: &'a dyn Observer,
}

impl<'a> Reading<'a> {
    pub(super) fn new(on_bad_line: OnBadLine, observer: &'a dyn Observer) -> Self {
        Self {
            rules: Rules { limits: LIMITS, on_bad_line },
            builder: LogBuilder::new(),
            lines: 0,
            problems: Vec::new(),
            bad_lines: 0,
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
        let goes_on = self.rules.on_bad_line != OnBadLine::Stop;
        let mut blocks = Blocks::new(text, self.rules.limits, goes_on);
        let first = blocks.next_block();
        let shown = || LogFormat::from_text(first.as_ref().map_or(&[], |block| &block.text));
        let format = format.or_else(shown).ok_or_else(|| MapError::UnknownFormat { file: name.clone() })?;
        match format {
            LogFormat::Jsonl => self.lines(&name, first, &mut blocks, jsonl::parse_line)?,
            LogFormat::Text => self.lines(&name, first, &mut blocks, text::parse_line)?,
            LogFormat::Csv => self.rows(&name, first, &mut blocks)?,
        }
        self.lines += blocks.lines();
        Ok(())
    }

    /// Formats in which a line stands for itself: blocks are tokenised in parallel.
    fn lines<R: Read + Send>(
        &mut self,
        name: &str,
        first: Option<Block>,
        blocks: &mut Blocks<R>,
        parse: LineParser,
    ) -> Result<(), MapError> {
        let rules = self.rules;
        let mut batch: Vec<Block> = first.into_iter().collect();
        while !batch.is_empty() {
            let known = &self.builder.names;
            let (tokens, next) = rayon::join(
                || batch.par_iter().map(|block| tokenise(block, known, parse, rules)).collect::<Vec<_>>(),
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

    /// Rows of a table, several of which make a step: blocks are taken apart one after the other.
    fn rows<R: Read + Send>(
        &mut self,
        name: &str,
        first: Option<Block>,
        blocks: &mut Blocks<R>,
    ) -> Result<(), MapError> {
        let mut rows = Rows::default();
        let mut present = first;
        while let Some(block) = present {
            let (rules, builder) = (self.rules, &mut self.builder);
            let (problems, next) = rayon::join(
                || each_line(&block, rules, |line| rows.line(line, builder)),
                || blocks.next_block(),
            );
            self.note(name, &problems)?;
            present = next;
        }
        rows.end(&mut self.builder);
        Ok(())
    }

    /// Takes over the problems of a block; the first one ends the reading if that is asked for.
    fn note(&mut self, file: &str, problems: &Problems) -> Result<(), MapError> {
        if self.observer.interrupted() {
            return Err(MapError::Interrupted);
        }
        let found = problems.first.iter().map(|(line, what)| LogProblem {
            file: file.into(),
            line: *line,
            what: what.clone(),
        });
        match self.rules.on_bad_line {
            OnBadLine::Stop => found.take(1).try_for_each(|problem| Err(problem.into())),
            OnBadLine::Gather { keep } => {
                self.bad_lines += problems.count;
                self.problems.extend(found.take(keep - self.problems.len()));
                Ok(())
            }
        }
    }

    /// The log read so far.
    pub(super) fn finish(self) -> SightingLog {
        SightingLog::from_builder(self.builder, self.lines)
    }
}
