//! Descent of a smooth function whose curvature is known roughly: steps along `-M^-1 g`, corrected by what
//! the last steps did to the gradient.
//!
//! The limited-memory BFGS recursion is built upon an approximation `M` of the second derivative, which is renewed
//! when it has served its time, when the configuration has moved far, or when steps gain nothing any more. Of a
//! step, so much is taken as lowers the value enough (Armijo's condition).
//!
//! # References
//! J. Nocedal, S. J. Wright, Numerical Optimization, 2nd ed., 2006, algorithms 7.4 and 3.1.

use crate::limited_memory::{Memory, change, dot, paired};
use crate::{EmbedError, StopRule, Termination};

/// Share of the value that a step must take away for the configuration to have moved far.
const FAR: f64 = 0.1;
/// Share of the decrease promised by the slope that a step must keep.
const KEPT: f64 = 1e-4;
/// Shortenings of a step before it is given up: by then it is below rounding.
const SHORTENINGS: usize = 20;

/// What is minimised.
pub(crate) trait Objective {
    /// Steps that an approximation of the second derivative serves.
    const LIFETIME: usize;

    /// The value at `x`, and half of its gradient.
    fn at(&self, x: &[f64]) -> (f64, Vec<f64>);

    /// Approximates half of the second derivative at `x`.
    fn renew(&mut self, x: &[f64]) -> Result<(), EmbedError>;

    /// `M^-1 v` for the last approximation `M`.
    fn precondition(&self, v: &mut [f64]);
}

/// What a descent has learnt of the curvature.
pub(crate) struct Descent {
    memory: Memory,
    /// Steps taken with the present approximation; `None` where there is none as yet.
    age: Option<usize>,
}

/// Where a descent ended.
pub(crate) struct Reached {
    pub x: Vec<f64>,
    pub iterations: usize,
    pub termination: Termination,
}

/// A place with the value there and half of its gradient.
struct Place {
    x: Vec<f64>,
    value: f64,
    gradient: Vec<f64>,
}

impl Descent {
    /// Nothing is known as yet.
    pub fn new() -> Self {
        Self { memory: Memory::default(), age: None }
    }

    /// Goes down from `x`. A value of at most `negligible` is converged; `go_on` is asked before every step.
    ///
    /// A descent that follows another one of an objective that has changed little takes over its approximation.
    pub fn run<O: Objective>(
        &mut self,
        objective: &mut O,
        x: Vec<f64>,
        stop: StopRule,
        negligible: f64,
        mut go_on: impl FnMut() -> bool,
    ) -> Result<Reached, EmbedError> {
        self.memory.clear();
        let mut here = Place::of(objective, x);
        let mut iterations = 0;
        let mut settled_before = false;
        let termination = loop {
            if here.value <= negligible {
                break Termination::Converged;
            }
            if iterations == stop.max_iterations {
                break Termination::IterationLimit;
            }
            if !go_on() {
                break Termination::Interrupted;
            }
            iterations += 1;
            let age = match self.age.filter(|&age| age < O::LIFETIME) {
                Some(age) => age,
                None => {
                    objective.renew(&here.x)?;
                    self.memory.clear();
                    0
                }
            };
            self.age = Some(age + 1);
            let downhill = paired(&here.gradient, &here.gradient, |g, _| -g);
            let mut step = self.memory.apply(downhill, |v, _| objective.precondition(v));
            let mut gained = 0.0;
            if let Some((next, length)) = here.along(objective, &step) {
                let last = std::mem::replace(&mut here, next);
                gained = last.value - here.value;
                step.iter_mut().for_each(|s| *s *= length);
                let mut steeper = last.gradient;
                change(&mut steeper, &here.gradient, |last, now| now - last);
                self.memory.remember(step, steeper);
            }
            let settled = gained <= stop.tolerance * here.value;
            // That an aged approximation gains nothing may be its own fault, and the first step of a fresh one
            // is often short.
            match (settled, age) {
                (true, 0) => {}
                (true, 1) if settled_before => break Termination::Converged,
                (true, _) => self.age = None,
                (false, _) if gained > FAR * here.value => self.age = None,
                (false, _) => {}
            }
            settled_before = settled;
        };
        Ok(Reached { x: here.x, iterations, termination })
    }
}

impl Place {
    fn of(objective: &impl Objective, x: Vec<f64>) -> Self {
        let (value, gradient) = objective.at(&x);
        Self { x, value, gradient }
    }

    /// As far along a direction as the value falls enough, the whole step if it can: where that leads, and the share
    /// of the step taken. `None` if even a step at the edge of rounding does not lower the value.
    fn along(&self, objective: &impl Objective, direction: &[f64]) -> Option<(Self, f64)> {
        let slope = 2.0 * dot(direction, &self.gradient);
        let mut length = 1.0;
        for _ in 0..SHORTENINGS {
            let next = Self::of(objective, paired(&self.x, direction, |x, s| x + length * s));
            if next.value <= self.value + KEPT * length * slope {
                return Some((next, length));
            }
            // The lowest point of the parabola through what is known.
            let lowest = -slope * length / (2.0 * (next.value - self.value - slope * length));
            length *= if lowest.is_nan() { 0.1 } else { lowest.clamp(0.1, 0.5) };
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `(x - 3)^2 + 100 (y - x^2)^2`, Rosenbrock's valley, with its lowest point at (3, 9).
    struct Valley {
        renewed: usize,
    }

    impl Objective for Valley {
        const LIFETIME: usize = 10;

        fn at(&self, x: &[f64]) -> (f64, Vec<f64>) {
            let (off, above) = (x[0] - 3.0, x[1] - x[0] * x[0]);
            (off * off + 100.0 * above * above, vec![off - 200.0 * above * x[0], 100.0 * above])
        }

        fn renew(&mut self, _: &[f64]) -> Result<(), EmbedError> {
            self.renewed += 1;
            Ok(())
        }

        fn precondition(&self, v: &mut [f64]) {
            v.iter_mut().zip([1.0, 0.01]).for_each(|(v, inverse)| *v *= inverse);
        }
    }

    const STOP: StopRule = StopRule { max_iterations: 500, tolerance: 1e-12 };

    #[test]
    fn it_finds_the_end_of_a_curved_valley() {
        let mut valley = Valley { renewed: 0 };
        let reached = Descent::new().run(&mut valley, vec![-1.0, 1.0], STOP, 1e-20, || true).unwrap();
        assert_eq!(reached.termination, Termination::Converged);
        assert!((reached.x[0] - 3.0).abs() < 1e-6 && (reached.x[1] - 9.0).abs() < 1e-5, "{:?}", reached.x);
        assert!(valley.renewed >= reached.iterations / 10, "{} of {}", valley.renewed, reached.iterations);
    }

    #[test]
    fn it_stops_at_once_where_it_is_told_to_and_where_nothing_is_left() {
        let mut valley = Valley { renewed: 0 };
        let mut asked = 0;
        let reached = Descent::new()
            .run(&mut valley, vec![0.0, 0.0], STOP, 0.0, || {
                asked += 1;
                asked < 3
            })
            .unwrap();
        assert_eq!((reached.termination, reached.iterations), (Termination::Interrupted, 2));
        let reached = Descent::new().run(&mut valley, vec![3.0, 9.0], STOP, 0.0, || true).unwrap();
        assert_eq!((reached.termination, reached.iterations), (Termination::Converged, 0));
        assert_eq!(reached.x, [3.0, 9.0]);
        let none = StopRule { max_iterations: 0, ..STOP };
        let reached = Descent::new().run(&mut valley, vec![0.0, 0.0], none, 0.0, || true).unwrap();
        assert_eq!((reached.termination, reached.iterations), (Termination::IterationLimit, 0));
    }
}
