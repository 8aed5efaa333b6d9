//! From results to figures like the paper's.
//!
//! Where several settings are compared, colours tell them apart and `auto` is solid, the paper's method dashed;
//! where there is one setting, each method has its colour.

use super::experiment::{MapMethod, Measure, View};
use super::plot::{Dots, Figure, Key, Line, Look, Mark, Panel, XAxis};
use super::results::{CurvePoint, Results};
use super::runner::Sample;
use super::statistics;

/// What runs along an x axis.
type Axis<P> = (&'static str, fn(&P) -> f64);

const BY_STEPS: Axis<CurvePoint> = ("Number of steps", |point| point.steps as f64);
const BY_INFORMATION: Axis<CurvePoint> =
    ("Co-visibility information, pairs seen together", |point| point.information);
const BY_SPREAD: Axis<Sample> = ("Mean nearest-neighbour distance W, m", |sample| sample.spread);
const BY_ENTROPY: Axis<Sample> = ("Entropy of the observation frequency", |sample| sample.entropy);

/// The figure of an experiment.
pub fn figure(results: &Results) -> Figure {
    let panels = match results.experiment.view {
        View::Steps => Measure::BOTH.map(|measure| curves(results, measure, BY_STEPS)).to_vec(),
        View::Information => {
            let by_information = curves(results, Measure::Orientation, BY_INFORMATION);
            vec![
                curves(results, Measure::Orientation, BY_STEPS),
                Panel { x_axis: XAxis::Logarithmic, ..by_information },
            ]
        }
        View::Exploration => [BY_SPREAD, BY_ENTROPY]
            .into_iter()
            .flat_map(|axis| Measure::BOTH.map(|measure| clouds(results, measure, axis)))
            .collect(),
    };
    let numbered = panels
        .into_iter()
        .zip('a'..)
        .map(|(panel, letter)| Panel { title: format!("({letter}) {}", panel.title), ..panel });
    Figure {
        title: format!("{} ({} of the paper)", results.experiment.title, results.experiment.figure),
        panels: numbered.collect(),
        legend: legend(results),
    }
}

fn curves(results: &Results, measure: Measure, (x_label, x): Axis<CurvePoint>) -> Panel {
    let methods = 0..results.experiment.methods.len();
    let both = methods.flat_map(|m| (0..results.experiment.settings.len()).map(move |s| (s, m)));
    let mark = |(setting, method): (usize, usize)| Mark {
        look: look(results, setting, method),
        points: results
            .curve(setting, method)
            .iter()
            .map(|point| [x(point), point.errors[measure as usize].mean])
            .collect(),
    };
    panel(measure, x_label, measure.in_words().to_owned(), both.map(mark).collect())
}

/// A dot a run, and the least-squares line of each method.
fn clouds(results: &Results, measure: Measure, (x_label, x): Axis<Sample>) -> Panel {
    let mut marks = Vec::new();
    let mut title = Vec::new();
    for (m, method) in results.experiment.methods.iter().enumerate() {
        let points: Vec<_> =
            results.samples.iter().map(|sample| [x(sample), sample.maps[m].of(measure)]).collect();
        let look = look(results, 0, m);
        if let Some(line) = statistics::Line::fit(&points) {
            let ends = points.iter().map(|point| point[0]);
            let ends = [ends.clone().fold(f64::INFINITY, f64::min), ends.fold(f64::NEG_INFINITY, f64::max)];
            marks.push(Mark {
                look: Look { dots: Dots::None, ..look },
                points: ends.map(|x| [x, line.at(x)]).to_vec(),
            });
            title.push(format!("{} r = {:+.2}", method.label(), line.correlation));
        }
        marks.push(Mark { look: Look { line: Line::None, ..look }, points });
    }
    let panel = panel(measure, x_label, title.join(", "), marks);
    Panel { x_axis: XAxis::FromData, ..panel }
}

fn panel(measure: Measure, x_label: &'static str, title: String, marks: Vec<Mark>) -> Panel {
    Panel { title, x_label, y_label: measure.name(), x_axis: XAxis::FromZero, marks }
}

fn look(results: &Results, setting: usize, method: usize) -> Look {
    let colour = if results.experiment.settings.len() > 1 { setting } else { method };
    let auto = results.experiment.methods[method] == MapMethod::Auto;
    let (line, dots) = if auto { (Line::Solid, Dots::Filled) } else { (Line::Dashed, Dots::Hollow) };
    Look { colour, line, dots }
}

/// The settings by colour, then the methods by line.
fn legend(results: &Results) -> Vec<Key> {
    /// The last colour of the palette, a grey.
    const NEUTRAL: usize = 6;
    let experiment = &results.experiment;
    let several = experiment.settings.len() > 1;
    let settings = experiment.settings.iter().enumerate().filter(|_| several).map(|(s, setting)| Key {
        text: setting.label.clone(),
        look: Look { colour: s, line: Line::Solid, dots: Dots::None },
    });
    let methods = experiment.methods.iter().enumerate().map(|(m, method)| {
        let look = look(results, 0, m);
        let colour = if several { NEUTRAL } else { look.colour };
        Key { text: method.label().to_owned(), look: Look { colour, ..look } }
    });
    settings.chain(methods).collect()
}
