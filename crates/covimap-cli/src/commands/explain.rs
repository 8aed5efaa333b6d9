//! `covimap explain`: what holds a landmark in its place.

use covimap_plan::{Explanation, Hold, explain};

use crate::options::QuestionArgs;
use crate::{console, table};

/// Tell what holds a landmark in its place, and what would help
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    question: QuestionArgs,
    /// The landmark
    #[arg(value_name = "ID")]
    landmark: String,
}

impl Args {
    pub fn run(self) -> anyhow::Result<()> {
        let index = self.question.index()?;
        let found = explain(&index, &self.landmark)?;
        if self.question.json {
            return Ok(console::print(serde_json::to_string(&found)?)?);
        }
        Ok(console::print(text(&found))?)
    }
}

fn text(found: &Explanation) -> String {
    let mut facts = vec![
        table::row(["steps that show it", &found.sightings.to_string()]),
        table::row(["landmarks seen with it", &found.partners.to_string()]),
    ];
    facts.push(table::row([
        &format!("component {}, landmarks", found.component),
        &found.component_landmarks.to_string(),
    ]));
    facts.push(table::row([
        &format!("region {}, landmarks", found.region),
        &found.region_landmarks.to_string(),
    ]));
    facts.push(table::row(["standard deviation", &format!("{:.4}", found.deviation)]));
    facts.push(table::row(["  median of the component", &format!("{:.4}", found.typical_deviation)]));
    let mut holds = vec![table::row(["held by", "steps", "frequency", "distance", "seam"])];
    holds.extend(found.holds.iter().map(hold));
    let advice: Vec<String> = found.advice.iter().map(|advice| format!("\n\n{}", advice.message)).collect();
    let advice = if advice.is_empty() { "\n\nheld as well as others".to_owned() } else { advice.concat() };
    format!("{}\n\n{}{advice}", table::render(&facts), table::render(&holds))
}

fn hold(hold: &Hold) -> Vec<String> {
    table::row([
        &hold.id,
        &hold.steps.to_string(),
        &format!("{:.3}", hold.frequency),
        &format!("{:.4}", hold.distance),
        if hold.seam { "yes" } else { "no" },
    ])
}
