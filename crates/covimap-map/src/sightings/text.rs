//! Text: one step a line, IDs separated by white space. A blank line is a step in which nothing
//! was seen.

use std::borrow::Cow;

/// Reads one line; it always is a step.
pub(super) fn parse_line<'a>(line: &'a str, ids: &mut Vec<Cow<'a, str>>) -> Result<bool, String> {
    ids.extend(line.split_ascii_whitespace().map(Cow::Borrowed));
    Ok(true)
}
