//! Writes a run into a folder: what was seen as canonical JSONL, and the truth as CSV.

use std::io::{self, Write};
use std::path::Path;

use covimap_map::output::{self, Output};
use covimap_map::{JsonlWriter, LandmarkId, MapError, Observer};

use crate::simulation::Simulation;
use crate::tally::Summary;
use crate::world::World;

/// What was seen, a step a line.
pub const OBSERVATIONS: &str = "observations.jsonl";
/// Where every landmark stands.
pub const TRUTH: &str = "truth.csv";

/// Steps between two reports of progress.
const REPORT_EVERY: u64 = 1 << 12;

/// Writes `id,x,y` and then a line a landmark, with as many digits as it takes to read the same numbers back.
///
/// # Errors
/// What the output says.
pub fn write_truth(world: &World, mut out: impl Write) -> io::Result<()> {
    writeln!(out, "id,x,y")?;
    for (id, [x, y]) in world.names().iter().zip(world.landmarks()) {
        writeln!(out, "{id},{x},{y}")?;
    }
    Ok(())
}

/// Runs the simulation to its end and writes [`OBSERVATIONS`] and [`TRUTH`] into the folder, which is made if
/// it is not there.
///
/// Both files appear whole, or neither does: they are put in place when both are complete. The log is never
/// held; memory does not grow with the steps. The observer is told of the steps done.
///
/// # Errors
/// [`MapError::Unwritable`] with the file at fault, [`MapError::Interrupted`] if the observer asks for it.
pub fn write_files(
    world: &World,
    mut simulation: Simulation<'_>,
    folder: &Path,
    observer: &dyn Observer,
) -> Result<Summary, MapError> {
    output::make_folder(folder)?;
    let truth = Output::open(&folder.join(TRUTH))?;
    let log = Output::open(&folder.join(OBSERVATIONS))?;
    let truth = truth.fill(|out| write_truth(world, out))?;
    let mut interrupted = false;
    let log = log.fill(|out| {
        write_log(world, &mut simulation, out, || {
            observer.advanced(REPORT_EVERY);
            interrupted = observer.interrupted();
            !interrupted
        })
    });
    if interrupted {
        return Err(MapError::Interrupted);
    }
    let log = log?;
    truth.keep()?;
    log.keep()?;
    Ok(simulation.summary())
}

/// Writes every step; `go_on` is asked every so often.
fn write_log(
    world: &World,
    simulation: &mut Simulation<'_>,
    out: &mut dyn Write,
    mut go_on: impl FnMut() -> bool,
) -> io::Result<()> {
    let names = world.names();
    let mut writer = JsonlWriter::new(out);
    let mut steps = 0;
    while let Some(step) = simulation.next_step() {
        let seen = || step.seen.iter().map(|&number| names.name(LandmarkId(number)));
        writer.step_with_ranges(None, seen(), seen().zip(step.ranges.iter().copied()))?;
        steps += 1;
        if steps % REPORT_EVERY == 0 && !go_on() {
            break;
        }
    }
    writer.finish().map(drop)
}

#[cfg(test)]
mod tests;
