//! Exit codes, and what is said about a failure. This is the only place that knows them.
//!
//! | code | meaning |
//! |---|---|
//! | 0 | done |
//! | 1 | failure: an output cannot be written, the system refused something, a build would exceed `--max-memory` |
//! | 2 | usage: unknown or contradicting options |
//! | 3 | bad input: a file is missing, unreadable or does not say what its format asks |
//! | 130 | interrupted |

use std::io::ErrorKind;
use std::path::Path;
use std::process::ExitCode;

use covimap_map::MapError;
use covimap_plan::PlanError;
use covimap_sim::SimError;

use crate::console::complain;

const FAILURE: u8 = 1;
const USAGE: u8 = 2;
const BAD_INPUT: u8 = 3;
/// 128 and the number of SIGINT, as shells count.
pub const INTERRUPTED: u8 = 130;

/// Lines of a log that `covimap check` has listed already.
#[derive(Debug)]
pub struct BadLines;

impl std::fmt::Display for BadLines {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("the log has bad lines")
    }
}

impl std::error::Error for BadLines {}

/// Says what went wrong and gives the exit code.
pub fn with(result: anyhow::Result<()>) -> ExitCode {
    let Err(error) = result else { return ExitCode::SUCCESS };
    if reader_has_gone(&error) {
        return ExitCode::SUCCESS;
    }
    if let Some(usage) = error.downcast_ref::<clap::Error>() {
        let _ = usage.print();
    } else if !error.is::<BadLines>() {
        complain(message(&error));
    }
    code(&error).into()
}

/// Whether whoever read standard output, such as `head`, has seen enough.
fn reader_has_gone(error: &anyhow::Error) -> bool {
    matches!(
        error.downcast_ref(),
        Some(MapError::Unwritable { path, source, .. })
            if path == Path::new("-") && source.kind() == ErrorKind::BrokenPipe
    )
}

/// `file:line: what is wrong; what to do`, or the same behind `covimap:` where there is no line.
fn message(error: &anyhow::Error) -> String {
    let text = match error.downcast_ref() {
        Some(MapError::BadLine { .. }) => error.to_string(),
        _ => format!("covimap: {error}"),
    };
    let causes = error.chain().skip(1).map(ToString::to_string);
    causes.fold(
        text,
        |text, cause| if text.contains(&cause) { text } else { format!("{text}\n  cause: {cause}") },
    )
}

fn code(error: &anyhow::Error) -> u8 {
    // A simulation goes wrong over its settings alone.
    if error.is::<clap::Error>() || error.is::<SimError>() {
        return USAGE;
    }
    if error.is::<BadLines>() {
        return BAD_INPUT;
    }
    // A question that a map cannot answer is a wrong question or a wrong map.
    if error.is::<PlanError>() {
        return BAD_INPUT;
    }
    match error.downcast_ref() {
        Some(MapError::Interrupted) => INTERRUPTED,
        Some(
            MapError::BadLine { .. }
            | MapError::Io { .. }
            | MapError::UnknownFormat { .. }
            | MapError::NoSteps { .. }
            | MapError::TooManySteps { .. }
            | MapError::MapFormat { .. }
            | MapError::InvalidMap { .. }
            | MapError::DamagedMap { .. }
            | MapError::StateFormat { .. }
            | MapError::DamagedState { .. }
            | MapError::NoRouteGraph { .. }
            | MapError::NothingTogether { .. }
            | MapError::NoInformation { .. }
            | MapError::TooLargeForClassical { .. }
            | MapError::NoCommonLandmarks { .. }
            | MapError::TooFewCommon { .. }
            | MapError::OtherLog { .. },
        ) => BAD_INPUT,
        Some(MapError::BadParameter { .. }) => USAGE,
        _ => FAILURE,
    }
}
