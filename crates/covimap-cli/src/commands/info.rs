//! `covimap info`: what is in a map file.

use std::path::PathBuf;

use covimap_map::{GlobalMap, Method};
use serde_json::json;

use crate::{console, summary};

/// Show what a map file holds
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Map file; `-` is stdin
    #[arg(value_name = "MAP.json")]
    map: PathBuf,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

impl Args {
    pub fn run(self) -> anyhow::Result<()> {
        let map = GlobalMap::load(&self.map)?;
        if self.json {
            let object = json!({ "landmarks": map.len(), "settings": map.params(), "report": map.report() });
            return Ok(console::print(object)?);
        }
        let method = match map.params().method {
            Method::Auto => "auto",
            Method::Classical => "classical",
        };
        let report = map.report();
        let largest = report.components.first().and_then(|component| component.distances.as_ref());
        let distances =
            largest.map_or_else(String::new, |largest| format!("\n{}", summary::distances(largest)));
        Ok(console::print(format_args!(
            "{}: method {method}, seed {}\n{}{distances}\n\n{}",
            self.map.display(),
            map.params().seed,
            summary::of(report),
            summary::components(&report.components),
        ))?)
    }
}
