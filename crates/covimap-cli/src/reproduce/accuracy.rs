//! How much better `auto` is than the paper's method, over the same logs.

use super::experiment::{MapMethod, Measure};
use super::results::Results;

/// Numbers of steps in the table.
const STEPS: [usize; 3] = [100, 300, 1000];

const HEADER: &str = "\
| experiment | steps | Errdel classical | auto | difference | ratio | Errori classical | auto | difference | ratio |
|---|---:|---:|---:|---:|---:|---:|---:|---:|---:|
";

/// The table in Markdown: means over all settings, the paired difference `auto - classical` with its standard
/// error over the runs, and the ratio of the means.
pub fn table(all: &[Results]) -> String {
    let mut text = HEADER.to_owned();
    for results in all {
        for steps in STEPS {
            if let Some(cells) = row(results, steps) {
                text += &format!("| {} | {steps} | {} |\n", results.experiment.name, cells.join(" | "));
            }
        }
    }
    text
}

/// The cells after the number of steps; `None` if the experiment has no maps there.
fn row(results: &Results, steps: usize) -> Option<Vec<String>> {
    let (paper, auto) = (results.method(MapMethod::PAPER)?, results.method(MapMethod::Auto)?);
    let cells = Measure::BOTH.map(|measure| {
        let [ours, theirs] =
            [auto, paper].map(|method| results.pooled(steps, |sample| sample.maps[method].of(measure)));
        let difference =
            results.pooled(steps, |sample| sample.maps[auto].of(measure) - sample.maps[paper].of(measure));
        (theirs.n > 0).then(|| {
            let error = difference.error.map_or(String::new(), |error| format!(" ± {error:.4}"));
            vec![
                format!("{:.4}", theirs.mean),
                format!("{:.4}", ours.mean),
                format!("{:+.4}{error}", difference.mean),
                format!("{:.2}", ours.mean / theirs.mean),
            ]
        })
    });
    let [delaunay, orientation] = cells;
    Some([delaunay?, orientation?].concat())
}
