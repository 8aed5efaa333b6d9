//! Cuts a stream into blocks that end where a line ends.

use std::io::{self, Read};

/// Sizes that bound the memory of reading.
#[derive(Debug, Clone, Copy)]
pub(super) struct Limits {
    /// Text read at once.
    pub(super) block_bytes: usize,
    /// Longest line, without its line end.
    pub(super) line_bytes: usize,
}

impl Limits {
    pub(super) fn too_long(self) -> String {
        let limit = self.line_bytes;
        format!("the line is longer than {limit} bytes; write one step a line, or split this step")
    }
}

/// Whole lines, and what stopped the reading behind them, if anything did.
#[derive(Debug)]
pub(super) struct Block {
    pub(super) text: Vec<u8>,
    /// Number of the first line.
    pub(super) first_line: u64,
    /// Why the line after the text is no use.
    pub(super) fault: Option<Fault>,
}

/// A line that could not be taken whole.
#[derive(Debug)]
pub(super) struct Fault {
    pub(super) line: u64,
    pub(super) what: String,
}

/// The blocks of one stream.
pub(super) struct Blocks<R> {
    input: R,
    limits: Limits,
    /// Begin of a line whose end has not been read yet.
    rest: Vec<u8>,
    /// Number of the line that `rest` begins.
    line: u64,
    /// Whether to go on after a line over the limit.
    goes_on: bool,
    /// How the stream failed while a line was skipped.
    failed: Option<io::Error>,
    ended: bool,
}

const BYTE_ORDER_MARK: &[u8] = &[0xEF, 0xBB, 0xBF];

impl<R: Read> Blocks<R> {
    pub(super) fn new(input: R, limits: Limits, goes_on: bool) -> Self {
        Self { input, limits, rest: Vec::new(), line: 1, goes_on, failed: None, ended: false }
    }

    /// Lines begun so far.
    pub(super) fn lines(&self) -> u64 {
        self.line - 1
    }

    /// Up to `count` blocks; none at the end of the stream.
    pub(super) fn batch(&mut self, count: usize) -> Vec<Block> {
        (0..count).map_while(|_| self.next_block()).collect()
    }

    /// The next block; `None` at the end of the stream.
    pub(super) fn next_block(&mut self) -> Option<Block> {
        if self.ended {
            return None;
        }
        let mut text = std::mem::take(&mut self.rest);
        let mut searched = 0;
        loop {
            let read = self.fill(&mut text);
            if self.line == 1 && text.starts_with(BYTE_ORDER_MARK) {
                text.drain(..BYTE_ORDER_MARK.len());
            }
            let end = memchr::memrchr(b'\n', &text[searched..]).map(|at| searched + at + 1);
            match (read, end) {
                (Err(error), end) => return Some(self.broken(text, end.unwrap_or(0), &error)),
                (Ok(true), _) => return self.last(text),
                (Ok(false), Some(end)) => {
                    self.rest = text.split_off(end);
                    return Some(self.block(text));
                }
                (Ok(false), None) if text.len() > self.limits.line_bytes => return Some(self.too_long()),
                (Ok(false), None) => searched = text.len(),
            }
        }
    }

    /// Appends up to a block of text; true at the end of the stream.
    fn fill(&mut self, text: &mut Vec<u8>) -> io::Result<bool> {
        if let Some(error) = self.failed.take() {
            return Err(error);
        }
        let wanted = self.limits.block_bytes;
        text.reserve(wanted);
        let read = self.input.by_ref().take(wanted as u64).read_to_end(text)?;
        Ok(read < wanted)
    }

    fn block(&mut self, text: Vec<u8>) -> Block {
        let first_line = self.line;
        let open_end = text.last().is_some_and(|&byte| byte != b'\n');
        self.line += memchr::memchr_iter(b'\n', &text).count() as u64 + u64::from(open_end);
        Block { text, first_line, fault: None }
    }

    fn last(&mut self, text: Vec<u8>) -> Option<Block> {
        self.ended = true;
        if text.is_empty() { None } else { Some(self.block(text)) }
    }

    /// The stream failed: what is left are the lines before that.
    fn broken(&mut self, mut text: Vec<u8>, end: usize, error: &io::Error) -> Block {
        self.ended = true;
        text.truncate(end);
        let mut block = self.block(text);
        block.fault = Some(self.fault(super::source::what_broke(error)));
        block
    }

    /// Refuses a line over the limit.
    fn too_long(&mut self) -> Block {
        let first_line = self.line;
        let fault = self.fault(self.limits.too_long());
        if self.goes_on {
            self.skip_line();
        } else {
            self.ended = true;
        }
        Block { text: Vec::new(), first_line, fault: Some(fault) }
    }

    /// Reads on to the end of a line without keeping it. Should the stream fail, that is for the
    /// next block to say.
    fn skip_line(&mut self) {
        let mut scratch = Vec::new();
        loop {
            scratch.clear();
            let read = self.fill(&mut scratch);
            let line_end = memchr::memchr(b'\n', &scratch);
            if let Some(at) = line_end {
                self.rest = scratch.split_off(at + 1);
            }
            match read {
                Ok(at_end) if at_end || line_end.is_some() => return,
                Ok(_) => {}
                Err(error) => {
                    self.failed = Some(error);
                    return;
                }
            }
        }
    }

    /// A fault at the line that would come next.
    fn fault(&mut self, what: String) -> Fault {
        let fault = Fault { line: self.line, what };
        self.line += 1;
        fault
    }
}
