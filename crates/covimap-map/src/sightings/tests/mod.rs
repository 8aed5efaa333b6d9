//! Reading as a caller sees it.

mod bad_input;
mod formats;
mod sources;
mod threads;

use super::*;
use crate::{LandmarkId, Silent};

/// Reads a text of known format.
fn read(text: impl AsRef<[u8]>, format: LogFormat) -> Result<SightingLog, MapError> {
    SightingLog::read_from(text.as_ref(), "log", Some(format), &Silent)
}

/// The steps of a log, with names.
fn steps(log: &SightingLog) -> Vec<Vec<&str>> {
    let name = |&number: &u32| log.names().name(LandmarkId(number));
    log.iter().map(|step| step.iter().map(name).collect()).collect()
}

/// The message of a bad line `log:LINE: ...`.
fn message(result: Result<SightingLog, MapError>) -> String {
    let error = result.unwrap_err();
    assert!(matches!(error, MapError::BadLine { .. }), "{error:?}");
    error.to_string()
}
