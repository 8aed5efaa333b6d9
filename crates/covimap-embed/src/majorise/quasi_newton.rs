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

use std::collections::VecDeque;

use super::{State, moved};
use crate::Point;
use crate::limited_memory::{Memory, REMEMBERED, add, dot};

/// Lengths that are tried before a plain step is taken.
const TRIALS: usize = 4;
/// Share of the promised gain that a step must keep.
const KEPT: f64 = 1e-4;
/// A shortened step is at least and at most this share of the one before.
const SHORTENED: [f64; 2] = [0.1, 0.5];

/// The steps so far, and the state that the last one started from.
#[derive(Default)]
pub(super) struct QuasiNewton {
    memory: Memory,
    /// `V^+ y` of each step in the memory, the newest first.
    scaled: VecDeque<Vec<Point>>,
    last: Option<Gradient>,
}

/// Where a step started, `G` there, and `V^+ G`.
struct Gradient {
    points: Vec<Point>,
    gradient: Vec<Point>,
    scaled: Vec<Point>,
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
        let slope = -dot(state.gradient.as_flattened(), direction.as_flattened());
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
        self.scaled.clear();
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
            if self.memory.remember(s.into_flattened(), y.into_flattened()) {
                self.scaled.truncate(REMEMBERED - 1);
                self.scaled.push_front(moved(scaled, &before.scaled, -1.0));
            }
        }
    }

    /// `-H G`; none without memory. What is left of `G` after the shares `a` of the changes has
    /// `V^+ (G - sum a y) = V^+ G - sum a V^+ y`, and needs no solve.
    fn direction(&self, gradient: &[Point], scaled: &[Point]) -> Option<Vec<Point>> {
        let newest = self.scaled.front()?;
        let (change, inverse_curvature) = self.memory.newest()?;
        let gamma = 1.0 / (inverse_curvature * dot(change, newest.as_flattened()));
        let towards = self.memory.apply(gradient.as_flattened().to_vec(), |left, shares| {
            left.copy_from_slice(scaled.as_flattened());
            for (share, scaled) in shares.iter().zip(&self.scaled) {
                add(left, -share, scaled.as_flattened());
            }
            left.iter_mut().for_each(|x| *x *= gamma);
        });
        Some(towards.as_chunks().0.iter().map(|&[x, y]| [-x, -y]).collect())
    }
}

#[cfg(test)]
mod tests {
    use std::rc::Rc;

    use super::*;

    /// A state of the stress `sum k x_k^2` over the coordinates, half of whose gradient is `k x_k`.
    fn bowl(points: Vec<Point>) -> State {
        let curvature = |k: usize, axis: usize| (2 * k + axis + 1) as f64;
        let at = |k: usize, p: &Point| [curvature(k, 0) * p[0], curvature(k, 1) * p[1]];
        let gradient: Vec<Point> = points.iter().enumerate().map(|(k, p)| at(k, p)).collect();
        State {
            stress: dot(points.as_flattened(), gradient.as_flattened()),
            points,
            gradient,
            disparities: Rc::new(vec![]),
        }
    }

    /// With `V = 5`.
    fn scaled(gradient: &[Point]) -> Vec<Point> {
        gradient.iter().map(|g| g.map(|x| x / 5.0)).collect()
    }

    #[test]
    fn nothing_is_known_before_the_second_state() {
        let start = bowl(vec![[1.0, 1.0], [1.0, -1.0]]);
        let mut steps = QuasiNewton::default();
        assert!(steps.step(&start, &scaled(&start.gradient), bowl).is_none());
        assert!(steps.memory.newest().is_none());
    }

    #[test]
    fn the_last_step_is_what_its_change_of_gradient_asks_for() {
        // The secant equation H y = s of the newest pair.
        let mut steps = QuasiNewton::default();
        for points in [[[3.0, 1.0], [1.0, -1.0]], [[2.0, 0.5], [0.0, -1.5]], [[1.0, 0.25], [-0.5, 0.5]]] {
            let state = bowl(points.to_vec());
            steps.learn(&state, &scaled(&state.gradient));
        }
        assert_eq!(steps.scaled.len(), 2);
        // From (2, .5), (0, -1.5) to (1, .25), (-.5, .5); the gradient of the bowl is 1, 2, 3, 4 times as much.
        let s = [-1.0, -0.25, -0.5, 2.0];
        let y = [[-1.0, -0.5], [-1.5, 8.0]];
        let direction = steps.direction(&y, &scaled(&y)).unwrap();
        for (found, s) in direction.iter().flatten().zip(s) {
            assert!((found + s).abs() < 1e-12, "{found} for {}", -s);
        }
    }

    #[test]
    fn a_quadratic_is_solved_in_a_few_steps() {
        let mut steps = QuasiNewton::default();
        let mut state = bowl(vec![[3.0, 1.0], [1.0, -1.0]]);
        for _ in 0..12 {
            let scaled = scaled(&state.gradient);
            let next = steps.step(&state, &scaled, bowl);
            state = next.unwrap_or_else(|| bowl(moved(&state.points, &scaled, -1.0)));
        }
        assert!(state.stress < 1e-12, "{}", state.stress);
    }

    #[test]
    fn a_step_that_never_gains_is_not_taken_and_forgets_all() {
        let mut steps = QuasiNewton::default();
        let [first, second] =
            [[[3.0, 1.0], [1.0, -1.0]], [[2.0, 0.5], [0.5, -0.5]]].map(|p| bowl(p.to_vec()));
        steps.learn(&first, &scaled(&first.gradient));
        let tried = std::cell::Cell::new(0);
        let worse = |points| {
            tried.set(tried.get() + 1);
            State { stress: 1e9, ..bowl(points) }
        };
        assert!(steps.step(&second, &scaled(&second.gradient), worse).is_none());
        assert_eq!(tried.get(), TRIALS);
        assert!(steps.memory.newest().is_none() && steps.scaled.is_empty());
    }

    #[test]
    fn a_hollow_is_not_remembered() {
        // Between the states the gradient turned against the step.
        let mut steps = QuasiNewton::default();
        let first = bowl(vec![[1.0, 1.0]]);
        let second = State { gradient: vec![[5.0, 5.0]], ..bowl(vec![[0.5, 0.5]]) };
        steps.learn(&first, &scaled(&first.gradient));
        steps.learn(&second, &scaled(&second.gradient));
        assert!(steps.memory.newest().is_none());
    }
}
