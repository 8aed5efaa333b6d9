//! What the paper says of its simulations, beside what comes out here.

use super::experiment::{MapMethod, Measure};
use super::results::{CurvePoint, Results};
use super::runner::Sample;
use super::statistics::{Line, Mean};

use Measure::{Delaunay, Orientation};

/// A statement of the paper and the number that it is about.
struct Claim {
    experiment: &'static str,
    statement: &'static str,
    /// The paper's figure or finding.
    paper: &'static str,
    quantity: Quantity,
}

/// A number that can be taken from results, for one method.
enum Quantity {
    /// Both mean errors of a setting.
    Errors { setting: &'static str, steps: usize },
    /// Mean error of one setting less that of another, run by run, in points (hundredths).
    Difference { of: &'static str, minus: &'static str, steps: usize, measure: Measure },
    /// Mean errors of all settings, the best one first.
    Ranking { steps: usize, measure: Measure },
    /// Mean errors of all methods, the best one first.
    Methods { steps: usize, measure: Measure },
    /// Errors of all settings when they have the same co-visibility information: as much as the poorest ends with.
    AtInformation { measure: Measure },
    /// Correlation over the runs.
    Correlation { with: Exploration, measure: Measure },
}

/// How well a run explored.
#[derive(Clone, Copy)]
enum Exploration {
    /// `W`, eq. (11).
    Spread,
    /// `Ent`, eq. (12).
    Entropy,
}

impl Exploration {
    fn of(self, sample: &Sample) -> f64 {
        match self {
            Self::Spread => sample.spread,
            Self::Entropy => sample.entropy,
        }
    }
}

const fn claim(
    experiment: &'static str,
    statement: &'static str,
    paper: &'static str,
    quantity: Quantity,
) -> Claim {
    Claim { experiment, statement, paper, quantity }
}

const fn ranking(steps: usize, measure: Measure) -> Quantity {
    Quantity::Ranking { steps, measure }
}

const fn difference(of: &'static str, minus: &'static str, steps: usize, measure: Measure) -> Quantity {
    Quantity::Difference { of, minus, steps, measure }
}

const fn correlation(with: Exploration, measure: Measure) -> Quantity {
    Quantity::Correlation { with, measure }
}

const CLAIMS: [Claim; 35] = [
    claim(
        "sim1",
        "methods, Errdel, 1000 steps",
        "phi2 + TIC (`classical`) best; TIC matters little with phi1",
        Quantity::Methods { steps: 1000, measure: Delaunay },
    ),
    claim(
        "sim1",
        "methods, Errori, 1000 steps",
        "phi2 + TIC (`classical`) best; TIC matters little with phi1",
        Quantity::Methods { steps: 1000, measure: Orientation },
    ),
    claim(
        "sim2a",
        "30 objects, 500 steps, Errdel / Errori",
        ".083 / .024 (one layout)",
        Quantity::Errors { setting: "30 objects", steps: 500 },
    ),
    claim(
        "sim2a",
        "objects, Errdel, 1000 steps",
        "tends to grow with their number, but not much",
        ranking(1000, Delaunay),
    ),
    claim(
        "sim2a",
        "objects, Errori, 1000 steps",
        "little difference from 10 to 30",
        ranking(1000, Orientation),
    ),
    claim("sim2b", "rooms, Errdel, 1000 steps", "larger is worse, but 1.0 m too", ranking(1000, Delaunay)),
    claim("sim2b", "rooms, Errori, 1000 steps", "larger is worse, but 1.0 m too", ranking(1000, Orientation)),
    claim(
        "sim2b",
        "1.0 m less 1.5 m, Errdel, 1000 steps",
        "positive: the small room is crowded",
        difference("1.0 m", "1.5 m", 1000, Delaunay),
    ),
    claim(
        "sim2b",
        "1.0 m less 1.5 m, Errori, 1000 steps",
        "positive: the small room is crowded",
        difference("1.0 m", "1.5 m", 1000, Orientation),
    ),
    claim("sim3a", "turns, Errdel, 50 steps", "0 deg best from 50 to 100 steps", ranking(50, Delaunay)),
    claim("sim3a", "turns, Errori, 50 steps", "0 deg best from 50 to 100 steps", ranking(50, Orientation)),
    claim("sim3a", "turns, Errdel, 100 steps", "0 deg best from 50 to 100 steps", ranking(100, Delaunay)),
    claim("sim3a", "turns, Errori, 100 steps", "0 deg best from 50 to 100 steps", ranking(100, Orientation)),
    claim(
        "sim3a",
        "turns, Errdel, 1000 steps",
        "45 deg best, 90 deg as good, 0 deg worst",
        ranking(1000, Delaunay),
    ),
    claim(
        "sim3a",
        "turns, Errori, 1000 steps",
        "45 deg best, 90 deg as good, 0 deg worst",
        ranking(1000, Orientation),
    ),
    claim("sim3b", "step lengths, Errori, 50 steps", "200 and 300 mm better", ranking(50, Orientation)),
    claim("sim3b", "step lengths, Errori, 1000 steps", "about equal", ranking(1000, Orientation)),
    claim("sim4", "correlation of Errdel and W", "negative", correlation(Exploration::Spread, Delaunay)),
    claim("sim4", "correlation of Errori and W", "negative", correlation(Exploration::Spread, Orientation)),
    claim("sim4", "correlation of Errdel and Ent", "-0.720", correlation(Exploration::Entropy, Delaunay)),
    claim(
        "sim4",
        "correlation of Errori and Ent",
        "negative",
        correlation(Exploration::Entropy, Orientation),
    ),
    claim(
        "sim5a",
        "20 % not recognised less none, Errori, 100 steps",
        "positive: clearly more early on",
        difference("20 %", "0 %", 100, Orientation),
    ),
    claim(
        "sim5a",
        "20 % not recognised less none, Errori, 1000 steps",
        "+1.80 points",
        difference("20 %", "0 %", 1000, Orientation),
    ),
    claim(
        "sim5b",
        "10 % taken for others less none, Errori, 1000 steps",
        "+3.40 points",
        difference("10 %", "0 %", 1000, Orientation),
    ),
    claim(
        "sim5b",
        "2 % taken for others less none, Errori, 1000 steps",
        "+0.28 points",
        difference("2 %", "0 %", 1000, Orientation),
    ),
    claim("sim6", "views, Errori, 100 steps", "wider is better", ranking(100, Orientation)),
    claim("sim6", "views, Errori, 1000 steps", "wider is better", ranking(1000, Orientation)),
    claim(
        "sim6",
        "views, Errori, same information",
        "all on one curve",
        Quantity::AtInformation { measure: Orientation },
    ),
    claim("sim7a", "thresholds, Errori, 20 steps", "smaller is better", ranking(20, Orientation)),
    claim(
        "sim7a",
        "thresholds, Errori, 1000 steps",
        "6 deg best, little difference",
        ranking(1000, Orientation),
    ),
    claim(
        "sim7b",
        "thresholds, Errori, 1000 steps",
        "wider range is a little worse",
        ranking(1000, Orientation),
    ),
    claim(
        "sim7b",
        "4-8 deg less 5-5 deg, Errori, 1000 steps",
        "positive, small",
        difference("4-8 deg", "5-5 deg", 1000, Orientation),
    ),
    claim("sim7c", "steepness, Errori, 100 steps", "no great difference", ranking(100, Orientation)),
    claim("sim7c", "steepness, Errori, 1000 steps", "no great difference", ranking(1000, Orientation)),
    claim(
        "sim7c",
        "K = 50 less sharp, Errori, 1000 steps",
        "no great difference if K is not too small",
        difference("K = 50", "K = inf", 1000, Orientation),
    ),
];

const HEADER: &str = "\
| experiment | what | paper | classical here | auto |
|---|---|---|---|---|
";

/// The table in Markdown, of the claims about these experiments.
pub fn table(all: &[Results]) -> String {
    let mut text = HEADER.to_owned();
    for Claim { experiment, statement, paper, quantity } in &CLAIMS {
        let Some(results) = all.iter().find(|results| results.experiment.name == *experiment) else {
            continue;
        };
        let [classical, auto] = [MapMethod::PAPER, MapMethod::Auto]
            .map(|method| quantity.of(results, method).unwrap_or("-".into()));
        text += &format!("| {experiment} | {statement} | {paper} | {classical} | {auto} |\n");
    }
    text
}

impl Quantity {
    /// The number in words; `None` if the experiment has been cut too short for it.
    fn of(&self, results: &Results, method: MapMethod) -> Option<String> {
        let place = results.method(method)?;
        match *self {
            Self::Errors { setting, steps } => {
                let setting = results.setting(setting)?;
                let means = Measure::BOTH.map(|measure| results.mean(setting, place, steps, measure));
                let texts = means.map(|mean| (mean.n > 0).then(|| with_error(mean, 1.0, 3)));
                Some(format!("{} / {}", texts[0].as_ref()?, texts[1].as_ref()?))
            }
            Self::Difference { of, minus, steps, measure } => {
                let cells = [(results.setting(of)?, place), (results.setting(minus)?, place)];
                let mean = results.difference(cells[0], cells[1], steps, measure);
                (mean.n > 0).then(|| format!("{} points", with_error(mean, 100.0, 2)))
            }
            Self::Ranking { steps, measure } => {
                let labels = results.experiment.settings.iter().map(|setting| setting.label.as_str());
                let means =
                    labels.enumerate().map(|(s, label)| (label, results.mean(s, place, steps, measure).mean));
                ranked(means)
            }
            Self::Methods { steps, measure } => {
                let of_paper = |&(_, method): &(usize, &MapMethod)| *method != MapMethod::Auto;
                let all = results.experiment.methods.iter().enumerate();
                let column = all.filter(|entry| of_paper(entry) == (method != MapMethod::Auto));
                ranked(column.map(|(m, method)| (method.label(), results.mean(0, m, steps, measure).mean)))
            }
            Self::AtInformation { measure } => at_same_information(results, place, measure),
            Self::Correlation { with, measure } => {
                let point = |sample: &Sample| [with.of(sample), sample.maps[place].of(measure)];
                let line = Line::fit(&results.samples.iter().map(point).collect::<Vec<_>>())?;
                Some(format!("{:+.3}", line.correlation))
            }
        }
    }
}

fn with_error(mean: Mean, scale: f64, digits: usize) -> String {
    let value = scale * mean.mean;
    match mean.error {
        Some(error) => format!("{value:.digits$} ± {:.digits$}", scale * error),
        None => format!("{value:.digits$}"),
    }
}

/// Names with their errors, the least first; names without an error are left out.
fn ranked<'a>(errors: impl Iterator<Item = (&'a str, f64)>) -> Option<String> {
    let mut known: Vec<_> = errors.filter(|(_, error)| error.is_finite()).collect();
    known.sort_by(|a, b| a.1.total_cmp(&b.1));
    let texts: Vec<_> = known.iter().map(|(name, error)| format!("{name} {error:.4}")).collect();
    (!texts.is_empty()).then(|| texts.join(", "))
}

/// The errors of all settings at the information that the poorest setting ends with.
fn at_same_information(results: &Results, method: usize, measure: Measure) -> Option<String> {
    let curves: Vec<_> = (0..results.experiment.settings.len()).map(|s| results.curve(s, method)).collect();
    let ends = curves.iter().filter_map(|curve| Some(curve.last()?.information));
    let information = ends.fold(f64::INFINITY, f64::min);
    let labels = results.experiment.settings.iter().map(|setting| setting.label.as_str());
    let errors = curves.iter().map(|curve| interpolated(curve, information, measure).unwrap_or(f64::NAN));
    Some(format!("{information:.0} pairs: {}", ranked(labels.zip(errors))?))
}

/// The error at this information, on a straight line over its logarithm between the two points around it.
fn interpolated(curve: &[CurvePoint], information: f64, measure: Measure) -> Option<f64> {
    let after = curve.partition_point(|point| point.information < information);
    let error = |point: &CurvePoint| point.errors[measure as usize].mean;
    let end = curve.get(after)?;
    let Some(start) = after.checked_sub(1).map(|before| &curve[before]) else {
        return (end.information <= information).then(|| error(end));
    };
    let share = (information / start.information).ln() / (end.information / start.information).ln();
    Some(error(start) + share * (error(end) - error(start)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reproduce::catalogue;
    use crate::reproduce::experiment::Experiment;
    use crate::reproduce::runner::Errors;

    /// Two settings, two runs; at 1000 steps the errors of `classical` are .1 and .3 in the first setting, .2 and
    /// .5 in the second; `auto` makes half of that.
    fn results() -> Results {
        let catalogue = catalogue::all();
        let mut experiment: Experiment = catalogue.into_iter().find(|e| e.name == "sim6").unwrap();
        experiment.settings.truncate(2);
        let sample = |setting, walk, steps, error: f64| Sample {
            setting,
            run: (0, walk),
            steps,
            information: steps as f64 * if setting == 0 { 1.0 } else { 10.0 },
            spread: error,
            entropy: -error,
            maps: [error, error / 2.0]
                .map(|error| Errors { landmarks: 5, delaunay: error, orientation: error })
                .to_vec(),
        };
        let samples = vec![
            sample(0, 0, 1000, 0.1),
            sample(0, 1, 1000, 0.3),
            sample(1, 0, 1000, 0.2),
            sample(1, 1, 1000, 0.5),
            sample(1, 0, 100, 0.6),
        ];
        Results { experiment, samples }
    }

    fn found(quantity: &Quantity, method: MapMethod) -> Option<String> {
        quantity.of(&results(), method)
    }

    #[test]
    fn quantities_by_hand() {
        let [first, second] = ["90 deg", "120 deg"];
        // Runs .1 and .3: mean .2, standard error .1.
        let errors = Quantity::Errors { setting: first, steps: 1000 };
        assert_eq!(found(&errors, MapMethod::PAPER).unwrap(), "0.200 ± 0.100 / 0.200 ± 0.100");
        // Differences .1 and .2 run by run: mean .15, standard error .05.
        let more = difference(second, first, 1000, Delaunay);
        assert_eq!(found(&more, MapMethod::PAPER).unwrap(), "15.00 ± 5.00 points");
        assert_eq!(found(&more, MapMethod::Auto).unwrap(), "7.50 ± 2.50 points");
        assert_eq!(
            found(&ranking(1000, Delaunay), MapMethod::PAPER).unwrap(),
            "90 deg 0.2000, 120 deg 0.3500"
        );
        // At 1000 pairs the second setting has .6 after 100 steps, the first .2 after 1000.
        let level = Quantity::AtInformation { measure: Orientation };
        assert_eq!(found(&level, MapMethod::PAPER).unwrap(), "1000 pairs: 90 deg 0.2000, 120 deg 0.6000");
        let falling = correlation(Exploration::Entropy, Delaunay);
        assert_eq!(found(&falling, MapMethod::Auto).unwrap(), "-1.000");
        let methods = Quantity::Methods { steps: 1000, measure: Delaunay };
        assert_eq!(found(&methods, MapMethod::Auto).unwrap(), "auto 0.1000");
    }

    #[test]
    fn what_was_not_run_has_no_value() {
        assert_eq!(found(&ranking(300, Delaunay), MapMethod::PAPER), None);
        assert_eq!(found(&difference("90 deg", "120 deg", 100, Delaunay), MapMethod::PAPER), None);
        assert_eq!(found(&difference("90 deg", "3 deg", 1000, Delaunay), MapMethod::PAPER), None);
        assert_eq!(found(&ranking(1000, Delaunay), MapMethod::Classical(covimap_map::Phi::Phi1, true)), None);
    }

    #[test]
    fn every_claim_is_about_settings_and_steps_that_are_run() {
        let catalogue = catalogue::all();
        for Claim { experiment, statement, quantity, .. } in &CLAIMS {
            let experiment = catalogue.iter().find(|known| known.name == *experiment).unwrap();
            let known = |label: &str| experiment.settings.iter().any(|setting| setting.label == label);
            let run = |steps: &usize| experiment.steps.contains(steps);
            let fine = match quantity {
                Quantity::Errors { setting, steps } => known(setting) && run(steps),
                Quantity::Difference { of, minus, steps, .. } => known(of) && known(minus) && run(steps),
                Quantity::Ranking { steps, .. } | Quantity::Methods { steps, .. } => run(steps),
                Quantity::AtInformation { .. } | Quantity::Correlation { .. } => true,
            };
            assert!(fine, "{} {statement}", experiment.name);
        }
    }
}
