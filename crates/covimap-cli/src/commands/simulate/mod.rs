//! `covimap simulate`: a log from a world whose truth is known.

mod robot;
mod world;

use std::path::PathBuf;

use clap::builder::PossibleValuesParser;
use covimap_sim::{Floor, OBSERVATIONS, SimSpec, Simulation, Summary, TRUTH, World, write_files};
use serde::Serialize;

use crate::console::{self, Console};
use crate::options::conflict;
use crate::progress::Progress;

/// The room of the paper, besides the worlds of [`Floor::ALL`].
const PAPER_ROOM: &str = "paper-room";

/// Simulate a robot in a world with known truth: DIR/observations.jsonl and DIR/truth.csv
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Shape of the free space
    #[arg(value_parser = PossibleValuesParser::new(worlds()))]
    world: String,
    /// Number of landmarks [default: 800; 15 in the paper's room]
    #[arg(long, value_name = "N")]
    landmarks: Option<usize>,
    /// Steps, as a multiple of the landmarks
    #[arg(long, value_name = "K", default_value_t = 40)]
    steps_per_landmark: u64,
    /// Steps in all
    #[arg(long, value_name = "T", conflicts_with = "steps_per_landmark")]
    steps: Option<u64>,
    /// Seed of the world, the walk and all chances
    #[arg(long, value_name = "S", default_value_t = 0)]
    seed: u64,
    /// Folder for the two files; made if it is not there
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    #[command(flatten, next_help_heading = "World")]
    floor: world::Options,
    #[command(flatten, next_help_heading = "Robot")]
    robot: robot::Options,
}

impl Args {
    pub fn run(self, console: Console) -> anyhow::Result<()> {
        let (name, seed, folder) = (self.world.clone(), self.seed, self.output.clone());
        let spec = self.spec()?;
        let world = World::new(&spec.world, seed)?;
        let simulation = Simulation::new(&world, &spec.run, seed)?;
        let progress = Progress::new(console);
        progress.begin("simulate", "steps", Some(spec.run.steps));
        let counts = write_files(&world, simulation, &folder, &progress)?;
        progress.end();
        console.say(format_args!("log and truth written to {}", folder.display()));
        let (observations, truth) = (folder.join(OBSERVATIONS), folder.join(TRUTH));
        let report = Report { world: name, seed, observations, truth, counts };
        Ok(console::print(serde_json::to_string(&report)?)?)
    }

    /// The world of this name, changed by what the options say.
    fn spec(self) -> anyhow::Result<SimSpec> {
        let mut spec = if self.world == PAPER_ROOM {
            SimSpec::paper_room(self.landmarks.unwrap_or(15), self.floor.side.unwrap_or(1.5), 0)
        } else {
            SimSpec::large(self.world.parse::<Floor>()?, self.landmarks.unwrap_or(800), 0)
        };
        let steps = self.steps_per_landmark.saturating_mul(spec.world.landmarks as u64);
        spec.run.steps = self.steps.unwrap_or(steps);
        self.floor.apply(&mut spec.world, self.world == PAPER_ROOM)?;
        self.robot.apply(&mut spec.run)?;
        Ok(spec)
    }
}

fn worlds() -> Vec<&'static str> {
    Floor::ALL.iter().map(Floor::name).chain([PAPER_ROOM]).collect()
}

/// What was made, and the counts of the run; printed as one line of JSON.
#[derive(Debug, Serialize)]
struct Report {
    world: String,
    seed: u64,
    observations: PathBuf,
    truth: PathBuf,
    #[serde(flatten)]
    counts: Summary,
}

/// Puts an option's value in its place, if it was given, and takes it out of the options.
fn set<T>(place: &mut T, option: &mut Option<T>) {
    if let Some(value) = option.take() {
        *place = value;
    }
}

/// Refuses the first option that is still there: nothing reads it.
///
/// # Errors
/// A conflict, exit code 2.
fn refuse_left<const N: usize>(left: [(&str, bool); N], with: &str) -> anyhow::Result<()> {
    match left.into_iter().find(|&(_, left)| left) {
        Some((option, _)) => Err(conflict(format_args!("{option} means nothing with {with}; leave it out"))),
        None => Ok(()),
    }
}

/// One number for both, or least and greatest: `5` or `4,8`.
fn range(text: &str) -> Result<[f64; 2], String> {
    let (low, high) = text.split_once(',').unwrap_or((text, text));
    match (low.parse(), high.parse()) {
        (Ok(low), Ok(high)) => Ok([low, high]),
        _ => Err("give one number, or the least and the greatest with a comma between them".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_range_is_one_number_or_two() {
        assert_eq!(range("5"), Ok([5.0, 5.0]));
        assert_eq!(range("4,8.5"), Ok([4.0, 8.5]));
        for wrong in ["", "4,", "4,5,6", "four"] {
            assert!(range(wrong).is_err(), "{wrong}");
        }
    }
}
