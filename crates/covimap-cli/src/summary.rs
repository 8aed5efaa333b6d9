//! What a person reads about a map.

use std::fmt::Write;

use covimap_embed::DistanceCurve;
use covimap_map::{
    BuildReport, ComponentReport, DistanceReport, FamilyScore, RangeReport, UpdateReport, Warning,
};

use crate::table;

/// IDs shown with a warning.
const EXAMPLES: usize = 10;
/// One row of so many of the Shepard diagram is shown.
const SHEPARD: usize = 4;
/// Components shown, the largest ones.
const COMPONENTS: usize = 10;

/// Size, fit and warnings.
pub fn of(report: &BuildReport) -> String {
    let mut text = format!(
        "{} in {} and {}, {} seen together, from {}",
        counted(report.landmarks, "landmark"),
        counted(report.components.len() as u64, "component"),
        counted(report.regions, "region"),
        counted(report.pairs + report.honesty.set_aside, "pair"),
        counted(report.steps, "step"),
    );
    add(&mut text, format_args!("stress-1 {:.4} ({})", report.stress1, kruskal(report.stress1)));
    if let Some(update) = &report.update {
        add(&mut text, self::update(update));
    }
    if let Some(rate) = report.honesty.misrecognition {
        let aside = counted(report.honesty.set_aside, "pair");
        add(
            &mut text,
            format_args!("about {:.2} % of the sightings misread, {aside} set aside", 100.0 * rate),
        );
    }
    for (component, ranges) in report.components.iter().enumerate().take(COMPONENTS) {
        if let Some(ranges) = &ranges.ranges {
            add(&mut text, self::ranges(component, ranges));
        }
    }
    for warning in &report.warnings {
        add(&mut text, self::warning(warning));
    }
    text
}

/// How much an update has changed.
fn update(update: &UpdateReport) -> String {
    let (steps, fresh) = (counted(update.steps, "new step"), counted(update.landmarks, "new landmark"));
    let mut text = format!("updated with {steps}, {fresh}: ");
    match &update.whole {
        Some(reason) => {
            text += &format!("everything was solved again and laid onto the old map, because {reason}")
        }
        None => {
            text += &format!("{} solved again, the others did not move", counted(update.solved, "landmark"))
        }
    }
    text
}

fn ranges(component: usize, found: &RangeReport) -> String {
    let RangeReport { ranges, steps, scale, scale_error, deviation, outliers } = found;
    format!(
        "component {component} in metres by {} of {}: a map unit is {scale:.4} ± {scale_error:.4} m, ranges are {deviation:.4} m \
         off, {}",
        counted(*ranges, "range"),
        counted(*steps, "step"),
        counted(*outliers, "outlier"),
    )
}

/// The distance function, how it was chosen, and how distances in the map agree with it.
pub fn distances(report: &DistanceReport) -> String {
    let curve = match &report.curve {
        DistanceCurve::Log(log) => format!("log, f = {:.3} exp(-(d / {:.3})^2)", log.nearest, log.length),
        DistanceCurve::Power(power) => {
            format!("power, f = {:.3} exp(-(d / {:.3})^{:.2})", power.nearest, power.length, power.exponent)
        }
        DistanceCurve::Inverse(inverse) => {
            format!("inverse, 1/f = 1/{:.3} + (d / {:.3})^2", inverse.nearest, inverse.length)
        }
        DistanceCurve::Lens(lens) => {
            format!(
                "lens, range {:.3}, seen within it with probability {:.3}",
                lens.range, lens.detectability
            )
        }
        DistanceCurve::Spline(_) => "spline".to_owned(),
        DistanceCurve::Isotonic(_) => "isotonic".to_owned(),
    };
    let mut text = format!("distance function: {curve}, ");
    if report.learnt {
        text += &format!("learnt from {}", counted(report.sample, "pair"));
        let best = report.scores.iter().map(|score| score.held_out).fold(f64::NEG_INFINITY, f64::max);
        let score = |score: &FamilyScore| format!("{} {:.1}", score.family.name(), score.held_out - best);
        let scores: Vec<_> = report.scores.iter().map(score).collect();
        add(&mut text, format_args!("  log-likelihood held out, below the best: {}", scores.join(", ")));
        let (repetition, doubted) = (report.repetition, 100.0 * report.doubted);
        add(&mut text, format_args!("  {repetition:.1} steps tell as much as one independent look"));
        add(
            &mut text,
            format_args!(
                "  {doubted:.1} % of the pairs look farther apart than they are, as if across walls"
            ),
        );
    } else {
        text += "not learnt";
    }
    add(&mut text, table::render(&shepard(report)));
    text
}

/// A few rows of the Shepard diagram.
fn shepard(report: &DistanceReport) -> Vec<Vec<String>> {
    let header = table::row(["frequency", "expected", "map 10 %", "map 50 %", "map 90 %"]);
    let rows = report.shepard.iter().step_by(SHEPARD).map(|row| {
        let numbers = [row.frequency, row.expected, row.distances[0], row.distances[2], row.distances[4]];
        numbers.iter().map(|number| format!("{number:.3}")).collect()
    });
    [header].into_iter().chain(rows).collect()
}

/// A row a component, the largest ones first.
pub fn components(components: &[ComponentReport]) -> String {
    let row = |(number, component): (usize, &ComponentReport)| {
        vec![
            number.to_string(),
            component.landmarks.to_string(),
            component.regions.to_string(),
            component.pairs.to_string(),
            format!("{:.4}", component.stress1),
            component.iterations.to_string(),
            if component.converged { "yes" } else { "no" }.to_owned(),
        ]
    };
    let header =
        table::row(["component", "landmarks", "regions", "pairs", "stress-1", "polish steps", "converged"]);
    let rows: Vec<_> =
        [header].into_iter().chain(components.iter().enumerate().take(COMPONENTS).map(row)).collect();
    let mut text = table::render(&rows);
    if components.len() > COMPONENTS {
        add(&mut text, format_args!("and {} smaller ones", components.len() - COMPONENTS));
    }
    text
}

/// J. B. Kruskal's words for a value of stress-1 (Psychometrika 29, 1964); each holds up to its bound.
pub fn kruskal(stress1: f64) -> &'static str {
    match stress1 {
        s if s <= 0.025 => "excellent",
        s if s <= 0.05 => "good",
        s if s <= 0.1 => "fair",
        _ => "poor",
    }
}

/// `1 landmark`, `2 landmarks`.
pub fn counted(count: u64, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}

fn warning(warning: &Warning) -> String {
    let Warning { kind, count, examples, message } = warning;
    let mut text = format!("warning: {kind} ({count}): {message}");
    if !examples.is_empty() {
        let more = if *count > EXAMPLES.min(examples.len()) as u64 { ", ..." } else { "" };
        let shown: Vec<_> = examples.iter().take(EXAMPLES).map(String::as_str).collect();
        add(&mut text, format_args!("  {}{more}", shown.join(", ")));
    }
    text
}

fn add(text: &mut String, line: impl std::fmt::Display) {
    write!(text, "\n{line}").expect("a string takes all text (bug in covimap)");
}

#[cfg(test)]
mod tests {
    use covimap_map::HonestyReport;

    use super::*;

    #[test]
    fn kruskals_words_hold_up_to_their_bounds() {
        for (stress1, word) in
            [(0.0, "excellent"), (0.025, "excellent"), (0.026, "good"), (0.1, "fair"), (0.101, "poor")]
        {
            assert_eq!(kruskal(stress1), word);
        }
    }

    #[test]
    fn a_report_names_sizes_fit_and_the_first_ids_of_each_warning() {
        let names = (1..=12).map(|number| format!("L{number}")).collect();
        let report = BuildReport {
            steps: 40,
            sightings: 99,
            landmarks: 25,
            pairs: 1,
            honesty: HonestyReport { set_aside: 7, misrecognition: Some(0.0123) },
            regions: 2,
            stress1: 0.031,
            update: None,
            components: Vec::new(),
            warnings: vec![Warning {
                kind: "seen_once".into(),
                count: 20,
                examples: names,
                message: "seen in a single step; log them more often".into(),
            }],
        };
        assert_eq!(
            of(&report),
            "25 landmarks in 0 components and 2 regions, 8 pairs seen together, from 40 steps\n\
             stress-1 0.0310 (good)\n\
             about 1.23 % of the sightings misread, 7 pairs set aside\n\
             warning: seen_once (20): seen in a single step; log them more often\n  \
             L1, L2, L3, L4, L5, L6, L7, L8, L9, L10, ..."
        );
    }

    #[test]
    fn only_the_largest_components_get_a_row() {
        let one = ComponentReport {
            landmarks: 2,
            regions: 1,
            pairs: 1,
            stress1: 0.0,
            iterations: 3,
            converged: false,
            ..ComponentReport::default()
        };
        let text = components(&vec![one; 12]);
        assert_eq!(text.lines().count(), 12);
        assert!(text.ends_with("and 2 smaller ones"), "{text}");
    }
}
