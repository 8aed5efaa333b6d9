//! Scores and Fisher information, gathered over steps and places, and the updates made of them.
//!
//! With `r = (seen - P) / (P (1 - P))` and a derivative `D` of `P`, every (step, place) of
//! posterior weight `g` adds `g r D` to the score and `g D^2 / (P (1 - P))` to the information.
//! The derivatives, with `v` the visibility curve and `u` the unit vector from place to landmark:
//!
//! | unknown | derivative of `P` |
//! |---|---|
//! | position `x` | `-p v (1 - v) / s u` |
//! | detectability `p` | `v` |
//! | range `R` | `p v (1 - v) / s` |
//! | edge `s`, as `ln s` | `p v (1 - v) (d - R) / s` |

use covimap_embed::Point;
use rayon::prelude::*;

use super::{Model, Sensor};

/// Longest move of a landmark in one iteration, as a share of the range.
const LONGEST_MOVE: f64 = 0.2;
/// Share of the mean information added to both axes: a landmark seen from one side only would
/// otherwise be thrown along the circle.
const RIDGE: f64 = 0.05;
/// What is believed of a detectability before any sighting: its mean, and as how many sightings'
/// information that counts.
const PRIOR: (f64, f64) = (0.9, 100.0);
/// Bounds of a detectability.
const DETECTABILITY: (f64, f64) = (0.02, 0.995);
/// Narrowest edge, as a share of the range: the grid resolves no finer.
const NARROWEST: f64 = 0.03;

/// One landmark as seen, or not, from one place.
pub(super) struct Term {
    pub seen: bool,
    pub probability: f64,
    pub detectability: f64,
    pub visibility: f64,
    /// From the place to the landmark.
    pub offset: Point,
    pub distance: f64,
}

/// Scores of one landmark.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Scores {
    position: Point,
    /// Information of the position: xx, xy, yy.
    information: [f64; 3],
    detectability: f64,
    detectability_information: f64,
}

/// Scores of what all landmarks share.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct SharedScores {
    range: [f64; 2],
    log_edge: [f64; 2],
    pub log_likelihood: f64,
}

impl Scores {
    /// Whether nothing was gathered: any term adds information on the detectability.
    pub fn is_empty(&self) -> bool {
        self.detectability_information <= 0.0
    }

    pub fn gather(&mut self, term: &Term, weight: f64, sensor: Sensor, shared: &mut SharedScores) {
        let information = weight / (term.probability * (1.0 - term.probability));
        let surprise = information * (f64::from(u8::from(term.seen)) - term.probability);
        let slope = term.detectability * term.visibility * (1.0 - term.visibility) / sensor.edge;
        if term.distance > 0.0 {
            let u = [term.offset[0] / term.distance, term.offset[1] / term.distance];
            let (score, square) = (-surprise * slope, information * slope * slope);
            self.position[0] += score * u[0];
            self.position[1] += score * u[1];
            self.information[0] += square * u[0] * u[0];
            self.information[1] += square * u[0] * u[1];
            self.information[2] += square * u[1] * u[1];
        }
        self.detectability += surprise * term.visibility;
        self.detectability_information += information * term.visibility * term.visibility;
        shared.range[0] += surprise * slope;
        shared.range[1] += information * slope * slope;
        let by_edge = slope * (term.distance - sensor.range);
        shared.log_edge[0] += surprise * by_edge;
        shared.log_edge[1] += information * by_edge * by_edge;
    }

    pub fn add(&mut self, other: &Self) {
        self.position[0] += other.position[0];
        self.position[1] += other.position[1];
        for (sum, more) in self.information.iter_mut().zip(other.information) {
            *sum += more;
        }
        self.detectability += other.detectability;
        self.detectability_information += other.detectability_information;
    }

    /// The Fisher-scoring step of the position, no longer than allowed.
    fn step(&self, longest: f64) -> Point {
        let [xx, xy, yy] = self.information;
        let ridge = RIDGE * (xx + yy);
        let (xx, yy) = (xx + ridge, yy + ridge);
        let determinant = xx * yy - xy * xy;
        if determinant <= 0.0 {
            return [0.0; 2];
        }
        let [gx, gy] = self.position;
        let step = [(yy * gx - xy * gy) / determinant, (xx * gy - xy * gx) / determinant];
        let length = step[0].hypot(step[1]);
        if length > longest { step.map(|c| c * longest / length) } else { step }
    }
}

impl SharedScores {
    pub fn add(&mut self, other: &Self) {
        for k in 0..2 {
            self.range[k] += other.range[k];
            self.log_edge[k] += other.log_edge[k];
        }
        self.log_likelihood += other.log_likelihood;
    }
}

fn scoring_step([score, information]: [f64; 2], most: f64) -> f64 {
    if information > 0.0 { (score / information).clamp(-most, most) } else { 0.0 }
}

impl Model {
    /// Moves every landmark and returns the mean length of the moves.
    pub(super) fn update_points(&mut self, landmarks: &[Scores]) -> f64 {
        let longest = LONGEST_MOVE * self.sensor.range;
        let steps: Vec<Point> = landmarks.par_iter().map(|scores| scores.step(longest)).collect();
        for (point, step) in self.points.iter_mut().zip(&steps) {
            *point = [point[0] + step[0], point[1] + step[1]];
        }
        steps.iter().map(|step| step[0].hypot(step[1])).sum::<f64>() / steps.len() as f64
    }

    pub(super) fn update_detectability(&mut self, landmarks: &[Scores]) {
        let (mean, weight) = PRIOR;
        for (p, scores) in self.detectability.iter_mut().zip(landmarks) {
            let step =
                (scores.detectability + weight * (mean - *p)) / (scores.detectability_information + weight);
            *p = (*p + step).clamp(DETECTABILITY.0, DETECTABILITY.1);
        }
    }

    pub(super) fn update_edge(&mut self, shared: &SharedScores) {
        let edge = self.sensor.edge * scoring_step(shared.log_edge, 0.3).exp();
        self.sensor.edge = edge.max(NARROWEST * self.sensor.range);
    }

    pub(super) fn update_range(&mut self, shared: &SharedScores) {
        self.sensor.range += scoring_step(shared.range, 0.1 * self.sensor.range);
    }
}
