//! `covimap check`: what is in a log, and which of its lines are bad.

use covimap_map::{LogCheck, LogSummary, SightingLog};
use serde_json::json;

use crate::console::{self, Console, complain};
use crate::exit::BadLines;
use crate::options::{LogArgs, ThreadArgs};
use crate::progress::Progress;
use crate::summary::counted;
use crate::table;

/// Look through logs, list bad lines and count what is in the others
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    input: LogArgs,
    /// Most bad lines to list
    #[arg(long, value_name = "N", default_value_t = 20)]
    list: usize,
    #[command(flatten)]
    threads: ThreadArgs,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

impl Args {
    pub fn run(self, console: Console) -> anyhow::Result<()> {
        self.threads.start()?;
        let progress = Progress::new(console);
        let found = SightingLog::check(&self.input.logs, self.input.format(), self.list, &progress)?;
        progress.end();
        for problem in &found.problems {
            complain(problem);
        }
        let unlisted = found.bad_lines - found.problems.len() as u64;
        if unlisted > 0 {
            complain(format_args!("and {} more; --list N lists N of them", counted(unlisted, "bad line")));
        }
        if self.json {
            console::print(json(&found))?;
        } else {
            console::print(text(&found))?;
        }
        if found.summary.shared_steps == 0 {
            console
                .say("warning: no step shows two landmarks; a map needs landmarks that were seen together");
        }
        if found.bad_lines > 0 { Err(BadLines.into()) } else { Ok(()) }
    }
}

fn json(found: &LogCheck) -> serde_json::Value {
    let LogCheck { summary, problems, bad_lines } = found;
    let problems: Vec<_> = problems
        .iter()
        .map(|problem| json!({ "file": problem.file, "line": problem.line, "what": problem.what }))
        .collect();
    json!({ "summary": summary, "bad_lines": bad_lines, "problems": problems })
}

fn text(found: &LogCheck) -> String {
    let LogSummary {
        lines,
        steps,
        empty_steps,
        single_steps,
        shared_steps,
        largest_step,
        sightings,
        duplicates,
        landmarks,
    } = found.summary;
    let rows = [
        ("lines", lines),
        ("bad lines", found.bad_lines),
        ("steps", steps),
        ("  with nothing seen", empty_steps),
        ("  with one landmark", single_steps),
        ("  with two or more", shared_steps),
        ("most landmarks in a step", largest_step),
        ("sightings", sightings),
        ("repeated within a step", duplicates),
        ("landmarks", landmarks),
    ];
    table::render(&rows.map(|(name, count)| table::row([name, &count.to_string()])))
}
