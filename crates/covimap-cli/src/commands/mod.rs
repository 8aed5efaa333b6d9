//! The commands, one file each.

mod align;
mod build;
mod check;
mod demo;
mod evaluate;
mod explain;
mod explore;
mod export;
mod info;
mod locate;
mod near;
mod relation;
mod reproduce;
mod route;
mod simulate;
mod update;

use clap::{CommandFactory, Parser, Subcommand};

use crate::console::Console;

const EXAMPLES: &str = "\
Examples:
  covimap demo                                   map a real robot log that is built in
  covimap build run.jsonl                        write run.map.json
  covimap export run.map.json --to svg -o run.svg
  covimap evaluate run.map.json truth.csv
  covimap route run.map.json door desk
  covimap locate run.map.json --seen door,desk

Results go to stdout, messages to stderr.
Exit codes: 0 done, 1 failure, 2 usage, 3 bad input, 130 interrupted.";

/// A map from a log of which landmarks were seen together
#[derive(Debug, Parser)]
#[command(name = "covimap", version, after_help = EXAMPLES)]
pub struct Cli {
    #[command(subcommand)]
    command: Command,
    /// Say nothing but errors
    #[arg(short, long, global = true)]
    quiet: bool,
}

#[derive(Debug, Subcommand)]
enum Command {
    Build(build::Args),
    Update(update::Args),
    Evaluate(evaluate::Args),
    Export(export::Args),
    Info(info::Args),
    Near(near::Args),
    Locate(locate::Args),
    Relation(relation::Args),
    Route(route::Args),
    Explain(explain::Args),
    Explore(explore::Args),
    Align(align::Args),
    Check(check::Args),
    Demo(demo::Args),
    Simulate(Box<simulate::Args>),
    Reproduce(reproduce::Args),
}

impl Cli {
    /// Runs the command.
    ///
    /// # Errors
    /// Whatever ends the command before its result is out; `exit` tells what they come to.
    pub fn run(self) -> anyhow::Result<()> {
        // Usage errors that a command finds itself do not know the command line yet.
        self.dispatch().map_err(|error| match error.downcast::<clap::Error>() {
            Ok(usage) => usage.format(&mut Self::command()).into(),
            Err(other) => other,
        })
    }

    fn dispatch(self) -> anyhow::Result<()> {
        let console = Console { quiet: self.quiet };
        match self.command {
            Command::Build(args) => args.run(console),
            Command::Update(args) => args.run(console),
            Command::Evaluate(args) => args.run(console),
            Command::Export(args) => args.run(console),
            Command::Info(args) => args.run(),
            Command::Near(args) => args.run(),
            Command::Locate(args) => args.run(console),
            Command::Relation(args) => args.run(console),
            Command::Route(args) => args.run(),
            Command::Explain(args) => args.run(),
            Command::Explore(args) => args.run(console),
            Command::Align(args) => args.run(console),
            Command::Check(args) => args.run(console),
            Command::Demo(args) => args.run(console),
            Command::Simulate(args) => args.run(console),
            Command::Reproduce(args) => args.run(console),
        }
    }
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    #[test]
    fn no_two_options_clash() {
        super::Cli::command().debug_assert();
    }
}
