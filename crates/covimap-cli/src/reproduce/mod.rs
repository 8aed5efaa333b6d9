//! The paper's experiments: its parameters, its method and ours over the same logs.
//!
//! ```text
//! catalogue -> runner -> results -> figure, csv
//!                               -> claims, accuracy -> summary
//! ```
//!
//! An experiment is a row of `catalogue`; everything else is the same for all of them. Numbers of equations and
//! figures are those of T. Yairi, K. Hori, K. Hirama, *Qualitative map learning based on co-visibility of objects*.
//!
//! # How errors are averaged
//! Objects that the log has not shown yet are left out of both errors, and objects in parts of the log that
//! nothing connects are compared part by part. A log from which some method can make no map that can be judged
//! (no two objects seen together, or no three that hang together) is left out for all methods. How many runs and
//! landmarks a mean is over stands beside it in the CSV file.

mod accuracy;
mod catalogue;
mod claims;
mod experiment;
mod figures;
mod plot;
mod results;
mod robot;
mod runner;
mod statistics;
mod summary;

use std::io::{self, Write};
use std::path::Path;

use covimap_map::{MapError, Observer, output};

use crate::interrupt::Deferral;
use crate::progress::Progress;
use experiment::{Experiment, View};
use results::Results;
use robot::Trial;

/// The name that stands for all experiments.
const ALL: &str = "all";

/// What to reproduce.
#[derive(Debug, Clone)]
pub struct Order {
    /// Names of experiments.
    pub names: Vec<String>,
    /// Layouts instead of the paper's number.
    pub layouts: Option<u64>,
    /// Steps after which the paper's runs are cut short.
    pub steps: Option<usize>,
    /// Seed of layouts and walks, below 2^24.
    pub seed: u64,
}

impl Order {
    fn wants(&self, experiment: &str) -> bool {
        self.names.iter().any(|name| name == experiment || name == ALL)
    }

    /// The experiments wanted, in the paper's order.
    fn experiments(&self) -> Vec<Experiment> {
        let mut wanted = catalogue::all();
        wanted.retain(|experiment| self.wants(experiment.name));
        for experiment in &mut wanted {
            experiment.layouts = self.layouts.unwrap_or(experiment.layouts);
            if let Some(most) = self.steps {
                experiment.steps.retain(|&steps| steps <= most);
            }
        }
        wanted
    }
}

/// Names that can be ordered.
pub fn names() -> Vec<&'static str> {
    catalogue::all().iter().map(|experiment| experiment.name).chain([robot::NAME, ALL]).collect()
}

/// Runs what is ordered and writes tables, figures and summary into the folder.
///
/// # Errors
/// [`MapError::Unwritable`], [`MapError::Interrupted`].
pub fn run(order: &Order, folder: &Path, progress: &Progress) -> anyhow::Result<()> {
    output::make_folder(folder)?;
    let mut all = Vec::new();
    for experiment in order.experiments() {
        progress.begin(experiment.name, "runs", Some(runner::runs(&experiment)));
        let samples = runner::run(&experiment, order.seed, &|| progress.advanced(1))?;
        all.push(Results { experiment, samples });
        write_results(all.last().expect("just pushed (bug in covimap)"), folder)?;
    }
    let trial = order.wants(robot::NAME).then(Trial::new).transpose()?;
    if let Some(trial) = &trial {
        write(folder, &format!("{}.csv", robot::NAME), |out| trial.write_csv(out))?;
        for (name, picture) in trial.pictures()? {
            write(folder, &name, |out| out.write_all(picture.as_bytes()))?;
        }
    }
    write(folder, "summary.md", |out| out.write_all(summary::text(&all, trial.as_ref()).as_bytes()))?;
    Ok(())
}

fn write_results(results: &Results, folder: &Path) -> Result<(), MapError> {
    let Experiment { name, view, .. } = &results.experiment;
    write(folder, &format!("{name}.csv"), |out| match view {
        View::Steps | View::Information => results.write_csv(out),
        View::Exploration => results.write_runs_csv(out),
    })?;
    let figure = plot::svg(&figures::figure(results));
    write(folder, &format!("{name}.svg"), |out| out.write_all(figure.as_bytes()))
}

fn write(
    folder: &Path,
    name: &str,
    contents: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), MapError> {
    let _deferral = Deferral::of_writing();
    output::write_whole(&folder.join(name), contents)
}
