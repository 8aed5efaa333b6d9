//! Quasi-Newton steps: the curvature that majorisation leaves out, learnt from the last steps.
//!
//! Majorisation takes `V` for half the matrix of second derivatives of `sigma`. Where a map bends
//! easily the truth is much smaller, and steps are short. The method of limited memory keeps the
//! last pairs of a step `s = X' - X` and the change `y = G' - G` of half the gradient, and steps
//! along `-H G`, where `H` is `gamma V^+` after the updates of Broyden, Fletcher, Goldfarb and
//! Shanno with these pairs, `gamma = s'y / y'V^+y` of the last one. The one solve with `V` that a
//! plain step takes is all that it takes: `V^+ y` is the change of `V^+ G`.
//!
//! A step is shortened until it keeps a share of what the slope promises. If it does not soon, the
//! memory is emptied and a plain step taken: the stress never rises, and with an empty memory
//! the step is the plain one.
//!
//! With disparities that are fitted, `sigma` is the least stress over all that are admitted, and
//! its gradient that at the fitted ones.
//!
//! # References
//! D. C. Liu, J. Nocedal, "On the limited memory BFGS method for large scale optimization",
//! Mathematical Programming 45, 1989.

use std::collections::VecDeque;

use super::{State, moved};
use crate::Point;

/// Steps that are remembered.
const MEMORY: usize = 8;
/// Lengths that are tried before a plain step is taken.
const TRIALS: usize = 4;
/// Share of the promised gain that a step must keep.
const KEPT: f64 = 1e-4;
/// A shortened step is at least and at most this share of the one before.
const SHORTENED: [f64; 2] = [0.1, 0.5];
/// Pairs with less curvature than this share of `|s| |y|` are not remembered.
const CURVED: f64 = 1e-10;

/// The steps so far, and the state that the last one started from.
#[derive(Default)]
pub(super) struct QuasiNewton {
    memory: VecDeque<Curvature>,
    last: Option<Gradient>,
}

/// Where a step started, `G` there, and `V^+ G`.
struct Gradient {
    points: Vec<Point>,
    gradient: Vec<Point>,
    scaled: Vec<Point>,
}

/// One pair.
struct Curvature {
    s: Vec<Point>,
    y: Vec<Point>,
    /// `V^+ y`.
    scaled: Vec<Point>,
    /// `1 / s'y`.
    rho: f64,
}

impl QuasiNewton {
    /// The state after a step from `state`, where `scaled` is `V^+ G`; none if a plain step is to
    /// be taken. `at` measures points.
    pub fn step(
        &mut self,
        state: &State,
        scaled: &[Point],
        at: impl Fn(Vec<Point>) -> State,
    ) -> Option<State> {
        self.learn(state, scaled);
        let direction = self.direction(&state.gradient, scaled)?;
        // The stress falls by twice this, per unit of length, at the start.
        let slope = -dot(&state.gradient, &direction);
        let mut length = 1.0;
        for _ in 0..TRIALS {
            let next = at(moved(&state.points, &direction, length));
            let gain = state.stress - next.stress;
            let promised = 2.0 * length * slope;
            if slope > 0.0 && gain >= KEPT * promised {
                return Some(next);
            }
            // The least value of the parabola through both stresses with this slope.
            let [least, most] = SHORTENED;
            length *= (0.5 * promised / (promised - gain)).clamp(least, most);
        }
        self.memory.clear();
        None
    }

    /// Remembers what the last step, of whatever kind, tells of the curvature.
    fn learn(&mut self, state: &State, scaled: &[Point]) {
        let here = Gradient {
            points: state.points.clone(),
            gradient: state.gradient.clone(),
            scaled: scaled.to_vec(),
        };
        if let Some(before) = self.last.replace(here) {
            let s = moved(&state.points, &before.points, -1.0);
            let y = moved(&state.gradient, &before.gradient, -1.0);
            let scaled = moved(scaled, &before.scaled, -1.0);
            let curvature = dot(&s, &y);
            if curvature > CURVED * (dot(&s, &s) * dot(&y, &y)).sqrt() {
                self.memory.truncate(MEMORY - 1);
                self.memory.push_front(Curvature { s, y, scaled, rho: 1.0 / curvature });
            }
        }
    }

    /// `-H G` by the recursion of two loops; none without memory.
    fn direction(&self, gradient: &[Point], scaled: &[Point]) -> Option<Vec<Point>> {
        let newest = self.memory.front()?;
        let gamma = 1.0 / (newest.rho * dot(&newest.y, &newest.scaled));
        let mut gradient = gradient.to_vec();
        let mut direction = scaled.to_vec();
        let mut alphas = Vec::with_capacity(MEMORY);
        for Curvature { s, y, scaled, rho } in &self.memory {
            let alpha = rho * dot(s, &gradient);
            add(&mut gradient, y, -alpha);
            add(&mut direction, scaled, -alpha);
            alphas.push(alpha);
        }
        direction.iter_mut().flatten().for_each(|x| *x *= gamma);
        for (Curvature { s, y, rho, .. }, alpha) in self.memory.iter().zip(alphas).rev() {
            let beta = rho * dot(y, &direction);
            add(&mut direction, s, alpha - beta);
        }
        direction.iter_mut().flatten().for_each(|x| *x = -*x);
        Some(direction)
    }
}

fn add(sum: &mut [Point], step: &[Point], factor: f64) {
    for (sum, step) in sum.iter_mut().zip(step) {
        *sum = [sum[0] + factor * step[0], sum[1] + factor * step[1]];
    }
}

fn dot(a: &[Point], b: &[Point]) -> f64 {
    let sum = a.iter().zip(b).fold([0.0; 2], |sum, (a, b)| [sum[0] + a[0] * b[0], sum[1] + a[1] * b[1]]);
    sum[0] + sum[1]
}
