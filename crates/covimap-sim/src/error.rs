//! What can go wrong before a simulation starts or while its log is written.

use std::path::PathBuf;

/// Why a world could not be built, a simulation not be set up, or a log not be written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum SimError {
    /// A setting is outside its range.
    #[error("{name} is {value}; it must be {range}")]
    Setting {
        /// The setting, as in the specification.
        name: &'static str,
        /// What was given.
        value: f64,
        /// What is allowed.
        range: &'static str,
    },
    /// There is no world of this name.
    #[error("no world is called `{name}`; the worlds are {known}")]
    UnknownWorld {
        /// What was given.
        name: String,
        /// All names.
        known: String,
    },
    /// The landmarks do not fit on the floor at the wanted distance.
    #[error(
        "only {placed} of {wanted} landmarks fit {gap} m apart; lower the density, the diameter or the gap"
    )]
    Crowded {
        /// Landmarks that found a place.
        placed: usize,
        /// Landmarks asked for.
        wanted: usize,
        /// The gap asked for between surfaces, metres.
        gap: f64,
    },
    /// A file could not be written.
    #[error("{}: could not be written; is there space, and may you write there?", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// The system's own words.
        #[source]
        source: std::io::Error,
    },
}
