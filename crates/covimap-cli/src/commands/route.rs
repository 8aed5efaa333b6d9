//! `covimap route`: the way from landmark to landmark.

use clap::ValueEnum;
use covimap_plan::{MapIndex, Objective, RoadParams, Roads, Route};
use serde_json::{Value, json};

use crate::options::QuestionArgs;
use crate::{console, table};

/// Find a way between two landmarks
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    question: QuestionArgs,
    /// Where it begins
    from: String,
    /// Where it ends
    to: String,
    /// What the way should be good at
    #[arg(long, value_enum, value_name = "WHAT", default_value_t = Goal::Shortest)]
    prefer: Goal,
    /// Only between neighbours that so many steps show together
    #[arg(long, value_name = "N", default_value_t = 1)]
    min_steps: u32,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum Goal {
    /// Least length
    Shortest,
    /// The next landmark in sight as surely as can be
    Safest,
}

impl Args {
    pub fn run(self) -> anyhow::Result<()> {
        let index = self.question.index()?;
        let mut params = RoadParams::default();
        params.min_steps = self.min_steps;
        params.objective = match self.prefer {
            Goal::Shortest => Objective::Shortest,
            Goal::Safest => Objective::Safest,
        };
        let route = Roads::new(&index, params)?.route(&self.from, &self.to)?;
        if self.question.json {
            return Ok(console::print(object(&index, params.objective, &route))?);
        }
        Ok(console::print(text(&index, &route))?)
    }
}

fn object(index: &MapIndex, objective: Objective, route: &Route) -> Value {
    let name = |&id| index.name(id);
    let waypoints: Vec<Value> = route
        .waypoints
        .iter()
        .map(|point| {
            json!({
                "x": point.position[0],
                "y": point.position[1],
                "in_sight": point.in_sight.iter().map(name).collect::<Vec<_>>(),
                "steps": point.steps,
                "cost": point.cost,
            })
        })
        .collect();
    json!({
        "landmarks": route.landmarks.iter().map(name).collect::<Vec<_>>(),
        "length": route.length,
        "cost": route.cost,
        "objective": objective,
        "waypoints": waypoints,
    })
}

fn text(index: &MapIndex, route: &Route) -> String {
    let mut rows = vec![table::row(["from", "to", "x", "y", "steps"])];
    rows.extend(route.waypoints.iter().map(|point| {
        let [from, to] = point.in_sight.map(|id| index.name(id));
        let [x, y] = point.position.map(|v| format!("{v:.4}"));
        table::row([from, to, &x, &y, &point.steps.to_string()])
    }));
    format!("{}\n\nlength {:.4} over {} landmarks", table::render(&rows), route.length, route.landmarks.len())
}
