//! What is said, and where: results on standard output, messages on standard error.

use std::fmt::Display;
use std::io::{self, Write};
use std::path::Path;

use covimap_map::{MapError, output};

/// Messages to the person at the terminal. A closed standard error is no reason to fail.
#[derive(Debug, Clone, Copy)]
pub struct Console {
    /// Whether messages are left out; errors never are.
    pub quiet: bool,
}

impl Console {
    /// Says a line, unless asked to be quiet.
    pub fn say(self, line: impl Display) {
        if !self.quiet {
            complain(line);
        }
    }
}

/// Says a line, always.
pub fn complain(line: impl Display) {
    let _ = writeln!(io::stderr(), "{line}");
}

/// Puts a result on standard output.
///
/// # Errors
/// [`MapError::Unwritable`].
pub fn print(result: impl Display) -> Result<(), MapError> {
    output::write_whole(Path::new("-"), |out| writeln!(out, "{result}"))
}
