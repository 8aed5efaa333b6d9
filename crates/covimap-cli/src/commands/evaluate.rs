//! `covimap evaluate`: how far a map is from surveyed positions.

use std::path::PathBuf;

use covimap_map::evaluate::{self, EvaluateParams, Evaluation, Limit};
use covimap_map::{GlobalMap, SightingLog, Truth};

use crate::console::{self, Console};
use crate::options::{FormatArg, ThreadArgs, conflict};
use crate::progress::Progress;
use crate::summary::counted;
use crate::table;

/// Compare a map with surveyed positions
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Map file; `-` is stdin
    #[arg(value_name = "MAP.json")]
    map: PathBuf,
    /// Surveyed positions: CSV with the columns id,x,y, in any unit
    #[arg(value_name = "TRUTH.csv")]
    truth: PathBuf,
    /// Seed of the sample of triangles that stands for all of them in a large map
    #[arg(long, value_name = "S", default_value_t = 0)]
    seed: u64,
    /// The log of the map, once for each of several: also tell what the log allows, by minimising from the truth
    #[arg(long, value_name = "LOG")]
    limit: Vec<PathBuf>,
    #[command(flatten)]
    format: FormatArg,
    #[command(flatten)]
    threads: ThreadArgs,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

impl Args {
    pub fn run(self, console: Console) -> anyhow::Result<()> {
        if self.limit.is_empty() && self.format.get().is_some() {
            return Err(conflict("--format is that of the log of --limit; add that or leave --format out"));
        }
        self.threads.start()?;
        let map = GlobalMap::load(&self.map)?;
        let truth = Truth::read(&self.truth)?;
        let mut params = EvaluateParams::default();
        params.seed = self.seed;
        if self.limit.is_empty() {
            let found = evaluate::against(&map, &truth, &params)?;
            console::print(if self.json { serde_json::to_string(&found)? } else { text(&found) })?;
            self.say_left_out(&found, console);
        } else {
            let limit = self.limit(&map, &truth, &params, console)?;
            console::print(if self.json { limit_json(&limit)?.to_string() } else { limit_text(&limit) })?;
            self.say_left_out(&limit.map, console);
        }
        Ok(())
    }

    /// Says to people what was not compared; programs find it in the JSON.
    fn say_left_out(&self, found: &Evaluation, console: Console) {
        let counts = [
            (found.missing, "of the truth not in the map"),
            (found.unknown, "of the map not in the truth"),
            (found.isolated, "in components that share fewer than three with the truth"),
        ];
        for (count, where_from) in counts.into_iter().filter(|&(count, _)| count > 0 && !self.json) {
            console.say(format_args!("left out: {} {where_from}", counted(count as u64, "landmark")));
        }
    }

    fn limit(
        &self,
        map: &GlobalMap,
        truth: &Truth,
        params: &EvaluateParams,
        console: Console,
    ) -> anyhow::Result<Limit> {
        let progress = Progress::new(console);
        let log = SightingLog::read(&self.limit, self.format.get(), &progress)?;
        let limit = evaluate::limit(map, truth, &log, params, &progress)?;
        progress.end();
        Ok(limit)
    }
}

/// The keys of an evaluation, and beside them what the log allows.
fn limit_json(limit: &Limit) -> serde_json::Result<serde_json::Value> {
    let mut json = serde_json::to_value(&limit.map)?;
    json["stress1"] = limit.map_stress1.into();
    json["from_truth"] = serde_json::to_value(&limit.from_truth)?;
    json["from_truth"]["stress1"] = limit.stress1.into();
    json["ratio"] = serde_json::to_value(limit.ratio)?;
    json["bound"] = serde_json::to_value(limit.bound)?;
    Ok(json)
}

/// The errors of the map, of what is reached from the truth, and of the one over the other.
fn limit_text(limit: &Limit) -> String {
    let Limit { map, from_truth, ratio, .. } = limit;
    let number =
        |value: Option<f64>, digits: usize| value.map_or("-".to_owned(), |value| format!("{value:.digits$}"));
    let ratios = [
        ratio.orientation_error,
        ratio.local_orientation_error,
        ratio.delaunay_error,
        ratio.rmse,
        ratio.rmse,
        None,
    ];
    let mut rows = vec![
        table::row(["", "map", "from the truth", "ratio"]),
        table::row([
            "stress-1",
            &number(limit.map_stress1, 4),
            &number(Some(limit.stress1), 4),
            &number(ratio.stress1, 2),
        ]),
    ];
    for (((name, ours), (_, best)), ratio) in errors(map).into_iter().zip(errors(from_truth)).zip(ratios) {
        rows.push(table::row([name, &ours, &best, &number(ratio, 2)]));
    }
    let mut text = table::render(&rows);
    if let Some(bound) = limit.bound {
        text += &format!(
            "\nwith the places of the robot known this log would allow a rmse of about {:.4}, the map has {:.4};\n\
             of the Delaunay edges about {:.4} would differ, in the map {:.4} do",
            bound.rmse, map.rmse, bound.delaunay_error, map.delaunay_error
        );
    }
    text
}

fn text(found: &Evaluation) -> String {
    let columns = errors(found);
    let sizes = [("landmarks compared", found.n), ("components compared", found.components)];
    let rows: Vec<_> = sizes
        .map(|(name, count)| table::row([name, &count.to_string()]))
        .into_iter()
        .chain(columns.into_iter().map(|(name, value)| vec![name.to_owned(), value]))
        .collect();
    table::render(&rows)
}

/// The measures by name, as people read them.
pub fn errors(found: &Evaluation) -> Vec<(&'static str, String)> {
    let share = |value: Option<f64>| value.map_or("-".to_owned(), |value| format!("{value:.4}"));
    let orientation = match found.orientation_standard_error {
        Some(error) => format!("{} +- {error:.4}", share(found.orientation_error)),
        None => share(found.orientation_error),
    };
    vec![
        ("triangles turned the wrong way", orientation),
        ("  of near landmarks alone", share(found.local_orientation_error)),
        ("Delaunay edges that differ", share(Some(found.delaunay_error))),
        ("rmse after the best fit, unit of the truth", format!("{:.4}", found.rmse)),
        ("  over the spread of the truth", share(found.relative_rmse)),
        ("10 nearest neighbours found", share(Some(found.knn10))),
    ]
}
