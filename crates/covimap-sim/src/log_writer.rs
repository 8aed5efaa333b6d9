//! Writes logs in the canonical JSONL form and truth as CSV.

use std::fs;
use std::io::{self, Write};
use std::path::Path;

use crate::error::SimError;
use crate::geometry::Point;
use crate::simulation::Simulation;
use crate::tally::Summary;
use crate::whole_file::WholeFile;
use crate::world::World;

/// Steps between two reports of progress.
const REPORT_EVERY: u64 = 1 << 16;

/// Writes one line `{"seen":["L3","L17"]}` a step.
pub struct LogWriter<W: Write> {
    out: W,
    line: Vec<u8>,
    id_prefix: String,
}

impl<W: Write> LogWriter<W> {
    /// A writer that puts the prefix before each landmark's number. Letters, digits, `-`, `_` and the like: it
    /// is written as it is, without escapes. Give it a buffered output and flush that in the end.
    pub fn new(out: W, id_prefix: &str) -> Self {
        Self { out, line: Vec::new(), id_prefix: id_prefix.to_owned() }
    }

    /// Appends one step.
    ///
    /// # Errors
    /// What the output says.
    pub fn write(&mut self, seen: &[u32]) -> io::Result<()> {
        self.line.clear();
        self.line.extend_from_slice(b"{\"seen\":[");
        for (place, number) in seen.iter().enumerate() {
            let comma = if place == 0 { "" } else { "," };
            write!(self.line, "{comma}\"{}{number}\"", self.id_prefix)?;
        }
        self.line.extend_from_slice(b"]}\n");
        self.out.write_all(&self.line)
    }
}

/// Writes `id,x,y` and then a line a landmark, with as many digits as it takes to read the same numbers back.
///
/// # Errors
/// What the output says.
pub fn write_truth(landmarks: &[Point], id_prefix: &str, mut out: impl Write) -> io::Result<()> {
    writeln!(out, "id,x,y")?;
    for (number, [x, y]) in landmarks.iter().enumerate() {
        writeln!(out, "{id_prefix}{number},{x},{y}")?;
    }
    Ok(())
}

/// Runs the simulation to its end and writes `observations.jsonl` and `truth.csv` into the folder.
///
/// Both files appear whole or not at all: they are written under another name first and then renamed.
/// `progress` is told the number of steps done, every so often and at the end.
///
/// # Errors
/// [`SimError::Io`] with the file at fault; what was written of the two files so far is removed.
pub fn write_files(
    world: &World,
    mut simulation: Simulation<'_>,
    folder: &Path,
    mut progress: impl FnMut(u64),
) -> Result<Summary, SimError> {
    fs::create_dir_all(folder).map_err(|source| SimError::Io { path: folder.to_owned(), source })?;
    let truth =
        WholeFile::write(folder, "truth.csv", |out| write_truth(world.landmarks(), world.id_prefix(), out))?;
    let log = WholeFile::write(folder, "observations.jsonl", |out| {
        let mut writer = LogWriter::new(out, world.id_prefix());
        let mut steps = 0;
        while let Some(step) = simulation.next_step() {
            writer.write(step.seen)?;
            steps += 1;
            if steps % REPORT_EVERY == 0 {
                progress(steps);
            }
        }
        progress(steps);
        Ok(())
    })?;
    truth.keep()?;
    log.keep()?;
    Ok(simulation.summary())
}

#[cfg(test)]
mod tests;
