//! What the log says of landmarks whose places are settled: how often each is missed, how well its
//! place is known, and how many sightings are false.

use covimap_embed::Point;

use super::posterior::{Neighbours, Posterior, Step, Witness, Workspace};
use super::sensor::Sensor;
use super::{Model, SENSOR_SETS, SENSOR_STEPS, SeenSets, fit_sensor, landmark_scores, sensor_scores};
use crate::{LinkGraph, MapError, Observer};

/// Sets for every landmark that detectability and deviation are read off: with eight sightings a set,
/// some eighty sightings each.
const SETS_PER_LANDMARK: usize = 10;

/// The sensor as it is after the last landmark was placed.
pub(crate) struct Observed {
    pub sensor: Sensor,
    /// Share of the sightings that are false.
    pub outliers: f64,
    /// Probability of being seen from close by, one a landmark.
    pub detectability: Vec<f64>,
    /// Standard deviation of a coordinate of each landmark against its neighbours.
    pub deviation: Vec<f64>,
}

/// How many sets [`observe`] looks at.
pub(crate) fn sets_observed(sets: &SeenSets, landmarks: usize) -> usize {
    sets.sampled(SETS_PER_LANDMARK * landmarks)
}

/// Fits the sensor to the final positions of a connected graph of at least three landmarks. The observer is told of the
/// sets, [`sets_observed`].
pub(crate) fn observe(
    graph: &LinkGraph,
    sets: &SeenSets,
    points: &[Point],
    observer: &dyn Observer,
) -> Result<Observed, MapError> {
    let sets = &sets.sample(SETS_PER_LANDMARK * points.len());
    let neighbours = &Neighbours::new(graph);
    let mut model = fit_sensor(graph, neighbours, sets, points.to_vec());
    let scores = landmark_scores(neighbours, sets, &model, |sets| observer.advanced(sets), observer)?;
    for (p, scores) in model.detectability.iter_mut().zip(&scores) {
        *p = scores.improved_detectability(*p, model.sensor.detectability);
    }
    for _ in 0..SENSOR_STEPS {
        model.sensor = sensor_scores(neighbours, sets, &model).improve(model.sensor, true);
    }
    let range = model.sensor.range;
    Ok(Observed {
        sensor: model.sensor,
        outliers: outliers(neighbours, sets, &model),
        deviation: scores.iter().map(|scores| scores.deviation(range)).collect(),
        detectability: model.detectability,
    })
}

/// Share of the sightings that the sensor cannot explain: those of which it is more likely than not that
/// they are false. One more is counted as if it were half false, for a share of zero is never certain.
fn outliers(neighbours: &Neighbours, sets: &SeenSets, model: &Model) -> f64 {
    let posterior = Posterior::new(neighbours, model);
    let mut workspace = Workspace::new(neighbours.landmarks());
    let (mut sightings, mut falsely) = (0.0, 0.0);
    for set in (0..sets.len()).step_by(sets.len().div_ceil(SENSOR_SETS).max(1)) {
        let seen = sets.seen(set);
        let step = posterior.of(seen, &mut workspace);
        let is_explained = |witness: &&Witness| witness.seen && truly(&posterior, &step, witness) > 0.5;
        let explained = step.witnesses.iter().filter(is_explained).count();
        sightings += sets.times(set) * seen.len() as f64;
        falsely += sets.times(set) * (seen.len() - explained) as f64;
    }
    (falsely + 0.5) / (sightings + 1.0)
}

/// Probability that a sighting is a true one, over the places of its step.
fn truly(posterior: &Posterior, step: &Step, witness: &Witness) -> f32 {
    let false_sighting = posterior.sight().false_sighting;
    let mut truly = 0.0;
    for row in step.rows.clone() {
        let visibility = posterior.sight().visibility(witness.cutting, row);
        for (&v, &weight) in visibility.iter().zip(&step.places[row]) {
            let by_sight = (witness.detectability - false_sighting) * v;
            let falsely = false_sighting * (1.0 - v) / (false_sighting + by_sight);
            truly += weight * (1.0 - falsely);
        }
    }
    truly
}
