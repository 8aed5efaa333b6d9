//! Text: one step a line, IDs separated by white space. A blank line is a step in which nothing
//! was seen.

use std::borrow::Cow;

use super::shown::Shown;

/// Reads one line; it always is a step.
pub(super) fn parse_line<'a>(line: &'a str, shown: &mut Shown<'a>) -> Result<bool, String> {
    shown.ids.extend(line.split_ascii_whitespace().map(Cow::Borrowed));
    Ok(true)
}
