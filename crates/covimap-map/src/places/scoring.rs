//! Score and Fisher information of every landmark, gathered over steps and places, and the moves
//! made of them.
//!
//! With `r = (seen - P) / (P (1 - P))` and a derivative `D` of `P`, every (step, place) of
//! posterior weight `g` adds `g r D` to the score and `g D D' / (P (1 - P))` to the information.
//! `D = -(p - e) v (1 - v) / (s d) (x - y)` for the position `x`, `y` being the place, and `D = v` for the
//! detectability `p`.
//!
//! That information takes the places for known. What a log really says about a position is the sum
//! over steps of `(sum_y g r D) (sum_y g r D)'`: a step that leaves its place open has a small score.

use covimap_embed::{Point, wide};

use super::grid::{CELLS, Lanes, Sight, sum};
use super::posterior::{Step, Witness};
use super::sensor::DETECTABILITY;

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
    pub fn gather(&mut self, step: &Step, times: f64, sight: &Sight) {
        wide(
            #[inline(always)]
            || {
                for witness in step.witnesses {
                    let own = Scores::of(witness, step, sight);
                    let sum = &mut self.scores[witness.landmark as usize];
                    // Any step adds information on the detectability.
                    if sum.detectability_information <= 0.0 {
                        self.touched.push(witness.landmark);
                    }
                    sum.add(&own, times);
                }
            },
        );
    }

    /// The scores gathered since the last call, by landmark.
    pub fn take(&mut self) -> Vec<(u32, Scores)> {
        self.touched.sort_unstable();
        let take = |landmark: u32| (landmark, std::mem::take(&mut self.scores[landmark as usize]));
        self.touched.drain(..).map(take).collect()
    }
}

impl Scores {
    /// Of a landmark, from one step.
    #[inline(always)]
    fn of(witness: &Witness, step: &Step, sight: &Sight) -> Self {
        let [x, y] = witness.cutting.offset;
        let by_sight = witness.detectability - sight.false_sighting;
        let seen = f32::from(u8::from(witness.seen));
        let along: Lanes = std::array::from_fn(|column| x - column as f32);
        let zero: Lanes = [0.0; CELLS];
        let [mut gx, mut gy, mut xx, mut xy, mut yy, mut gp, mut pp] = [zero; 7];
        for row in step.rows.clone() {
            let across = y - row as f32;
            let weights = &step.places[row];
            let visibility = sight.visibility(witness.cutting, row);
            let slope = sight.slope(witness.cutting, row);
            for k in 0..CELLS {
                let v = visibility[k];
                let probability = sight.false_sighting + by_sight * v;
                let information = weights[k] / (probability * (1.0 - probability));
                let surprise = information * (seen - probability);
                let by_offset = by_sight * slope[k];
                let pull = surprise * by_offset;
                gx[k] -= pull * along[k];
                gy[k] -= pull * across;
                let square = information * by_offset * by_offset;
                let square_along = square * along[k];
                xx[k] += square_along * along[k];
                xy[k] += square_along * across;
                yy[k] += square * across * across;
                gp[k] += surprise * v;
                pp[k] += information * v * v;
            }
        }
        let [x, y] = [sum(gx), sum(gy)];
        Self {
            position: [x, y],
            observed: [x * x, x * y, y * y],
            information: [sum(xx), sum(xy), sum(yy)],
            detectability: sum(gp),
            detectability_information: sum(pp),
        }
    }

    #[inline(always)]
    pub fn add(&mut self, other: &Self, times: f64) {
        self.position[0] += times * other.position[0];
        self.position[1] += times * other.position[1];
        for (sum, more) in self.information.iter_mut().zip(other.information) {
            *sum += times * more;
        }
        for (sum, more) in self.observed.iter_mut().zip(other.observed) {
            *sum += times * more;
        }
        self.detectability += times * other.detectability;
        self.detectability_information += times * other.detectability_information;
    }

    /// The Fisher-scoring step of the position, no longer than allowed.
    pub fn step(&self, longest: f64) -> Point {
        let Some([xx, xy, yy]) = self.covariance() else { return [0.0; 2] };
        let [gx, gy] = self.position;
        let step = [xx * gx + xy * gy, xy * gx + yy * gy];
        let length = step[0].hypot(step[1]);
        if length > longest { step.map(|c| c * longest / length) } else { step }
    }

    /// Variance of the position, both axes together, as far as the places of the steps are known.
    pub fn variance(&self) -> f64 {
        self.covariance().map_or(0.0, |[xx, _, yy]| xx + yy)
    }

    /// Inverse of the information and a ridge: xx, xy, yy. `None` without information.
    fn covariance(&self) -> Option<[f64; 3]> {
        let [xx, xy, yy] = self.information;
        let ridge = RIDGE * (xx + yy);
        let (xx, yy) = (xx + ridge, yy + ridge);
        let determinant = xx * yy - xy * xy;
        (determinant > 0.0).then(|| [yy, -xy, xx].map(|entry| entry / determinant))
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
