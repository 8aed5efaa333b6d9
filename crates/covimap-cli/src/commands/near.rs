//! `covimap near`: what is near a landmark.

use covimap_plan::Near;
use serde_json::json;

use crate::options::QuestionArgs;
use crate::{console, table};

/// List the landmarks nearest to a landmark
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    question: QuestionArgs,
    /// The landmark
    #[arg(value_name = "ID")]
    landmark: String,
    /// How many at most [default: 10, or all within --radius]
    #[arg(short, value_name = "K")]
    k: Option<usize>,
    /// Only those within this distance, in the units of the map
    #[arg(long, value_name = "R")]
    radius: Option<f64>,
}

impl Args {
    pub fn run(self) -> anyhow::Result<()> {
        let index = self.question.index()?;
        let id = self.landmark.as_str();
        let found = match (self.radius, self.k) {
            (None, k) => index.nearest(id, k.unwrap_or(10))?,
            (Some(radius), k) => {
                let mut found = index.within(id, radius)?;
                found.truncate(k.unwrap_or(usize::MAX));
                found
            }
        };
        if self.question.json {
            let near = |near: &Near| {
                let placed = index.landmark(near.landmark)?;
                Ok(json!({
                    "id": index.name(near.landmark),
                    "distance": near.distance,
                    "x": placed.position[0],
                    "y": placed.position[1],
                    "next_to": index.is_next_to(id, near.landmark)?,
                }))
            };
            let near = found.iter().map(near).collect::<anyhow::Result<Vec<_>>>()?;
            let component = index.landmark(id)?.component;
            return Ok(console::print(json!({ "landmark": id, "component": component, "near": near }))?);
        }
        let mut rows = vec![table::row(["landmark", "distance"])];
        rows.extend(
            found
                .iter()
                .map(|near| table::row([index.name(near.landmark), &format!("{:.4}", near.distance)])),
        );
        Ok(console::print(table::render(&rows))?)
    }
}
