//! How range, edge, detectability and false sightings of the sensor are fitted to the log.

use covimap_embed::wide;

use super::grid::{CELLS, Sight, sum};
use super::posterior::{Step, Witness};
use super::sensor::{DETECTABILITY, FALSE_SIGHTING, Sensor};

/// Narrowest edge, as a share of the range: the grid of places resolves no finer.
const NARROWEST: f64 = 0.03;
/// Largest relative change of the range in one step.
const RANGE_STEP: f64 = 0.1;
/// Largest change of the edge's logarithm in one step.
const EDGE_STEP: f64 = 0.3;
/// Largest change of the common detectability in one step.
const DETECTABILITY_STEP: f64 = 0.2;
/// Largest change of the probability of a false sighting in one step.
const FALSE_STEP: f64 = 0.02;

/// Score and information of the range, of the logarithm of the edge, of a change of all
/// detectabilities and of the probability of a false sighting.
///
/// The derivatives of eq. (1) are `(p - e) v (1 - v) / s` by `R`, `(d - R)` times that by `ln s`, `v` by `p`
/// and `1 - v` by `e`.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct SensorScores {
    range: [f64; 2],
    log_edge: [f64; 2],
    detectability: [f64; 2],
    false_sighting: [f64; 2],
}

impl SensorScores {
    /// Adds `times` steps with the posterior of their place.
    pub fn gather(&mut self, step: &Step, times: f64, sensor: Sensor, sight: &Sight) {
        wide(
            #[inline(always)]
            || {
                for witness in step.witnesses {
                    self.gather_one(witness, step, times, sensor, sight);
                }
            },
        );
    }

    /// The same of one landmark.
    #[inline(always)]
    fn gather_one(&mut self, witness: &Witness, step: &Step, times: f64, sensor: Sensor, sight: &Sight) {
        let by_sight = witness.detectability - sight.false_sighting;
        let seen = f32::from(u8::from(witness.seen));
        let [range, edge, spacing] = [sensor.range, sensor.edge, sight.spacing].map(|length| length as f32);
        let [x, y] = witness.cutting.offset;
        let mut sums = [[[0.0; CELLS]; 2]; 4];
        for row in step.rows.clone() {
            let weights = &step.places[row];
            let visibility = sight.visibility(witness.cutting, row);
            let across = y - row as f32;
            for k in 0..CELLS {
                let v = visibility[k];
                let p = sight.false_sighting + by_sight * v;
                let information = weights[k] / (p * (1.0 - p));
                let surprise = information * (seen - p);
                let along = x - k as f32;
                let distance = (along * along + across * across).sqrt() * spacing;
                let by_range = by_sight * v * (1.0 - v) / edge;
                let by_edge = by_range * (distance - range);
                for (sum, slope) in sums.iter_mut().zip([by_range, by_edge, v, 1.0 - v]) {
                    sum[0][k] += surprise * slope;
                    sum[1][k] += information * slope * slope;
                }
            }
        }
        let own = [&mut self.range, &mut self.log_edge, &mut self.detectability, &mut self.false_sighting];
        for (own, [score, information]) in own.into_iter().zip(sums) {
            own[0] += times * sum(score);
            own[1] += times * sum(information);
        }
    }

    pub fn add(&mut self, other: &Self) {
        for (sum, more) in [
            (&mut self.range, other.range),
            (&mut self.log_edge, other.log_edge),
            (&mut self.detectability, other.detectability),
            (&mut self.false_sighting, other.false_sighting),
        ] {
            sum[0] += more[0];
            sum[1] += more[1];
        }
    }

    /// The sensor after a Fisher-scoring step; the range only if it is free.
    pub fn improve(&self, sensor: Sensor, range_free: bool) -> Sensor {
        let step = |[score, information]: [f64; 2], most: f64| {
            if information > 0.0 { (score / information).clamp(-most, most) } else { 0.0 }
        };
        let moved = if range_free { step(self.range, RANGE_STEP * sensor.range) } else { 0.0 };
        let range = sensor.range + moved;
        let edge = sensor.edge * step(self.log_edge, EDGE_STEP).exp();
        let detectability = sensor.detectability + step(self.detectability, DETECTABILITY_STEP);
        let false_sighting = sensor.false_sighting + step(self.false_sighting, FALSE_STEP);
        Sensor {
            range,
            edge: edge.max(NARROWEST * range),
            detectability: detectability.clamp(DETECTABILITY.0, DETECTABILITY.1),
            false_sighting: false_sighting.clamp(FALSE_SIGHTING.0, FALSE_SIGHTING.1),
        }
    }
}
