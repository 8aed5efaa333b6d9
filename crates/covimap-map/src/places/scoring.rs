//! Score and Fisher information of every landmark, gathered over steps and places, and the moves
//! made of them.
//!
//! With `r = (seen - P) / (P (1 - P))` and a derivative `D` of `P`, every (step, place) of
//! posterior weight `g` adds `g r D` to the score and `g D D' / (P (1 - P))` to the information.
//! `D = -p v (1 - v) / (s d) (x - y)` for the position `x`, `y` being the place, and `D = v` for the
//! detectability `p`.
//!
//! That information takes the places for known. What a log really says about a position is the sum
//! over steps of `(sum_y g r D) (sum_y g r D)'`: a step that leaves its place open has a small score.

use covimap_embed::Point;

use super::posterior::Step;
use super::sensor::{Curve, DETECTABILITY, probability};

/// Share of the mean information added to both axes: a landmark seen from one side only would
/// otherwise be thrown along the circle.
const RIDGE: f64 = 0.05;
/// Information that the common detectability counts for against a landmark's own sightings.
const PRIOR_INFORMATION: f64 = 100.0;

/// Scores of one landmark.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Scores {
    position: Point,
    /// Information of the position: xx, xy, yy.
    information: [f64; 3],
    /// Observed information of the position, in which the places are unknown: xx, xy, yy.
    observed: [f64; 3],
    detectability: f64,
    detectability_information: f64,
}

/// Scores of the landmarks that a task has touched.
pub(super) struct ScoreBoard {
    scores: Vec<Scores>,
    touched: Vec<u32>,
}

impl ScoreBoard {
    pub fn new(landmarks: usize) -> Self {
        Self { scores: vec![Scores::default(); landmarks], touched: Vec::new() }
    }

    /// Adds `times` steps with the posterior of their place.
    pub fn gather(&mut self, step: &Step, times: f64, curve: &Curve) {
        for witness in step.witnesses {
            let seen = f64::from(u8::from(witness.seen));
            let p = witness.detectability;
            let mut own = Scores::default();
            for &(place, weight) in step.places {
                let (dx, dy) = (witness.at[0] - place[0], witness.at[1] - place[1]);
                let [v, slope] = curve.at(dx * dx + dy * dy);
                let probability = probability(p, v);
                let information = times * weight / (probability * (1.0 - probability));
                let surprise = information * (seen - probability);
                let by_offset = p * slope;
                own.position[0] -= surprise * by_offset * dx;
                own.position[1] -= surprise * by_offset * dy;
                let square = information * by_offset * by_offset;
                own.information[0] += square * dx * dx;
                own.information[1] += square * dx * dy;
                own.information[2] += square * dy * dy;
                own.detectability += surprise * v;
                own.detectability_information += information * v * v;
            }
            let [gx, gy] = own.position;
            own.observed = [gx * gx, gx * gy, gy * gy].map(|square| square / times);
            let sum = &mut self.scores[witness.landmark as usize];
            // Any step adds information on the detectability.
            if sum.detectability_information <= 0.0 {
                self.touched.push(witness.landmark);
            }
            sum.add(&own);
        }
    }

    /// The scores gathered since the last call, by landmark.
    pub fn take(&mut self) -> Vec<(u32, Scores)> {
        self.touched.sort_unstable();
        let take = |landmark: u32| (landmark, std::mem::take(&mut self.scores[landmark as usize]));
        self.touched.drain(..).map(take).collect()
    }
}

impl Scores {
    pub fn add(&mut self, other: &Self) {
        self.position[0] += other.position[0];
        self.position[1] += other.position[1];
        for (sum, more) in self.information.iter_mut().zip(other.information) {
            *sum += more;
        }
        for (sum, more) in self.observed.iter_mut().zip(other.observed) {
            *sum += more;
        }
        self.detectability += other.detectability;
        self.detectability_information += other.detectability_information;
    }

    /// The Fisher-scoring step of the position, no longer than allowed.
    pub fn step(&self, longest: f64) -> Point {
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

    /// Standard deviation of a coordinate, both axes taken together, that the log leaves to the
    /// position; `loosest` where it says nothing.
    pub fn deviation(&self, loosest: f64) -> f64 {
        let [xx, xy, yy] = self.observed;
        let least = 1.0 / (loosest * loosest);
        let (xx, yy) = (xx + least, yy + least);
        // Half the trace of the inverse.
        ((xx + yy) / (2.0 * (xx * yy - xy * xy))).sqrt()
    }

    /// The detectability after a Fisher-scoring step from `p`, drawn towards the `common` one.
    pub fn improved_detectability(&self, p: f64, common: f64) -> f64 {
        let score = self.detectability + PRIOR_INFORMATION * (common - p);
        let step = score / (self.detectability_information + PRIOR_INFORMATION);
        (p + step).clamp(DETECTABILITY.0, DETECTABILITY.1)
    }
}

#[cfg(test)]
mod tests;
