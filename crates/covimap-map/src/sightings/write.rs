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

    /// Writes a step: its time `t`, in any unit, and the landmarks seen. IDs that are empty or
    /// longer than [`crate::MAX_ID_BYTES`] are written too, but not read again.
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
        self.step_with_ranges(t, ids, [])
    }

    /// Writes a step with the distances in metres to some of the landmarks that it shows. Ranges that are not positive, or
    /// to others, are written too, but not read again.
    ///
    /// # Errors
    ///
    /// As [`JsonlWriter::step`], also for a range that is NaN or infinite.
    pub fn step_with_ranges<'r, S: AsRef<str>>(
        &mut self,
        t: Option<f64>,
        ids: impl IntoIterator<Item = S>,
        ranges: impl IntoIterator<Item = (&'r str, f64)>,
    ) -> io::Result<()> {
        if let Some(t) = t.filter(|t| !t.is_finite()) {
            let what = format!("time {t} of a step is not finite; leave it out");
            return Err(io::Error::new(io::ErrorKind::InvalidInput, what));
        }
        self.out.write_all(b"{")?;
        if let Some(t) = t {
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
        self.out.write_all(b"]")?;
        let mut before: &[u8] = b", \"ranges\": {";
        let mut any = false;
        for (id, metres) in ranges {
            if !metres.is_finite() {
                let what = format!("range {metres} of a step is not finite; leave it out");
                return Err(io::Error::new(io::ErrorKind::InvalidInput, what));
            }
            self.out.write_all(before)?;
            serde_json::to_writer(&mut self.out, id)?;
            self.out.write_all(b": ")?;
            serde_json::to_writer(&mut self.out, &metres)?;
            (before, any) = (b", ", true);
        }
        self.out.write_all(if any { b"}}\n" } else { b"}\n" })
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
        let mut ranges = self.ranges();
        let name = |number: u32| self.names().name(LandmarkId(number));
        for (number, step) in self.iter().enumerate() {
            let (own, later) = ranges.split_at(ranges.partition_point(|range| range.step <= number));
            let own = own.iter().map(|range| (name(range.landmark), range.metres));
            writer.step_with_ranges(None, step.iter().map(|&number| name(number)), own)?;
            ranges = later;
        }
        writer.finish()?.flush()
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::{LogFormat, Silent};

    #[test]
    fn a_time_that_json_cannot_say_is_refused_before_anything_is_written() {
        let mut writer = JsonlWriter::new(Vec::new());
        for t in [f64::NAN, f64::INFINITY] {
            let error = writer.step(Some(t), ["A"]).unwrap_err();
            assert_eq!(error.kind(), io::ErrorKind::InvalidInput);
        }
        writer.step(Some(-0.5), Vec::<&str>::new()).unwrap();
        assert_eq!(writer.finish().unwrap(), b"{\"t\": -0.5, \"seen\": []}\n");
    }

    #[test]
    fn what_the_output_says_comes_through() {
        let mut small = [0; 10];
        let mut writer = JsonlWriter::new(&mut small[..]);
        writer.step(None, ["A"]).unwrap();
        assert_eq!(writer.finish().unwrap_err().kind(), io::ErrorKind::WriteZero);
    }

    proptest! {
        #[test]
        fn what_is_written_is_read_again(
            steps in prop::collection::vec((prop::option::of(any::<f64>()), prop::collection::vec(".{1,6}", 0..5)), 1..20),
        ) {
            let mut writer = JsonlWriter::new(Vec::new());
            for (t, ids) in &steps {
                writer.step(t.filter(|t| t.is_finite()), ids).unwrap();
            }
            let text = writer.finish().unwrap();
            let read = |text: &[u8]| SightingLog::read_from(text, "log", Some(LogFormat::Jsonl), &Silent).unwrap();
            let log = read(&text);
            let held = SightingLog::from_steps(steps.iter().map(|(_, ids)| ids));
            prop_assert_eq!(log.names(), held.names());
            prop_assert!(log.iter().eq(held.iter()));

            let mut again = Vec::new();
            log.write_jsonl(&mut again).unwrap();
            let again = read(&again);
            prop_assert_eq!(log.names(), again.names());
            prop_assert!(log.iter().eq(again.iter()));
        }
    }
}
