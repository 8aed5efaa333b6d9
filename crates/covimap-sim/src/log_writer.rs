//! Writes logs in the canonical JSONL form and truth as CSV.

use std::io::{self, Write};

use crate::simulation::Step;
use crate::world::World;

/// Writes one line `{"seen":["L3","L17"]}` a step.
pub struct LogWriter<W: Write> {
    out: W,
    line: Vec<u8>,
    prefix: String,
}

impl<W: Write> LogWriter<W> {
    /// A writer for logs from this world; give it a buffered output.
    pub fn new(out: W, world: &World) -> Self {
        Self { out, line: Vec::new(), prefix: world.id_prefix().to_owned() }
    }

    /// Appends one step.
    ///
    /// # Errors
    /// What the output says.
    pub fn write(&mut self, step: &Step<'_>) -> io::Result<()> {
        self.line.clear();
        self.line.extend_from_slice(b"{\"seen\":[");
        for (place, &number) in step.seen.iter().enumerate() {
            self.line.extend_from_slice(if place == 0 { b"\"" } else { b",\"" });
            self.line.extend_from_slice(self.prefix.as_bytes());
            write!(self.line, "{number}\"")?;
        }
        self.line.extend_from_slice(b"]}\n");
        self.out.write_all(&self.line)
    }

    /// Flushes and gives the output back.
    ///
    /// # Errors
    /// What the output says.
    pub fn finish(mut self) -> io::Result<W> {
        self.out.flush()?;
        Ok(self.out)
    }
}

/// Writes `id,x,y` and a line a landmark.
///
/// # Errors
/// What the output says.
pub fn write_truth(world: &World, mut out: impl Write) -> io::Result<()> {
    writeln!(out, "id,x,y")?;
    for (number, [x, y]) in world.landmarks().iter().enumerate() {
        writeln!(out, "{}{number},{x},{y}", world.id_prefix())?;
    }
    out.flush()
}
