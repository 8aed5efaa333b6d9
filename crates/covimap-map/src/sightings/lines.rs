//! Takes blocks of text apart, line by line.

use super::blocks::{Block, Limits};
use super::interner::Interner;
use super::problem::{OnBadLine, Problems};
use super::shown::Shown;
use super::tokens::Tokens;

/// Longest ID in bytes: 4 KiB. A longer one is an error.
pub const MAX_ID_BYTES: usize = 4096;

/// Reads one line and appends what it shows; `false` if the line is no step, and says what is wrong.
pub(super) type LineParser = for<'a> fn(&'a str, &mut Shown<'a>) -> Result<bool, String>;

/// What holds for all lines of a log.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rules {
    pub(super) limits: Limits,
    pub(super) on_bad_line: OnBadLine,
}

/// Makes steps of a block in which every line stands for itself.
pub(super) fn tokenise(block: &Block, known: &Interner, parse: LineParser, rules: Rules) -> Tokens {
    let mut tokens = Tokens::default();
    let (mut shown, mut ends) = (Shown::default(), Vec::new());
    let problems = each_line(block, rules, |line| {
        let start = shown.ids.len();
        let step = parse(line, &mut shown).and_then(|is_step| {
            shown.ids[start..].iter().try_for_each(|id| check_id(id))?;
            Ok(is_step)
        });
        match step {
            Ok(true) => ends.push(shown.ids.len()),
            _ => shown.truncate(start),
        }
        if shown.ids.len() >= IDS_AT_ONCE {
            tokens.push_steps(known, &shown, &ends);
            shown.truncate(0);
            ends.clear();
        }
        step.map(drop)
    });
    tokens.push_steps(known, &shown, &ends);
    tokens.problems = problems;
    tokens
}

/// IDs are looked up in groups of at least so many.
const IDS_AT_ONCE: usize = 256;

/// Hands the lines of a block on one by one, and returns those that were refused.
pub(super) fn each_line<'b>(
    block: &'b Block,
    rules: Rules,
    mut read: impl FnMut(&'b str) -> Result<(), String>,
) -> Problems {
    let mut problems = Problems::default();
    for (number, line) in (block.first_line..).zip(lines(&block.text)) {
        if let Err(what) = as_text(line, rules.limits).and_then(&mut read) {
            problems.push(rules.on_bad_line, number, what);
            if rules.on_bad_line == OnBadLine::Stop {
                return problems;
            }
        }
    }
    if let Some(fault) = &block.fault {
        problems.push(rules.on_bad_line, fault.line, fault.what.clone());
    }
    problems
}

/// The lines of a text without their line feeds; the last one may have none.
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
        let (place, byte) = (at + 1, line[at]);
        format!("byte {place} of the line, 0x{byte:02X}, is not valid UTF-8; save the log as UTF-8 text")
    })
}

/// Refuses IDs that can only be a mistake.
pub(super) fn check_id(id: &str) -> Result<(), String> {
    if id.is_empty() {
        return Err("an ID is empty; give every landmark a name or leave it out".into());
    }
    if id.len() > MAX_ID_BYTES {
        let (start, length) = (excerpt(id), id.len());
        return Err(format!(
            "the ID {start} has {length} bytes, at most {MAX_ID_BYTES} are allowed; use shorter IDs"
        ));
    }
    Ok(())
}

/// The begin of a piece of input, quoted for a message.
pub(super) fn excerpt(text: &str) -> String {
    let start: String = text.chars().take(EXCERPT).collect();
    let dots = if start.len() < text.len() { "..." } else { "" };
    format!("`{}{dots}`", start.escape_debug())
}

/// Characters that a message repeats.
const EXCERPT: usize = 40;
