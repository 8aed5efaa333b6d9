//! `covimap reproduce`: the experiments of the paper, with its method and with ours.

use std::path::PathBuf;

use clap::builder::PossibleValuesParser;

use crate::console::Console;
use crate::options::ThreadArgs;
use crate::progress::Progress;
use crate::reproduce::{self, Order};

/// Repeat the experiments of the CoviMap paper, with its method and with ours
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Experiments; `all` is every one of them
    #[arg(required = true, value_name = "EXPERIMENT", value_parser = PossibleValuesParser::new(reproduce::names()))]
    experiments: Vec<String>,
    /// Folder for tables, figures and summary.md; made if it is not there
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Layouts of the objects that means are over [default: as many as in the paper]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=10_000))]
    layouts: Option<u64>,
    /// Steps of the longest log [default: as many as in the paper]
    #[arg(long, value_name = "T", value_parser = clap::value_parser!(u64).range(100..=1000))]
    steps: Option<u64>,
    /// Seed of layouts and walks
    #[arg(long, value_name = "S", default_value_t = 0, value_parser = clap::value_parser!(u64).range(..1 << 24))]
    seed: u64,
    #[command(flatten)]
    threads: ThreadArgs,
}

impl Args {
    pub fn run(self, console: Console) -> anyhow::Result<()> {
        self.threads.start()?;
        let order = Order {
            names: self.experiments,
            layouts: self.layouts,
            steps: self.steps.map(|steps| steps as usize),
            seed: self.seed,
        };
        let progress = Progress::new(console);
        reproduce::run(&order, &self.output, &progress)?;
        progress.end();
        console.say(format_args!("results written to {}", self.output.join("summary.md").display()));
        Ok(())
    }
}
