//! The majorisation loop, the only one: for all kinds of lists and transformations.
//!
//! Two moves alternate, and neither raises `sigma = sum w_ij (e_ij - |x_i - x_j|)^2`:
//!
//! 1. with the disparities `e` fixed, a step of the points: the [Guttman transform](crate::smacof)
//!    `X+ = V^+ B(X) X`, or one that goes beyond it, see [`Steps`];
//! 2. with the points fixed, the [disparities](crate::Transformation) that fit best.
//!
//! With half the gradient `G = (V - B(X)) X` the transform is `X+ = X - V^+ G`: a step of steepest
//! descent, measured by `V`.
//!
//! # Lead-in
//! From a start that knows nothing of the dissimilarities, the disparities that fit it best know
//! as little: a random start would be admired for what it is. The loop therefore begins with the
//! dissimilarities as disparities, until a step gains less than a tenth of the stress. All
//! transformations admit them, so that the change to fitted ones does not raise the stress.
//!
//! # Convergence
//! A step beyond the transform may gain little by bad luck. The loop has converged when a plain
//! step gains less than the tolerance, and every run ends with a plain step.

use std::rc::Rc;

use crate::disparity::Disparities;
use crate::forces::{Forces, PairLayout};
use crate::laplacian::Laplacian;
use crate::solve::{check_start, negligible_stress};
use crate::{EmbedError, PairDistances, Point, Smacof, Steps, Termination};

mod quasi_newton;
mod relaxed;

use quasi_newton::QuasiNewton;

/// The lead-in ends with a step that gains less than this share of the stress.
const LEAD_IN: f64 = 0.1;

/// A problem with everything that is the same in every step and from every start.
pub(crate) struct Majoriser<'a> {
    pairs: &'a PairDistances,
    layout: PairLayout<'a>,
    laplacian: Laplacian,
    disparities: Disparities<'a>,
}

/// Where the loop ended.
pub(crate) struct Majorised {
    pub points: Vec<Point>,
    pub disparities: Vec<f64>,
    /// Stress before the first step and after each.
    pub trace: Vec<f64>,
    pub termination: Termination,
}

/// A configuration with what the next step asks of it.
struct State {
    points: Vec<Point>,
    disparities: Rc<Vec<f64>>,
    /// Against `disparities`.
    stress: f64,
    /// `G`.
    gradient: Vec<Point>,
}

impl<'a> Majoriser<'a> {
    pub fn new(pairs: &'a PairDistances, how: &'a Smacof) -> Result<Self, EmbedError> {
        Ok(Self {
            pairs,
            layout: PairLayout::new(pairs),
            laplacian: Laplacian::of(pairs)?,
            disparities: Disparities::new(pairs, &how.transformation)?,
        })
    }

    /// Runs the loop from `start`.
    pub fn run(&self, start: &[Point], how: &Smacof) -> Result<Majorised, EmbedError> {
        check_start(self.pairs, start)?;
        let negligible = negligible_stress(self.pairs);
        let mut quasi_newton = QuasiNewton::default();
        let mut leading = !how.warm && self.disparities.are_fitted();
        let mut state = self.state(start.to_vec(), &Rc::new(self.disparities.first()), leading);
        let mut trace = vec![state.stress];
        let mut termination = Termination::IterationLimit;
        let mut plain = false;
        for left in (0..how.stop.max_iterations).rev() {
            if left == 0 {
                (plain, leading) = (true, false);
            }
            let step = self.laplacian.solve(&state.gradient);
            let at = |points| self.state(points, &state.disparities, leading);
            let beyond = match how.steps {
                Steps::Relaxed if !plain => Some(at(self.relaxed(&state, &step))),
                Steps::QuasiNewton if !plain => quasi_newton.step(&state, &step, at),
                _ => None,
            };
            plain = beyond.is_none();
            let next = beyond.unwrap_or_else(|| at(self.guttman(&state, &step)));
            let gain = state.stress - next.stress;
            let settled = gain <= how.stop.tolerance * state.stress;
            state = next;
            trace.push(state.stress);
            let done = !leading && (settled || state.stress <= negligible);
            if done && plain {
                termination = Termination::Converged;
                break;
            }
            plain = done;
            if leading && gain <= LEAD_IN * (state.stress + gain) {
                leading = false;
                // What was learnt is the curvature of another stress.
                quasi_newton = QuasiNewton::default();
            }
        }
        let State { points, disparities, .. } = state;
        Ok(Majorised { points, disparities: Rc::unwrap_or_clone(disparities), trace, termination })
    }

    /// Fits the disparities to the points, unless the dissimilarities still lead.
    fn state(&self, points: Vec<Point>, before: &Rc<Vec<f64>>, leading: bool) -> State {
        let fitted = if leading { None } else { self.disparities.fit(&points) };
        let disparities = fitted.map_or_else(|| Rc::clone(before), Rc::new);
        let Forces { stress, forces } = self.layout.forces(&points, &disparities);
        State { points, disparities, stress, gradient: forces }
    }

    /// `X - V^+ G`, every component centred at the origin.
    fn guttman(&self, state: &State, step: &[Point]) -> Vec<Point> {
        let mut points = moved(&state.points, step, -1.0);
        self.laplacian.centre(&mut points);
        points
    }
}

/// `points + factor * step`.
fn moved(points: &[Point], step: &[Point], factor: f64) -> Vec<Point> {
    let each = points.iter().zip(step);
    each.map(|(point, step)| [point[0] + factor * step[0], point[1] + factor * step[1]]).collect()
}

#[cfg(test)]
mod tests;
