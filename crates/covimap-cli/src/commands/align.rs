//! `covimap align`: a map in a frame that is known from outside.

use std::path::PathBuf;

use covimap_map::{ChartFit, Truth};
use covimap_plan::{Aligned, Known, KnownDistance, MapIndex, align};
use serde_json::json;

use crate::console::{self, Console};
use crate::interrupt::Deferral;
use crate::options::QuestionArgs;
use crate::summary::counted;
use crate::table;

/// Bring a map into the frame and unit of what is known of some landmarks
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    question: QuestionArgs,
    /// Known positions: CSV with the columns id,x,y, in any unit
    #[arg(long, value_name = "ANCHORS.csv")]
    truth: Option<PathBuf>,
    /// A known distance between two landmarks; may be given several times
    #[arg(long = "distance", value_name = "A,B,D", value_parser = distance)]
    distances: Vec<KnownDistance>,
    /// Landmarks that are known to turn left: C is to the left of the line from A to B; may be given several times
    #[arg(long = "turn", value_name = "A,B,C", value_parser = turn)]
    turns: Vec<Triple>,
    /// Where the aligned map goes; a name that ends in .covimap takes the binary form, `-` is stdout
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
}

/// Clap takes a list of lists for something else, so that the three get a name.
#[derive(Debug, Clone)]
struct Triple([String; 3]);

impl Args {
    pub fn run(self, console: Console) -> anyhow::Result<()> {
        let index = self.question.index()?;
        let truth = self.truth.as_deref().map(Truth::read).transpose()?;
        let left_turns: Vec<[String; 3]> = self.turns.into_iter().map(|Triple(ids)| ids).collect();
        let known = Known { positions: truth.as_ref(), distances: &self.distances, left_turns: &left_turns };
        let aligned = align(&index, &known)?;
        let _deferral = Deferral::of_writing();
        aligned.map.save(&self.output)?;
        if aligned.unknown > 0 {
            console.say(format_args!(
                "left out: {} that the map does not have",
                counted(aligned.unknown as u64, "landmark")
            ));
        }
        let left = index.components().len() - aligned.carried.len();
        if left > 0 {
            console.say(format_args!("left as they were: {}", counted(left as u64, "component")));
        }
        if self.output.as_os_str() == "-" {
            return Ok(());
        }
        Ok(console::print(if self.question.json { object(&index, &aligned) } else { text(&aligned) })?)
    }
}

fn fits(aligned: &Aligned) -> impl Iterator<Item = &ChartFit> {
    aligned.map.alignment().iter().filter(|fit| aligned.carried.contains(&fit.component))
}

fn object(index: &MapIndex, aligned: &Aligned) -> String {
    let residuals: Vec<_> = aligned
        .residuals
        .iter()
        .map(|&(id, residual)| json!({ "id": index.name(id), "residual": residual }))
        .collect();
    json!({
        "components": fits(aligned).collect::<Vec<_>>(),
        "residuals": residuals,
        "unknown": aligned.unknown,
    })
    .to_string()
}

fn text(aligned: &Aligned) -> String {
    let mut rows =
        vec![table::row(["component", "positions", "distances", "scale", "rmse", "mirror settled"])];
    rows.extend(fits(aligned).map(|fit| {
        table::row([
            &fit.component.to_string(),
            &fit.anchors.to_string(),
            &fit.distances.to_string(),
            &format!("{:.4}", fit.scale),
            &format!("{:.4}", fit.rmse),
            if fit.handed { "yes" } else { "no" },
        ])
    }));
    table::render(&rows)
}

fn distance(text: &str) -> Result<KnownDistance, String> {
    let asked = || "give two IDs and a distance, as in door,desk,3.5".to_owned();
    let [from, to, distance] = three(text).ok_or_else(asked)?;
    let distance = distance.parse().map_err(|_| asked())?;
    Ok(KnownDistance { from, to, distance })
}

fn turn(text: &str) -> Result<Triple, String> {
    three(text).map(Triple).ok_or_else(|| "give three IDs, as in door,desk,window".to_owned())
}

fn three(text: &str) -> Option<[String; 3]> {
    let parts: Vec<String> = text.split(',').map(|part| part.trim().to_owned()).collect();
    parts.try_into().ok()
}
