//! `summary.md`: what was run, the paper's claims beside the results, and how the two methods compare.

use super::robot::Trial;
use super::{accuracy, claims, experiment::Experiment, results::Results};

/// The text of the summary.
pub fn text(all: &[Results], trial: Option<&Trial>) -> String {
    let mut text = "# The experiments of the paper\n".to_owned();
    if !all.is_empty() {
        text += &format!("\n{}", experiments(all));
        text += &format!(
            "\n## What the paper says, and what comes out here\n\n{CLAIMS_NOTE}\n{}",
            claims::table(all)
        );
        text +=
            &format!("\n## `auto` against the paper's method\n\n{ACCURACY_NOTE}\n{}", accuracy::table(all));
        text += &format!("\n### Where `auto` is not better\n\n{WORSE_NOTE}\n{}", accuracy::worse(all));
    }
    if let Some(trial) = trial {
        text += &format!("\n## The real robot\n\n{TRIAL_NOTE}\n{}", trial.table());
    }
    text
}

const CLAIMS_NOTE: &str = "\
Means over the runs ± one standard error; lists begin with the least error. \"Less\" is the difference of two
settings over the same layouts and walks; a point is a hundredth.
";

const ACCURACY_NOTE: &str = "\
Means over all settings and runs of an experiment, both methods over the same logs. The difference is `auto`
less `classical`, run by run, ± its standard error over the runs; the ratio is that of the means.
";

const WORSE_NOTE: &str = "\
Cells are the settings of all experiments, each after 100, 300 and 1000 steps and by both errors. Listed are those
where the mean of `auto` is above that of the paper's method; the difference is as before, of this setting alone.
";

const TRIAL_NOTE: &str = "\
Ten lists of trial 1 (table V a). The positions of the cylinders were not published; positions are in map units,
each map in a frame of its own. Pictures: `exp-classical.svg`, `exp-auto.svg`.
";

fn experiments(all: &[Results]) -> String {
    let mut text = "\
| experiment | what | figure | layouts x walks | logs | maps | files |
|---|---|---|---|---:|---:|---|
"
    .to_owned();
    for Results { experiment, samples } in all {
        let Experiment { name, title, figure, layouts, walks, settings, methods, .. } = experiment;
        let logs = settings.len() as u64 * layouts * walks;
        let maps = samples.len() * methods.len();
        text += &format!(
            "| {name} | {title} | {figure} | {layouts} x {walks} | {logs} | {maps} | `{name}.csv`, `{name}.svg` |\n"
        );
    }
    text
}
