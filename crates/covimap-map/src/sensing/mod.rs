//! What a map knows of the sensor that made its log: from where, how often and how reliably each
//! landmark is seen, and how well its own place is known.
//!
//! A landmark `i` is seen from a place `y` in open sight with probability
//!
//! `P_i(y) = p_i v(|y - x_i|)`, `v(d) = 1 / (1 + exp((d - R) / s))`  (1)
//!
//! with a range `R` and an edge `s` of the whole chart and a detectability `p_i` of its own. A share
//! of all sightings is false and may name any landmark. Pairs that stand near each other and yet are hardly
//! ever seen together are *occluded* from each other: something, a wall as a rule, stands between them. From
//! where one of them is seen, not seeing the other says nothing.

pub(crate) mod occlusion;
mod warp;

use covimap_embed::Point;

use crate::places::{SeenSets, observe, sets_observed};
use crate::{CoVisibility, LandmarkId, LinkGraph, MapError, Observer, PlacedLandmark, Stage};

/// The sensor of one component, lengths in map units.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct SensorModel {
    /// Distance `R` at which the chance to be seen is half that of close by, `> 0`.
    pub range: f64,
    /// Width `s` of the soft edge, `> 0`: from `R - 2 s` to `R + 2 s` the chance falls from 88 to 12 %.
    pub edge: f64,
    /// Chance to be seen from close by of a landmark of which nothing else is known, in `(0, 1)`.
    pub detectability: f64,
    /// Share of the sightings that are false, in `(0, 1)`.
    pub outliers: f64,
}

/// What is known of one landmark, lengths in map units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sensed {
    /// Chance to be seen from close by, by which [`SensorModel::visibility`] is multiplied, in `(0, 1)`.
    pub detectability: f64,
    /// Standard deviation of a coordinate against the landmarks around it, `> 0`. What bends the chart as a whole is
    /// not in it.
    pub deviation: f64,
    /// Standard deviation of a coordinate, `>= 0`, by which the chart as a whole is bent here: about the same for
    /// neighbours, and so without effect on what lies where among them. 0 in files that do not tell.
    pub warp: f64,
}

impl SensorModel {
    /// The visibility curve `v(d)` of eq. (1), in `(0, 1)`.
    #[must_use]
    pub fn visibility(&self, distance: f64) -> f64 {
        1.0 / (1.0 + ((distance - self.range) / self.edge).exp())
    }

    fn is_sound(&self) -> bool {
        let positive = |value: f64| value > 0.0 && value.is_finite();
        let share = |value: f64| value > 0.0 && value < 1.0;
        positive(self.range) && positive(self.edge) && share(self.detectability) && share(self.outliers)
    }

    /// What is taken for a landmark of which the log tells nothing: it is within the range.
    pub(crate) fn unseen(&self) -> Sensed {
        Sensed { detectability: self.detectability, deviation: self.range, warp: 0.0 }
    }
}

impl Sensed {
    fn is_sound(&self) -> bool {
        let Self { detectability, deviation, warp } = *self;
        detectability > 0.0
            && detectability < 1.0
            && deviation > 0.0
            && deviation.is_finite()
            && warp >= 0.0
            && warp.is_finite()
    }
}

/// What a map knows of its sensor.
#[derive(Debug, Clone, PartialEq)]
pub struct Sensing {
    /// By component.
    sensors: Vec<SensorModel>,
    /// By landmark.
    sensed: Vec<Sensed>,
    /// Where the occluded partners of each landmark start in `occluded`, and at last their number.
    starts: Vec<usize>,
    occluded: Vec<u32>,
}

impl Sensing {
    /// Puts the parts together: a sensor for every component, what is known of every landmark, and each occluded
    /// pair once, in any order.
    ///
    /// # Errors
    /// [`MapError::InvalidMap`] for a number out of its range, and a pair of one landmark with itself or with one that
    /// is not there.
    pub fn from_parts(
        sensors: Vec<SensorModel>,
        sensed: Vec<Sensed>,
        occluded: &[[u32; 2]],
    ) -> Result<Self, MapError> {
        let invalid =
            |what: String| Err(MapError::InvalidMap { what: format!("{what}; build the map again") });
        if let Some(component) = sensors.iter().position(|sensor| !sensor.is_sound()) {
            return invalid(format!("the sensor of component {component} is {:?}", sensors[component]));
        }
        if let Some(landmark) = sensed.iter().position(|sensed| !sensed.is_sound()) {
            return invalid(format!("what is known of landmark {landmark} is {:?}", sensed[landmark]));
        }
        let n = sensed.len();
        if let Some([a, b]) = occluded.iter().find(|[a, b]| a == b || *a.max(b) as usize >= n) {
            return invalid(format!("landmarks {a} and {b} of {n} are said to be occluded"));
        }
        let mut both: Vec<[u32; 2]> = occluded.iter().flat_map(|&[a, b]| [[a, b], [b, a]]).collect();
        both.sort_unstable();
        both.dedup();
        let starts = (0..=n).map(|i| both.partition_point(|pair| (pair[0] as usize) < i)).collect();
        let occluded = both.into_iter().map(|pair| pair[1]).collect();
        Ok(Self { sensors, sensed, starts, occluded })
    }

    /// The sensor in the units of a component's chart.
    ///
    /// # Panics
    /// If the map has no such component.
    #[must_use]
    pub fn sensor(&self, component: u32) -> &SensorModel {
        &self.sensors[component as usize]
    }

    /// The sensors of all components.
    #[must_use]
    pub fn sensors(&self) -> &[SensorModel] {
        &self.sensors
    }

    /// What is known of a landmark.
    ///
    /// # Panics
    /// If the map has no such landmark.
    #[must_use]
    pub fn of(&self, id: LandmarkId) -> &Sensed {
        &self.sensed[id.index()]
    }

    /// The near landmarks that are hardly ever seen together with this one, ascending.
    #[must_use]
    pub fn occluded_from(&self, id: LandmarkId) -> &[u32] {
        &self.occluded[self.starts[id.index()]..self.starts[id.index() + 1]]
    }

    /// Every occluded pair once, ascending.
    pub(crate) fn occluded_pairs(&self) -> impl Iterator<Item = [u32; 2]> {
        (0..self.sensed.len() as u32).flat_map(|i| {
            self.occluded_from(LandmarkId(i)).iter().filter(move |&&j| j > i).map(move |&j| [i, j])
        })
    }

    /// The same in charts whose units are `ratio` times as many, by component.
    pub(crate) fn scaled(mut self, landmarks: &[PlacedLandmark], ratio: impl Fn(u32) -> f64) -> Self {
        for (component, sensor) in (0..).zip(&mut self.sensors) {
            sensor.range *= ratio(component);
            sensor.edge *= ratio(component);
        }
        for (sensed, placed) in self.sensed.iter_mut().zip(landmarks) {
            sensed.deviation *= ratio(placed.component);
            sensed.warp *= ratio(placed.component);
        }
        self
    }

    pub(crate) fn landmarks(&self) -> usize {
        self.sensed.len()
    }
}

/// Learns the sensor from the finished charts; `None` if no component has three landmarks.
///
/// Components that are too small to learn from get the sensor of the largest one: the unit of all charts is
/// about the same.
pub(crate) fn learn(
    counts: &CoVisibility,
    graph: &LinkGraph,
    components: &[Vec<u32>],
    charts: &[&[Point]],
    sets: &[SeenSets],
    observer: &dyn Observer,
) -> Result<Option<Sensing>, MapError> {
    let work = components.iter().zip(sets).map(|(members, sets)| work(members, sets)).sum();
    observer.started(Stage::Sensor, Some(work));
    if observer.interrupted() {
        return Err(MapError::Interrupted);
    }
    let n = graph.landmarks();
    let mut sensors: Vec<SensorModel> = Vec::with_capacity(components.len());
    let (mut sensed, mut occluded) = (vec![None; n], Vec::new());
    for ((members, &points), sets) in components.iter().zip(charts).zip(sets) {
        if members.len() >= 3 {
            let part;
            let graph = if members.len() == n {
                graph
            } else {
                part = graph.restricted_to(members);
                &part
            };
            let found = learn_one(counts, graph, members, points, sets, observer)?;
            sensors.push(found.sensor);
            for (&member, &own) in members.iter().zip(&found.sensed) {
                sensed[member as usize] = Some(own);
            }
            let chances: Vec<f64> = found.sensed.iter().map(|sensed| sensed.detectability).collect();
            occluded.extend(occlusion::pairs(counts, members, points, &found.sensor, &chances));
        } else if let Some(&sensor) = sensors.first() {
            sensors.push(sensor);
            for &member in members {
                sensed[member as usize] = Some(sensor.unseen());
            }
        }
    }
    observer.finished(Stage::Sensor);
    if sensors.is_empty() {
        return Ok(None);
    }
    let sensed =
        sensed.into_iter().map(|sensed| sensed.expect("every landmark has a component (bug in covimap)"));
    Sensing::from_parts(sensors, sensed.collect(), &occluded).map(Some)
}

/// How much work a component is: what [`learn_one`] tells the observer of.
pub(crate) fn work(members: &[u32], sets: &SeenSets) -> u64 {
    if members.len() < 3 {
        return 0;
    }
    let observed = sets_observed(sets, members.len());
    observed as u64 + warp::steps() * worth_of_a_step(observed)
}

/// The work of a step of the warp: all of them together are about as much as the sets that are observed.
fn worth_of_a_step(observed: usize) -> u64 {
    observed as u64 / warp::steps()
}

/// What is learnt of one component.
pub(crate) struct LearntSensor {
    pub sensor: SensorModel,
    /// By member.
    pub sensed: Vec<Sensed>,
}

/// Learns the sensor of a component of at least three landmarks from its finished chart; `graph` has the landmarks
/// `members` of the counts.
pub(crate) fn learn_one(
    counts: &CoVisibility,
    graph: &LinkGraph,
    members: &[u32],
    points: &[Point],
    sets: &SeenSets,
    observer: &dyn Observer,
) -> Result<LearntSensor, MapError> {
    let worth = worth_of_a_step(sets_observed(sets, points.len()));
    let (found, warp) = rayon::join(
        || observe(graph, sets, points, observer),
        || warp::warp(counts, graph, members, points, worth, observer),
    );
    let found = found?;
    let sensor = SensorModel {
        range: found.sensor.range,
        edge: found.sensor.edge,
        detectability: found.sensor.detectability,
        outliers: found.outliers,
    };
    let known = found.detectability.into_iter().zip(found.deviation).zip(warp?);
    let sensed = known.map(|((detectability, deviation), warp)| Sensed { detectability, deviation, warp });
    Ok(LearntSensor { sensor, sensed: sensed.collect() })
}

#[cfg(test)]
mod tests;
