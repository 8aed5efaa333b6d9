//! Writes canonical JSONL: `{"t": 12.5, "seen": ["A", "B"]}` a line.

use std::io::{self, BufWriter, Write};

use super::SightingLog;
use crate::LandmarkId;

/// Writes a log step by step; it holds no more than the line being made.
///
/// Output is buffered: call [`JsonlWriter::finish`], or errors of the last writes get lost.
///
/// ```
/// # use covimap_map::JsonlWriter;
/// let mut log = JsonlWriter::new(Vec::new());
/// log.step(Some(12.5), ["A", "B"])?;
/// log.step(None, ["C"])?;
/// assert_eq!(log.finish()?, b"{\"t\": 12.5, \"seen\": [\"A\", \"B\"]}\n{\"seen\": [\"C\"]}\n");
/// # Ok::<(), std::io::Error>(())
/// ```
#[derive(Debug)]
pub struct JsonlWriter<W: Write> {
    out: BufWriter<W>,
}

impl<W: Write> JsonlWriter<W> {
    /// Writes to `out`, which needs no buffer of its own.
    pub fn new(out: W) -> Self {
        Self { out: BufWriter::with_capacity(BUFFER, out) }
    }

    /// Writes a step: time `t` in seconds or whatever unit the log has, and the landmarks seen.
    ///
    /// # Errors
    ///
    /// What the output says; [`io::ErrorKind::InvalidInput`] if `t` is NaN or infinite, which JSON
    /// cannot say.
    pub fn step<S: AsRef<str>>(
        &mut self,
        t: Option<f64>,
        ids: impl IntoIterator<Item = S>,
    ) -> io::Result<()> {
        self.out.write_all(b"{")?;
        if let Some(t) = t {
            if !t.is_finite() {
                let what = format!("time {t} of a step is not finite");
                return Err(io::Error::new(io::ErrorKind::InvalidInput, what));
            }
            self.out.write_all(b"\"t\": ")?;
            serde_json::to_writer(&mut self.out, &t)?;
            self.out.write_all(b", ")?;
        }
        self.out.write_all(b"\"seen\": [")?;
        for (index, id) in ids.into_iter().enumerate() {
            if index > 0 {
                self.out.write_all(b", ")?;
            }
            serde_json::to_writer(&mut self.out, id.as_ref())?;
        }
        self.out.write_all(b"]}\n")
    }

    /// Writes what is still in the buffer and hands the output back.
    ///
    /// # Errors
    ///
    /// What the output says.
    pub fn finish(self) -> io::Result<W> {
        self.out.into_inner().map_err(io::IntoInnerError::into_error)
    }
}

/// Bytes handed to the system at once.
const BUFFER: usize = 1 << 16;

impl SightingLog {
    /// Writes the log as canonical JSONL, without times (a log has none). Read again, it gives the
    /// same names, steps and sightings.
    ///
    /// # Errors
    ///
    /// What the output says.
    pub fn write_jsonl(&self, out: impl Write) -> io::Result<()> {
        let mut writer = JsonlWriter::new(out);
        for step in self.iter() {
            writer.step(None, step.iter().map(|&number| self.names().name(LandmarkId(number))))?;
        }
        writer.finish()?.flush()
    }
}
