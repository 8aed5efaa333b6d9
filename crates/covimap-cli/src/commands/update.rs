//! `covimap update`: more steps for a map that was built with `--state`.

use std::path::{Path, PathBuf};

use covimap_map::{MapState, SightingLog, UpdateReport, output::Output};

use super::build::{same_file, save_both, seconds, times_line};
use crate::console::{self, Console};
use crate::interrupt::Deferral;
use crate::options::{LogArgs, ThreadArgs, conflict};
use crate::progress::Progress;
use crate::summary;

/// Add new steps to a map: only what they change is solved again, the rest does not move
#[derive(Debug, clap::Args)]
pub struct Args {
    /// State, as `build --state` wrote it; the new steps are added to it
    #[arg(value_name = "STATE")]
    state: PathBuf,
    #[command(flatten)]
    input: LogArgs,
    /// Where the map goes; `-` is stdout
    #[arg(short, long, value_name = "MAP.json")]
    output: PathBuf,
    #[command(flatten)]
    threads: ThreadArgs,
    /// Print the report as one JSON object on stdout
    #[arg(long)]
    json: bool,
}

impl Args {
    pub fn run(self, console: Console) -> anyhow::Result<()> {
        self.check_files()?;
        self.threads.start()?;

        let progress = Progress::new(console);
        let mut state = MapState::load(&self.state)?;
        let log = SightingLog::read(&self.input.logs, self.input.format(), &progress)?;
        let report = state.update(&log, &progress)?;
        let times = progress.end();

        let deferral = Deferral::of_writing();
        save_both(&state, &self.state, &self.output)?;
        drop(deferral);
        console.say(summary::of(state.map().report()));
        console.say(times_line(&times));
        if self.output != Path::new("-") {
            console.say(format_args!("map written to {}", self.output.display()));
        }
        if self.json { Ok(console::print(self.report(&state, &report, seconds(&times)))?) } else { Ok(()) }
    }

    /// Finds out before the work whether its results can be put in place.
    fn check_files(&self) -> anyhow::Result<()> {
        if self.json && self.output == Path::new("-") {
            return Err(conflict("--json and --output - both want stdout; give the map a file"));
        }
        if self.state == Path::new("-") {
            return Err(conflict("the state is read and written, so it must be a file; give its name"));
        }
        if same_file(&self.state, &self.output) {
            return Err(conflict("the map would replace the state; give another --output"));
        }
        let logs = &self.input.logs;
        if let Some(log) = logs.iter().find(|log| same_file(log, &self.output) || same_file(log, &self.state))
        {
            let log = log.display();
            return Err(conflict(format_args!("the result would replace the log {log}; give other names")));
        }
        // Dropped at once: an update that is killed leaves no temporary file behind.
        drop(Output::open(&self.output)?);
        Ok(())
    }

    fn report(
        &self,
        state: &MapState,
        update: &UpdateReport,
        seconds: serde_json::Map<String, serde_json::Value>,
    ) -> serde_json::Value {
        serde_json::json!({
            "map": self.output.display().to_string(),
            "state": self.state.display().to_string(),
            "update": update,
            "report": state.map().report(),
            "seconds": seconds,
        })
    }
}
