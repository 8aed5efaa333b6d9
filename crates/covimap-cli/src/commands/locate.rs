//! `covimap locate`: where a robot is that sees these landmarks.

use std::sync::Arc;

use covimap_plan::{Localiser, Location, Look, MapIndex, Mode};
use serde_json::{Value, json};

use crate::console::{self, Console};
use crate::options::QuestionArgs;
use crate::summary::counted;

/// Tell where a robot is that sees these landmarks
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    question: QuestionArgs,
    /// IDs of all landmarks in the look, with commas between them; give the option again for more
    #[arg(long, value_name = "A,B,C", value_delimiter = ',', required = true)]
    seen: Vec<String>,
}

impl Args {
    pub fn run(self, console: Console) -> anyhow::Result<()> {
        let index = Arc::new(self.question.index()?);
        let localiser = Localiser::new(Arc::clone(&index))?;
        let look = localiser.look(self.seen.iter().map(String::as_str));
        let location = localiser.locate(&look);
        if self.question.json {
            return Ok(console::print(object(&index, &look, &location))?);
        }
        console::print(text(&look, &location))?;
        if !look.unknown.is_empty() {
            let ids = look.unknown.join(", ");
            console.say(format_args!("{} not in the map: {ids}", counted(look.unknown.len() as u64, "ID")));
        }
        if !location.misfits.is_empty() {
            let ids: Vec<&str> = location.misfits.iter().map(|&id| index.name(id)).collect();
            console.say(format_args!("out of sight from there, and so perhaps misread: {}", ids.join(", ")));
        }
        Ok(())
    }
}

fn object(index: &MapIndex, look: &Look, location: &Location) -> Value {
    let best = location.best().map(mode);
    let of_best = |key: &str| best.as_ref().map_or(Value::Null, |best| best[key].clone());
    json!({
        "x": of_best("x"),
        "y": of_best("y"),
        "covariance": of_best("covariance"),
        "component": of_best("component"),
        "probability": of_best("probability"),
        "ambiguous": location.is_ambiguous(),
        "lost": location.is_lost(),
        "lost_probability": location.lost,
        "modes": location.modes.iter().map(mode).collect::<Vec<_>>(),
        "misfits": location.misfits.iter().map(|&id| index.name(id)).collect::<Vec<_>>(),
        "unknown": look.unknown,
    })
}

fn mode(mode: &Mode) -> Value {
    let [xx, xy, yy] = mode.covariance;
    json!({
        "x": mode.position[0],
        "y": mode.position[1],
        "covariance": [[xx, xy], [xy, yy]],
        "component": mode.component,
        "probability": mode.probability,
    })
}

fn text(look: &Look, location: &Location) -> String {
    let state = match (location.is_lost(), location.is_ambiguous()) {
        (true, _) if look.known.is_empty() && look.copies.is_empty() => {
            "lost: the map has none of these landmarks"
        }
        (true, _) => "lost: these landmarks do not go together on this map",
        (false, true) => "ambiguous: several places fit",
        (false, false) => "found",
    };
    let places = location.modes.iter().map(|mode| {
        let ([x, y], [xx, _, yy]) = (mode.position, mode.covariance);
        format!(
            "\n  ({x:.4}, {y:.4}) in component {}, standard deviations {:.4} and {:.4}, probability {:.3}",
            mode.component,
            xx.sqrt(),
            yy.sqrt(),
            mode.probability
        )
    });
    std::iter::once(state.to_owned()).chain(places).collect()
}
