//! Sensors: which landmarks are recognised from where, and what goes wrong with it.

mod arcs;
mod errors;
mod range;
mod ranging;
mod visual_angle;

#[cfg(test)]
mod tests;

use rand::RngExt;

use crate::angle::Angle;
use crate::error::SimError;
use crate::geometry::Pose;
use crate::seed::{Stream, stream};
use crate::spec::{ErrorSpec, Recognition, SensorSpec};
use crate::world::World;
use errors::Errors;
use range::{RangeCurve, RangeSensor};
use ranging::Ranging;
use visual_angle::{Camera, Limits, VisualAngle};

/// Tells what is recognised.
trait Sensor: Send {
    /// Appends the numbers of the landmarks recognised from the pose, each once, in any order.
    fn sense(&mut self, pose: Pose, seen: &mut Vec<u32>);
}

/// A sensor with its errors.
pub(crate) struct Observer {
    sensor: Box<dyn Sensor>,
    ranging: Option<Ranging>,
    errors: Option<Errors>,
    /// Of the last look: landmarks, and metres if ranges are measured.
    look: Vec<(u32, f64)>,
}

impl Observer {
    pub(crate) fn new(
        world: &World,
        spec: &SensorSpec,
        errors: ErrorSpec,
        seed: u64,
    ) -> Result<Self, SimError> {
        let landmarks = u32::try_from(world.landmarks().len()).expect("checked before (bug in covimap)");
        let is_spoilt = errors.missed > 0.0 || errors.mistaken > 0.0;
        let errors = is_spoilt.then(|| Errors { spec: errors, landmarks, rng: stream(seed, Stream::Errors) });
        let ranging = spec.range_noise.map(|noise| Ranging {
            noise,
            landmarks: world.landmarks().to_vec(),
            rng: stream(seed, Stream::Ranges),
        });
        Ok(Self { sensor: sensor(world, spec, seed)?, ranging, errors, look: Vec::new() })
    }

    /// Fills the list with the landmarks seen from the pose, in ascending order, each once.
    pub(crate) fn observe(&mut self, pose: Pose, seen: &mut Vec<u32>) {
        seen.clear();
        self.sensor.sense(pose, seen);
        // Sorted first, so that the errors do not depend on the order in which the sensor looks.
        seen.sort_unstable();
        // A landmark that is taken for another is where it is: measured first.
        let measured = |&number: &u32| {
            (number, self.ranging.as_mut().map_or(0.0, |ranging| ranging.measure(pose, number)))
        };
        self.look.clear();
        self.look.extend(seen.iter().map(measured));
        if let Some(errors) = &mut self.errors {
            errors.apply(&mut self.look);
            self.look.sort_by_key(|sighting| sighting.0);
            self.look.dedup_by_key(|sighting| sighting.0);
            seen.clear();
            seen.extend(self.look.iter().map(|sighting| sighting.0));
        }
    }

    /// The ranges to the landmarks of the last look, in its order, metres; none unless they are measured.
    pub(crate) fn ranges(&self) -> impl Iterator<Item = f64> {
        let measured = if self.ranging.is_some() { self.look.as_slice() } else { &[] };
        measured.iter().map(|sighting| sighting.1)
    }
}

fn sensor(world: &World, spec: &SensorSpec, seed: u64) -> Result<Box<dyn Sensor>, SimError> {
    let rng = stream(seed, Stream::Sensing);
    let half_view = spec.view.rad() / 2.0;
    let traits = Traits::of(world);
    let detectability = |traits: &Traits| between(spec.detectability, traits.detectability);
    match spec.recognition {
        Recognition::Range { range, edge, detection } => {
            let curve = RangeCurve { range, edge, detection };
            let detectability = traits.iter().map(detectability).collect();
            Ok(Box::new(RangeSensor::new(world, curve, half_view, detectability, rng)))
        }
        Recognition::VisualAngle { .. } if world.diameter() <= 0.0 => Err(SimError::SolidNeeded),
        Recognition::VisualAngle { threshold, steepness } => {
            let threshold = threshold.map(Angle::rad);
            let limits = traits.iter().map(|traits| Limits {
                threshold: between(threshold, traits.threshold),
                detectability: detectability(traits),
            });
            let least = if steepness.is_none() { threshold[0] } else { 0.0 };
            Ok(Box::new(VisualAngle {
                camera: Camera::new(world, half_view, least),
                steepness,
                limits: limits.collect(),
                rng,
            }))
        }
    }
}

/// Where a landmark stands between the extremes, 0 to 1. Traits belong to the world: every run through it
/// finds the same, and a wider range moves each landmark in proportion.
#[derive(Debug, Clone, Copy)]
struct Traits {
    detectability: f64,
    threshold: f64,
}

impl Traits {
    fn of(world: &World) -> Vec<Self> {
        let mut rng = stream(world.seed(), Stream::Traits);
        let mut draw = |_| Self { detectability: rng.random(), threshold: rng.random() };
        (0..world.landmarks().len()).map(&mut draw).collect()
    }
}

fn between([low, high]: [f64; 2], share: f64) -> f64 {
    low + share * (high - low)
}
