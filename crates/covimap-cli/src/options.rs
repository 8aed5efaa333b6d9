//! Options that several commands share.

use std::path::PathBuf;
use std::sync::Arc;

use anyhow::Context;
use clap::{ValueEnum, error::ErrorKind};
use covimap_map::{GlobalMap, LogFormat};
use covimap_plan::MapIndex;

/// More threads than any machine that this runs on has cores.
const MOST_THREADS: usize = 1024;

/// Where sightings come from.
#[derive(Debug, clap::Args)]
pub struct LogArgs {
    /// Logs of sightings, read as one log in this order; `-` is stdin, .gz and .zst are unpacked
    #[arg(required = true, value_name = "LOG")]
    pub logs: Vec<PathBuf>,
    #[command(flatten)]
    format: FormatArg,
}

impl LogArgs {
    pub fn format(&self) -> Option<LogFormat> {
        self.format.get()
    }
}

/// What logs are written in.
#[derive(Debug, clap::Args)]
pub struct FormatArg {
    /// Format of the logs, when their names do not tell
    #[arg(long, value_enum, value_name = "FORMAT")]
    format: Option<FormatName>,
}

impl FormatArg {
    pub fn get(&self) -> Option<LogFormat> {
        self.format.map(LogFormat::from)
    }
}

/// How many threads work.
#[derive(Debug, clap::Args)]
pub struct ThreadArgs {
    /// Threads that work at once; the result is the same for any number [default: all cores]
    #[arg(long, value_name = "N", value_parser = threads)]
    threads: Option<usize>,
}

impl ThreadArgs {
    /// Sets up the pool that all parallel work uses.
    ///
    /// # Errors
    /// When the system does not give that many threads.
    pub fn start(&self) -> anyhow::Result<()> {
        let Some(count) = self.threads else { return Ok(()) };
        rayon::ThreadPoolBuilder::new()
            .num_threads(count)
            .build_global()
            .with_context(|| format!("cannot start {count} threads; ask for fewer with --threads"))
    }
}

/// A map to ask, and how the answer is printed.
#[derive(Debug, clap::Args)]
pub struct QuestionArgs {
    /// Map file; `-` is stdin
    #[arg(value_name = "MAP.json")]
    map: PathBuf,
    /// Print one JSON object
    #[arg(long)]
    pub json: bool,
}

impl QuestionArgs {
    /// The map, ready for questions.
    ///
    /// # Errors
    /// Those of [`GlobalMap::load`].
    pub fn index(&self) -> anyhow::Result<MapIndex> {
        Ok(MapIndex::new(Arc::new(GlobalMap::load(&self.map)?)))
    }
}

fn threads(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(count @ 1..=MOST_THREADS) => Ok(count),
        _ => Err(format!("give a number from 1 to {MOST_THREADS}, or leave --threads out to use all cores")),
    }
}

/// A number of bytes, with k, M or G for the powers of 1000: `800M`, `1.5G`.
///
/// # Errors
/// What is not such a number.
pub fn size(text: &str) -> Result<u64, String> {
    let unit = |letter: char| match letter {
        'k' | 'K' => Some(1e3),
        'M' => Some(1e6),
        'G' => Some(1e9),
        _ => None,
    };
    let factor = text.chars().last().and_then(unit);
    let digits = if factor.is_some() { &text[..text.len() - 1] } else { text };
    match digits.parse::<f64>() {
        Ok(number) if number > 0.0 && number.is_finite() => Ok((number * factor.unwrap_or(1.0)) as u64),
        _ => Err("give bytes, or a number with k, M or G such as 800M or 1.5G".to_owned()),
    }
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum FormatName {
    /// A JSON object a step: {"t": 12.5, "seen": ["A", "B"]}
    Jsonl,
    /// Header step,landmark and a sighting a row
    Csv,
    /// A step a line, IDs separated by white space
    Text,
}

impl From<FormatName> for LogFormat {
    fn from(name: FormatName) -> Self {
        match name {
            FormatName::Jsonl => Self::Jsonl,
            FormatName::Csv => Self::Csv,
            FormatName::Text => Self::Text,
        }
    }
}

/// Options that make no sense together; exit code 2. The command line that is run adds how it is used.
pub fn conflict(what: impl std::fmt::Display) -> anyhow::Error {
    clap::Error::raw(ErrorKind::ArgumentConflict, what).into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_have_a_unit_or_are_bytes() {
        let sizes = ["1", "1500", "64k", "64K", "800M", "1.5G"];
        let wanted = [1, 1500, 64_000, 64_000, 800_000_000, 1_500_000_000];
        assert_eq!(sizes.map(|text| size(text).unwrap()), wanted);
        for wrong in ["", "M", "0", "-1G", "4 G", "4T", "4Ä", "inf", "NaNG"] {
            assert!(size(wrong).unwrap_err().starts_with("give bytes"), "{wrong}");
        }
    }
}
