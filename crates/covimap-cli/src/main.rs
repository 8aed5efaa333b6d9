//! The covimap command line: sightings in, maps out.
//!
//! One file a command in `commands`. Results go to standard output, everything else to standard
//! error; exit codes are given out in one place, `exit`.

mod bundled;
mod commands;
mod console;
mod exit;
mod interrupt;
mod options;
mod progress;
mod reproduce;
mod summary;
mod table;

use std::process::ExitCode;

use clap::Parser;

fn main() -> ExitCode {
    let cli = commands::Cli::parse();
    exit::with(interrupt::listen().and_then(|()| cli.run()))
}
