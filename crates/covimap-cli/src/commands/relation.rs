//! `covimap relation`: on which side of a line a landmark is.

use covimap_plan::Turn;
use serde_json::json;

use crate::console::{self, Console};
use crate::options::QuestionArgs;

/// Tell on which side of the line from A to B landmark C is
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    question: QuestionArgs,
    /// Where the line begins
    a: String,
    /// Where it leads
    b: String,
    /// The landmark beside it
    c: String,
}

impl Args {
    pub fn run(self, console: Console) -> anyhow::Result<()> {
        let index = self.question.index()?;
        let Self { a, b, c, .. } = &self;
        let found = index.orientation(a, b, c)?;
        let handed = index.is_handed(index.landmark(a)?.component);
        if self.question.json {
            return Ok(console::print(json!({
                "orientation": found.orientation,
                "probability": found.probability,
                "may_be_mirrored": !handed,
                "next_to": { "ab": index.is_next_to(a, b)?, "bc": index.is_next_to(b, c)?, "ac": index.is_next_to(a, c)? },
            }))?);
        }
        let side = match found.orientation {
            Turn::Left => "left",
            Turn::Right => "right",
        };
        console::print(format_args!(
            "{c} is to the {side} of the line from {a} to {b}, with probability {:.3}",
            found.probability
        ))?;
        if !handed {
            console.say(
                "the map may be a mirror image, in which left is right: `covimap align --turn` settles it",
            );
        }
        Ok(())
    }
}
