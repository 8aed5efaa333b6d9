//! How much better `auto` is than the paper's method, over the same logs.

use super::experiment::{MapMethod, Measure};
use super::results::Results;
use super::statistics::Mean;

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

const WORSE_HEADER: &str = "\
| experiment | setting | steps | error | classical | auto | difference | beyond 2 standard errors |
|---|---|---:|---|---:|---:|---:|---|
";

/// A setting after so many steps, by one measure, over all runs.
struct Cell {
    /// `experiment | setting | steps | error`.
    name: String,
    /// Mean errors of the paper's method and of `auto`.
    means: [f64; 2],
    /// `auto` less the paper's method, run by run.
    difference: Mean,
}

impl Cell {
    /// Whether the mean of `auto` is the greater one.
    fn worse(&self) -> bool {
        self.difference.mean > 0.0
    }

    fn row(&self) -> String {
        let Self { name, means: [classical, auto], difference } = self;
        let error = difference.error.map_or(String::new(), |error| format!(" ± {error:.4}"));
        let beyond = match difference.error {
            Some(error) if difference.mean > 2.0 * error => "yes",
            Some(_) => "no",
            None => "-",
        };
        format!("| {name} | {classical:.4} | {auto:.4} | {:+.4}{error} | {beyond} |\n", difference.mean)
    }
}

/// What is not better everywhere: how many cells there are, and a table in Markdown of those where the mean of
/// `auto` is above that of the paper's method.
pub fn worse(all: &[Results]) -> String {
    let cells: Vec<_> = all.iter().flat_map(cells).collect();
    let worse: Vec<_> = cells.iter().filter(|cell| cell.worse()).collect();
    let count = format!("{} of {} cells.\n", worse.len(), cells.len());
    if worse.is_empty() {
        return count;
    }
    format!("{count}\n{WORSE_HEADER}{}", worse.iter().map(|cell| cell.row()).collect::<String>())
}

/// The cells of an experiment that have maps.
fn cells(results: &Results) -> Vec<Cell> {
    let places = [MapMethod::PAPER, MapMethod::Auto].map(|method| results.method(method));
    let [Some(paper), Some(auto)] = places else { return Vec::new() };
    let mut cells = Vec::new();
    for (s, setting) in results.experiment.settings.iter().enumerate() {
        for steps in STEPS {
            for measure in Measure::BOTH {
                let difference = results.difference((s, auto), (s, paper), steps, measure);
                if difference.n > 0 {
                    let parts = [results.experiment.name, &setting.label, &steps.to_string(), measure.name()];
                    let means = [paper, auto].map(|method| results.mean(s, method, steps, measure).mean);
                    cells.push(Cell { name: parts.join(" | "), means, difference });
                }
            }
        }
    }
    cells
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reproduce::catalogue;
    use crate::reproduce::runner::{Errors, Sample};

    /// One setting, two runs at 100 steps: Errdel of `auto` is .125 and .375 above the paper's method, Errori below.
    fn results() -> Results {
        let mut experiment = catalogue::all().into_iter().find(|e| e.name == "sim6").unwrap();
        experiment.settings.truncate(1);
        let errors = |delaunay, orientation| Errors { landmarks: 5, delaunay, orientation };
        let sample = |walk, more: f64| Sample {
            setting: 0,
            run: (0, walk),
            steps: 100,
            information: 1.0,
            spread: 1.0,
            entropy: 1.0,
            maps: vec![errors(0.25, 0.25), errors(0.25 + more, 0.15)],
        };
        Results { experiment, samples: vec![sample(0, 0.125), sample(1, 0.375)] }
    }

    #[test]
    fn cells_where_auto_is_worse_are_listed() {
        // Differences .125 and .375: mean .25, standard error .125; not beyond 2 of them.
        let text = worse(&[results()]);
        assert!(text.starts_with("1 of 2 cells.\n\n| experiment"), "{text}");
        let row = "| sim6 | 90 deg | 100 | Errdel | 0.2500 | 0.5000 | +0.2500 ± 0.1250 | no |\n";
        assert!(text.ends_with(row), "{text}");
        let mut clearer = results();
        clearer.samples[1].maps[1].delaunay = 0.5;
        // Differences .125 and .25: mean .1875, standard error .0625.
        assert!(worse(&[clearer]).ends_with("+0.1875 ± 0.0625 | yes |\n"));
    }

    #[test]
    fn nothing_is_listed_where_nothing_is_worse() {
        let mut better = results();
        better.samples.iter_mut().for_each(|sample| sample.maps[1].delaunay = 0.25);
        assert_eq!(worse(&[better]), "0 of 2 cells.\n");
        assert_eq!(worse(&[]), "0 of 0 cells.\n");
    }
}
