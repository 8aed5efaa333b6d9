//! `covimap evaluate`: how far a map is from surveyed positions.

use std::path::PathBuf;

use covimap_map::evaluate::{self, EvaluateParams, Evaluation};
use covimap_map::{GlobalMap, Truth};

use crate::console::{self, Console};
use crate::options::ThreadArgs;
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
    #[command(flatten)]
    threads: ThreadArgs,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

impl Args {
    pub fn run(self, console: Console) -> anyhow::Result<()> {
        self.threads.start()?;
        let map = GlobalMap::load(&self.map)?;
        let truth = Truth::read(&self.truth)?;
        let mut params = EvaluateParams::default();
        params.seed = self.seed;
        let found = evaluate::against(&map, &truth, &params)?;
        if self.json {
            return Ok(console::print(serde_json::to_string(&found)?)?);
        }
        console::print(text(&found))?;
        for (count, where_from) in [
            (found.missing, "of the truth not in the map"),
            (found.unknown, "of the map not in the truth"),
            (found.isolated, "in components that share fewer than three with the truth"),
        ] {
            if count > 0 {
                console.say(format_args!("left out: {} {where_from}", counted(count as u64, "landmark")));
            }
        }
        Ok(())
    }
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
