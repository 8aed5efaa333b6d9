//! The simulation experiments with the parameters of the paper's table III.
//!
//! Where the paper does not say how many layouts were averaged (Sim 3, Sim 7), five are taken as in Sim 2.

use covimap_map::Phi;
use covimap_sim::{Angle, Recognition, SimSpec};

use super::experiment::{Experiment, MapMethod, Setting, View};

/// Side of the room, metres, unless it is what varies.
const SIDE: f64 = 1.5;
/// Steps of a run.
const STEPS: usize = 1000;
/// Least and greatest recognition thresholds of Sim 7-B, degrees.
const THRESHOLD_RANGES: [[f64; 2]; 4] = [[5.0, 5.0], [5.0, 7.0], [4.5, 7.5], [4.0, 8.0]];

/// All simulation experiments, in the paper's order.
pub fn all() -> Vec<Experiment> {
    let families = [sim1_and_2(), sim3_and_4(), sim5_and_6(), sim7()];
    families.into_iter().flatten().collect()
}

fn sim1_and_2() -> Vec<Experiment> {
    let phis = [Phi::Phi1, Phi::Phi2];
    let schemes = phis.map(|phi| [false, true].map(|tic| MapMethod::Classical(phi, tic))).concat();
    vec![
        Experiment {
            layouts: 10,
            methods: [schemes, vec![MapMethod::Auto]].concat(),
            ..curves(
                "sim1",
                "Sim 1: distance functions and constraint",
                "figure 9",
                vec![setting("10 objects", room(10))],
            )
        },
        curves(
            "sim2a",
            "Sim 2-A: number of objects",
            "figure 11",
            [5, 10, 15, 20, 25, 30]
                .map(|objects| setting(format!("{objects} objects"), room(objects)))
                .to_vec(),
        ),
        curves(
            "sim2b",
            "Sim 2-B: size of the room",
            "figure 13",
            [1.0, 1.5, 2.0, 2.5, 3.0]
                .map(|side| setting(format!("{side:.1} m"), SimSpec::paper_room(15, side, STEPS as u64)))
                .to_vec(),
        ),
    ]
}

fn sim3_and_4() -> Vec<Experiment> {
    vec![
        curves(
            "sim3a",
            "Sim 3-A: range of turns",
            "figure 14",
            vary(
                15,
                [0.0, 45.0, 90.0],
                |turn| format!("{turn} deg"),
                |spec, turn| {
                    spec.run.step.turn = Angle::from_deg(turn);
                },
            ),
        ),
        curves(
            "sim3b",
            "Sim 3-B: length of a step",
            "figure 16",
            vary(
                15,
                [50.0, 100.0, 200.0, 300.0],
                |mm| format!("{mm} mm"),
                |spec, mm| {
                    spec.run.step.shortest = mm / 1000.0;
                    spec.run.step.longest = mm / 1000.0;
                },
            ),
        ),
        Experiment {
            layouts: 1,
            walks: 50,
            steps: vec![100],
            view: View::Exploration,
            ..curves(
                "sim4",
                "Sim 4: how the observations are spread",
                "figures 17 and 18",
                vec![setting("10 objects", room(10))],
            )
        },
    ]
}

fn sim5_and_6() -> Vec<Experiment> {
    vec![
        Experiment {
            walks: 5,
            ..curves(
                "sim5a",
                "Sim 5-A: objects not recognised",
                "figure 19",
                vary(
                    15,
                    [0.0, 3.0, 10.0, 20.0],
                    |percent| format!("{percent} %"),
                    |spec, percent| {
                        spec.run.errors.missed = percent / 100.0;
                    },
                ),
            )
        },
        Experiment {
            walks: 5,
            ..curves(
                "sim5b",
                "Sim 5-B: objects taken for others",
                "figure 20",
                vary(
                    15,
                    [0.0, 0.5, 2.0, 10.0],
                    |percent| format!("{percent} %"),
                    |spec, percent| {
                        spec.run.errors.mistaken = percent / 100.0;
                    },
                ),
            )
        },
        Experiment {
            view: View::Information,
            ..curves(
                "sim6",
                "Sim 6: angle of view",
                "figure 21",
                vary(
                    30,
                    [90.0, 120.0, 180.0, 360.0],
                    |view| format!("{view} deg"),
                    |spec, view| {
                        spec.run.sensor.view = Angle::from_deg(view);
                    },
                ),
            )
        },
    ]
}

fn sim7() -> Vec<Experiment> {
    let recognition = |spec: &mut SimSpec, threshold: [f64; 2], steepness| {
        let threshold = threshold.map(Angle::from_deg);
        spec.run.sensor.recognition = Recognition::VisualAngle { threshold, steepness };
    };
    vec![
        curves(
            "sim7a",
            "Sim 7-A: recognition threshold",
            "figure 22",
            vary(
                30,
                [4.0, 5.0, 6.0, 7.0, 8.0],
                |degrees| format!("{degrees} deg"),
                |spec, degrees| {
                    recognition(spec, [degrees; 2], None);
                },
            ),
        ),
        curves(
            "sim7b",
            "Sim 7-B: thresholds that differ between objects",
            "figure 23",
            vary(
                30,
                THRESHOLD_RANGES,
                |[low, high]| format!("{low}-{high} deg"),
                |spec, range| {
                    recognition(spec, range, None);
                },
            ),
        ),
        curves(
            "sim7c",
            "Sim 7-C: steepness of recognition",
            "figure 25",
            vary(
                30,
                [50.0, 100.0, 200.0, f64::INFINITY],
                |steepness| format!("K = {steepness}"),
                |spec, steepness| {
                    recognition(spec, [5.0; 2], steepness.is_finite().then_some(steepness));
                },
            ),
        ),
    ]
}

/// An experiment of five layouts with a walk each, mapped at the paper's steps by its method and by `auto`.
fn curves(
    name: &'static str,
    title: &'static str,
    figure: &'static str,
    settings: Vec<Setting>,
) -> Experiment {
    let hundreds = (1..=STEPS / 100).map(|hundred| 100 * hundred);
    Experiment {
        name,
        title,
        figure,
        settings,
        layouts: 5,
        walks: 1,
        steps: [20, 50].into_iter().chain(hundreds).collect(),
        methods: vec![MapMethod::PAPER, MapMethod::Auto],
        view: View::Steps,
    }
}

fn room(objects: usize) -> SimSpec {
    SimSpec::paper_room(objects, SIDE, STEPS as u64)
}

fn setting(label: impl Into<String>, spec: SimSpec) -> Setting {
    Setting { label: label.into(), spec }
}

/// Settings that change one thing in a room with this many objects.
fn vary<V: Copy, const N: usize>(
    objects: usize,
    values: [V; N],
    label: impl Fn(V) -> String,
    change: impl Fn(&mut SimSpec, V),
) -> Vec<Setting> {
    let changed = |value| {
        let mut spec = room(objects);
        change(&mut spec, value);
        setting(label(value), spec)
    };
    values.map(changed).to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_experiment_has_the_papers_number_of_runs() {
        let runs = |e: &Experiment| (e.name, e.settings.len() as u64 * e.layouts * e.walks);
        let wanted = [
            ("sim1", 10),
            ("sim2a", 30),
            ("sim2b", 25),
            ("sim3a", 15),
            ("sim3b", 20),
            ("sim4", 50),
            ("sim5a", 100),
            ("sim5b", 100),
            ("sim6", 20),
            ("sim7a", 25),
            ("sim7b", 20),
            ("sim7c", 20),
        ];
        assert_eq!(all().iter().map(runs).collect::<Vec<_>>(), wanted);
    }

    #[test]
    fn settings_of_an_experiment_differ() {
        for experiment in all() {
            for (place, setting) in experiment.settings.iter().enumerate() {
                let others = &experiment.settings[..place];
                assert!(
                    others.iter().all(|other| other.label != setting.label && other.spec != setting.spec)
                );
            }
        }
    }
}
