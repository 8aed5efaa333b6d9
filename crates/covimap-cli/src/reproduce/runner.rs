//! Runs an experiment: simulates every log, maps its prefixes with every method, compares with the truth.
//!
//! Runs are independent and go in parallel; a result depends on the experiment and the seed alone. The same layout
//! and walk numbers give the same placing of objects and the same start in every setting, so that settings and
//! methods are compared over the same worlds.

use covimap_map::evaluate::{self, EvaluateParams};
use covimap_map::{GlobalMap, MapError, Mapper, SightingLog, Silent, Truth};
use covimap_sim::{Point, Recording, Simulation, World};
use rayon::prelude::*;

use super::experiment::{Experiment, Measure};
use crate::interrupt;

/// What is known of one run after some of its steps.
#[derive(Debug, Clone, PartialEq)]
pub struct Sample {
    /// Place in the experiment's list of settings.
    pub setting: usize,
    /// Layout and walk: settings that share it share their world.
    pub run: (u64, u64),
    /// Steps mapped.
    pub steps: usize,
    /// Amount of co-visibility information: pairs seen together, summed over the steps, `sum m (m - 1) / 2`.
    pub information: f64,
    /// Mean nearest-neighbour distance `W` of the places of observation, metres, eq. (11).
    pub spread: f64,
    /// Entropy of the shares of the objects in all sightings, eq. (12).
    pub entropy: f64,
    /// The maps, in the order of the experiment's methods.
    pub maps: Vec<Errors>,
}

/// What is wrong with a map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Errors {
    /// Landmarks compared.
    pub landmarks: usize,
    /// Delaunay error.
    pub delaunay: f64,
    /// Triangle-orientation error.
    pub orientation: f64,
}

impl Errors {
    pub fn of(&self, measure: Measure) -> f64 {
        match measure {
            Measure::Delaunay => self.delaunay,
            Measure::Orientation => self.orientation,
        }
    }
}

/// Number of runs of an experiment, over all settings.
pub fn runs(experiment: &Experiment) -> u64 {
    experiment.settings.len() as u64 * experiment.layouts * experiment.walks
}

/// Runs everything; `done` is told of every run that is over.
///
/// # Errors
/// [`MapError::Interrupted`], and errors of simulation and mapping that mean a bug: the experiments are fixed.
pub fn run(experiment: &Experiment, seed: u64, done: &(dyn Fn() + Sync)) -> anyhow::Result<Vec<Sample>> {
    let methods = experiment
        .methods
        .iter()
        .map(|method| Mapper::new(method.params()))
        .collect::<Result<Vec<_>, MapError>>()?;
    let walks =
        (0..experiment.layouts).flat_map(|layout| (0..experiment.walks).map(move |walk| (layout, walk)));
    let jobs: Vec<_> =
        walks.flat_map(|run| (0..experiment.settings.len()).map(move |setting| (setting, run))).collect();
    let samples = jobs
        .into_par_iter()
        .map(|(setting, run)| {
            if interrupt::requested() {
                return Err(MapError::Interrupted.into());
            }
            let samples = one(experiment, setting, run, seed, &methods)?;
            done();
            Ok(samples)
        })
        .collect::<anyhow::Result<Vec<_>>>()?;
    Ok(samples.concat())
}

/// All samples of one log.
fn one(
    experiment: &Experiment,
    setting: usize,
    run: (u64, u64),
    seed: u64,
    methods: &[Mapper],
) -> anyhow::Result<Vec<Sample>> {
    let spec = &experiment.settings[setting].spec;
    let world = World::new(&spec.world, seeds(seed, run).0)?;
    let recording = Simulation::new(&world, &spec.run, seeds(seed, run).1)?.record();
    let truth = truth_of(&world)?;
    let names: Vec<_> = truth.names().iter().collect();
    let mut samples = Vec::with_capacity(experiment.steps.len());
    for &steps in &experiment.steps {
        let prefix = || recording.steps().take(steps);
        let log = SightingLog::from_steps(prefix().map(|step| step.seen.iter().map(|&k| names[k as usize])));
        let maps =
            methods.iter().map(|mapper| errors(mapper, &log, &truth)).collect::<Result<Vec<_>, _>>()?;
        // Either all methods are compared on a log or none is.
        if let Some(maps) = maps.into_iter().collect() {
            samples.push(Sample {
                setting,
                run,
                steps,
                information: prefix().map(|step| pairs(step.seen.len())).sum(),
                spread: mean_nearest_distance(&places(&recording, steps)),
                entropy: entropy(&log),
                maps,
            });
        }
    }
    Ok(samples)
}

/// Seeds of world and walk. Experiments with the same layout number and world settings share the world.
fn seeds(seed: u64, (layout, walk): (u64, u64)) -> (u64, u64) {
    let world = (seed << 32) + layout;
    (world, world + ((walk + 1) << 16))
}

/// The errors of a map, or `None` where the log is too short to give one that can be judged: no two objects
/// seen together yet, all always together, or no three that hang together.
fn errors(mapper: &Mapper, log: &SightingLog, truth: &Truth) -> Result<Option<Errors>, MapError> {
    let found = mapper
        .build(log, &Silent)
        .and_then(|map: GlobalMap| evaluate::against(&map, truth, &EvaluateParams::default()));
    match found {
        Ok(found) => Ok(found.orientation_error.map(|orientation| Errors {
            landmarks: found.n,
            delaunay: found.delaunay_error,
            orientation,
        })),
        Err(
            MapError::NothingTogether { .. } | MapError::NoInformation { .. } | MapError::TooFewCommon { .. },
        ) => Ok(None),
        Err(error) => Err(error),
    }
}

fn truth_of(world: &World) -> Result<Truth, MapError> {
    let mut text = Vec::new();
    covimap_sim::write_truth(world, &mut text).expect("memory takes every byte (bug in covimap)");
    Truth::parse(&text, "truth")
}

fn pairs(seen: usize) -> f64 {
    (seen * seen.saturating_sub(1) / 2) as f64
}

fn places(recording: &Recording, steps: usize) -> Vec<Point> {
    recording.steps().take(steps).map(|step| step.pose.at).collect()
}

/// Eq. (11); 0 for fewer than two places. `O(n^2)`.
fn mean_nearest_distance(places: &[Point]) -> f64 {
    if places.len() < 2 {
        return 0.0;
    }
    let nearest = |i: usize| {
        let others = places.iter().enumerate().filter(|&(j, _)| j != i);
        let distance = |(_, b): (usize, &Point)| (places[i][0] - b[0]).hypot(places[i][1] - b[1]);
        others.map(distance).fold(f64::INFINITY, f64::min)
    };
    (0..places.len()).map(nearest).sum::<f64>() / places.len() as f64
}

/// Eq. (12), natural logarithm; objects never seen add nothing.
fn entropy(log: &SightingLog) -> f64 {
    let mut counts = vec![0u32; log.names().len()];
    log.iter().flatten().for_each(|&landmark| counts[landmark as usize] += 1);
    let share = |count: u32| f64::from(count) / log.sightings() as f64;
    -counts.into_iter().map(share).map(|p| p * p.ln()).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reproduce::experiment::MapMethod;

    #[test]
    fn the_spread_is_the_mean_distance_to_the_nearest_other_place() {
        // On a line at 0, 1 and 3: 1, 1 and 2.
        let spread = mean_nearest_distance(&[[0.0, 0.0], [0.0, 1.0], [0.0, 3.0]]);
        assert!((spread - 4.0 / 3.0).abs() < 1e-15);
        assert_eq!(mean_nearest_distance(&[[1.0, 1.0]]).to_bits(), 0);
        assert_eq!(mean_nearest_distance(&[[1.0, 1.0], [1.0, 1.0]]).to_bits(), 0);
    }

    #[test]
    fn the_entropy_is_that_of_the_shares_of_all_sightings() {
        // Shares 1/2, 1/4, 1/4: ln 2 / 2 + 2 ln 4 / 4 = 1.5 ln 2.
        let log = SightingLog::from_steps([vec!["A", "B"], vec!["A", "C"], vec![]]);
        assert!((entropy(&log) - 1.5 * 2f64.ln()).abs() < 1e-15);
        assert!(entropy(&SightingLog::from_steps([["A"], ["A"]])).abs() < 1e-15);
    }

    #[test]
    fn pairs_of_a_list() {
        assert_eq!([0, 1, 2, 5].map(pairs), [0.0, 0.0, 1.0, 10.0]);
    }

    #[test]
    fn every_run_of_a_layout_has_its_own_way_through_the_same_world() {
        assert_eq!(seeds(1, (2, 0)).0, seeds(1, (2, 4)).0);
        let mut all: Vec<_> = (0..3)
            .flat_map(|seed| {
                (0..5).flat_map(move |layout| (0..5).map(move |walk| seeds(seed, (layout, walk)).1))
            })
            .collect();
        all.sort_unstable();
        all.dedup();
        assert_eq!(all.len(), 75);
    }

    #[test]
    fn a_log_that_shows_no_two_objects_together_has_no_errors() {
        let truth = Truth::parse(b"id,x,y\nA,0,0\nB,1,0\nC,0,1\n", "truth").unwrap();
        let mapper = Mapper::new(MapMethod::PAPER.params()).unwrap();
        let errors =
            |steps: &[&[&str]]| errors(&mapper, &SightingLog::from_steps(steps.to_vec()), &truth).unwrap();
        assert_eq!(errors(&[&["A"], &["B"], &["C"]]), None);
        assert_eq!(errors(&[&["A", "B"], &["C"]]), None);
        assert_eq!(errors(&[&["A", "B", "C"]]), None);
        let three = errors(&[&["A", "B"], &["A", "C"], &["A", "B", "C"]]);
        assert_eq!(three, Some(Errors { landmarks: 3, delaunay: 0.0, orientation: 0.0 }));
    }
}
