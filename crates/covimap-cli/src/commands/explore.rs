//! `covimap explore`: where to look next, and whether the map is good enough.

use std::sync::Arc;

use covimap_plan::{ExploreParams, Forecast, Goal, Localiser, Location, forecast, next_best};
use serde_json::json;

use crate::console::{self, Console};
use crate::options::QuestionArgs;
use crate::summary::counted;
use crate::table;

/// Tell where to look next so that the map gains most, and whether it is good enough
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    question: QuestionArgs,
    /// What the robot sees from where it is: goals near by are then worth more
    #[arg(long, value_name = "A,B,C", value_delimiter = ',')]
    from: Vec<String>,
    /// How many goals at most
    #[arg(short, value_name = "K", default_value_t = 5)]
    k: usize,
    /// Looks that a visit makes
    #[arg(long, value_name = "N", default_value_t = ExploreParams::default().looks)]
    looks: u32,
    /// Share of the triangles of near landmarks that may turn the wrong way in a finished map
    #[arg(long, value_name = "SHARE", default_value_t = ExploreParams::default().error)]
    error: f64,
}

impl Args {
    pub fn run(self, console: Console) -> anyhow::Result<()> {
        let index = Arc::new(self.question.index()?);
        let mut params = ExploreParams::default();
        params.looks = self.looks;
        params.error = self.error;
        let here = if self.from.is_empty() {
            None
        } else {
            let localiser = Localiser::new(Arc::clone(&index))?;
            Some(localiser.locate(&localiser.look(self.from.iter().map(String::as_str))))
        };
        if here.as_ref().is_some_and(Location::is_lost) {
            console.say(format_args!(
                "what is seen does not tell where the robot is; goals are listed for any place"
            ));
        }
        let here = here.filter(|here| !here.is_lost());
        let goals = next_best(&index, here.as_ref(), self.k, params)?;
        let forecast = forecast(&index, params)?;
        if self.question.json {
            let mut object = serde_json::to_value(forecast)?;
            object["goals"] = json!(goals);
            return Ok(console::print(object)?);
        }
        Ok(console::print(text(&goals, &forecast))?)
    }
}

fn text(goals: &[Goal], forecast: &Forecast) -> String {
    let mut rows =
        vec![table::row(["go to", "component", "gain", "distance", "sightings", "deviation", "why"])];
    rows.extend(goals.iter().map(row));
    format!("{}\n\n{}", table::render(&rows), verdict(forecast))
}

fn row(goal: &Goal) -> Vec<String> {
    let reasons: Vec<&str> = goal.reasons.iter().map(|reason| reason.name()).collect();
    table::row([
        &goal.id,
        &goal.component.to_string(),
        &format!("{:.2} %", 100.0 * goal.gain),
        &goal.distance.map_or("-".to_owned(), |distance| format!("{distance:.3}")),
        &goal.sightings.to_string(),
        &format!("{:.4}", goal.deviation),
        &if reasons.is_empty() { "gains most".to_owned() } else { reasons.join(", ") },
    ])
}

fn verdict(forecast: &Forecast) -> String {
    let Forecast { error, wanted, more_steps, hinges, stop, .. } = *forecast;
    let told = format!("{:.1} % of near triangles are expected to turn the wrong way", 100.0 * error);
    if stop {
        return format!("stop: {told}, {:.1} % are allowed", 100.0 * wanted);
    }
    let hinges = if hinges == 0 {
        String::new()
    } else {
        format!(", and the side of a part of the map is open at {}", counted(hinges as u64, "hinge"))
    };
    format!(
        "go on: {told}, {:.1} % are allowed, about {} more{hinges}",
        100.0 * wanted,
        counted(more_steps, "step")
    )
}
