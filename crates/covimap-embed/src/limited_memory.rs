//! What the last steps of a descent tell of the curvature: the limited-memory recursion of Broyden,
//! Fletcher, Goldfarb and Shanno.
//!
//! # References
//! D. C. Liu, J. Nocedal, "On the limited memory BFGS method for large scale optimization",
//! Mathematical Programming 45, 1989.

use std::collections::VecDeque;

use rayon::prelude::*;

/// Steps that are remembered.
pub(crate) const REMEMBERED: usize = 8;
/// Steps with less curvature than this share of `|step| |change|` are not remembered.
const CURVED: f64 = 1e-10;

/// Numbers of one parallel task.
const CHUNK: usize = 1 << 15;

/// The last steps, each with the change of the gradient that it brought; the newest last.
#[derive(Default)]
pub(crate) struct Memory {
    steps: VecDeque<Remembered>,
}

struct Remembered {
    step: Vec<f64>,
    change: Vec<f64>,
    /// `1 / step'change`.
    inverse_curvature: f64,
}

impl Memory {
    pub fn clear(&mut self) {
        self.steps.clear();
    }

    /// Remembers a step, and forgets the oldest of too many. One along which the slope does not rise says
    /// nothing of a minimum and is left out, so that the recursion stays positive definite. Tells whether it was
    /// taken.
    pub fn remember(&mut self, step: Vec<f64>, change: Vec<f64>) -> bool {
        let curvature = dot(&step, &change);
        let taken = curvature > CURVED * (dot(&step, &step) * dot(&change, &change)).sqrt();
        if taken {
            if self.steps.len() == REMEMBERED {
                self.steps.pop_front();
            }
            self.steps.push_back(Remembered { step, change, inverse_curvature: 1.0 / curvature });
        }
        taken
    }

    /// The change `y` of the gradient along the newest step, and `1 / step'y`.
    pub fn newest(&self) -> Option<(&[f64], f64)> {
        self.steps.back().map(|newest| (newest.change.as_slice(), newest.inverse_curvature))
    }

    /// `B v`, `B` being the inverse second derivative that the steps tell of, built upon an approximation of the
    /// same. `precondition` replaces `v` less the shares of the changes, one a step with the newest first, by what that
    /// approximation makes of it.
    pub fn apply(&self, mut v: Vec<f64>, precondition: impl FnOnce(&mut [f64], &[f64])) -> Vec<f64> {
        let mut shares = Vec::with_capacity(self.steps.len());
        let mut back = self.steps.iter().rev().peekable();
        let mut along = back.peek().map(|newest| dot(&newest.step, &v));
        while let (Some(past), Some(product)) = (back.next(), along) {
            let share = past.inverse_curvature * product;
            shares.push(share);
            along =
                add_and_dot(&mut v, -share, &past.change, back.peek().map(|before| before.step.as_slice()));
        }
        precondition(&mut v, &shares);
        let mut forth = self.steps.iter().zip(shares.into_iter().rev()).peekable();
        let mut along = forth.peek().map(|(oldest, _)| dot(&oldest.change, &v));
        while let (Some((past, share)), Some(product)) = (forth.next(), along) {
            let by = share - past.inverse_curvature * product;
            along = add_and_dot(&mut v, by, &past.step, forth.peek().map(|(next, _)| next.change.as_slice()));
        }
        v
    }
}

/// `a += factor b`, and then the inner product of `a` with `with`, if that is asked for, in one pass: of large vectors
/// it is the reading that takes time.
fn add_and_dot(a: &mut [f64], factor: f64, b: &[f64], with: Option<&[f64]>) -> Option<f64> {
    let Some(with) = with else {
        add(a, factor, b);
        return None;
    };
    let both = |((a, b), with): ((&mut [f64], &[f64]), &[f64])| {
        a.iter_mut().zip(b).for_each(|(a, b)| *a += factor * b);
        of_chunk(with, a)
    };
    if a.len() <= CHUNK {
        return Some(both(((a, b), with)));
    }
    let chunks = a.par_chunks_mut(CHUNK).zip(b.par_chunks(CHUNK)).zip(with.par_chunks(CHUNK));
    Some(chunks.map(both).collect::<Vec<f64>>().iter().sum())
}

/// Inner product of a chunk, in four interleaved sums that need not wait for each other.
fn of_chunk(a: &[f64], b: &[f64]) -> f64 {
    let ((a, rest_a), (b, rest_b)) = (a.as_chunks::<4>(), b.as_chunks::<4>());
    let mut sums = [0.0; 4];
    for (a, b) in a.iter().zip(b) {
        sums = std::array::from_fn(|k| sums[k] + a[k] * b[k]);
    }
    let rest = rest_a.iter().zip(rest_b).map(|(a, b)| a * b).sum::<f64>();
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest
}

/// Inner product, chunk by chunk.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    if a.len() <= CHUNK {
        return of_chunk(a, b);
    }
    let pairs = a.par_chunks(CHUNK).zip(b.par_chunks(CHUNK));
    pairs.map(|(a, b)| of_chunk(a, b)).collect::<Vec<f64>>().iter().sum()
}

/// `f(a_k, b_k)` for all `k`.
pub(crate) fn paired(a: &[f64], b: &[f64], f: impl Fn(f64, f64) -> f64 + Sync) -> Vec<f64> {
    a.par_iter().zip(b).with_min_len(CHUNK).map(|(&a, &b)| f(a, b)).collect()
}

/// `a_k = f(a_k, b_k)` for all `k`.
pub(crate) fn change(a: &mut [f64], b: &[f64], f: impl Fn(f64, f64) -> f64 + Sync) {
    let change = |(a, b): (&mut [f64], &[f64])| a.iter_mut().zip(b).for_each(|(a, &b)| *a = f(*a, b));
    if a.len() <= CHUNK {
        return change((a, b));
    }
    a.par_chunks_mut(CHUNK).zip(b.par_chunks(CHUNK)).for_each(change);
}

/// `a += factor b`.
pub(crate) fn add(a: &mut [f64], factor: f64, b: &[f64]) {
    change(a, b, |a, b| a + factor * b);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Second derivative of a small quadratic, and its diagonal as a preconditioner.
    const MATRIX: [[f64; 3]; 3] = [[4.0, 1.0, 0.0], [1.0, 3.0, -1.0], [0.0, -1.0, 2.0]];

    fn times(v: &[f64]) -> Vec<f64> {
        MATRIX.iter().map(|row| dot(row, v)).collect()
    }

    fn by_diagonal(v: &mut [f64], _shares: &[f64]) {
        v.iter_mut().zip(MATRIX).enumerate().for_each(|(k, (v, row))| *v /= row[k]);
    }

    fn remembering(steps: &[[f64; 3]]) -> Memory {
        let mut memory = Memory::default();
        for step in steps {
            assert!(memory.remember(step.to_vec(), times(step)));
        }
        memory
    }

    #[test]
    fn without_steps_it_is_the_preconditioner() {
        assert_eq!(Memory::default().apply(vec![4.0, 6.0, 8.0], by_diagonal), [1.0, 2.0, 4.0]);
    }

    #[test]
    fn the_last_step_is_answered_with_itself() {
        // The secant equation: B (change of the gradient) = step.
        let memory = remembering(&[[1.0, 0.0, 2.0], [0.5, -1.0, 0.25]]);
        let answer = memory.apply(times(&[0.5, -1.0, 0.25]), by_diagonal);
        for (got, wanted) in answer.iter().zip([0.5, -1.0, 0.25]) {
            assert!((got - wanted).abs() < 1e-14, "{answer:?}");
        }
    }

    #[test]
    fn conjugate_steps_in_all_directions_tell_everything() {
        // e1, e2 - e1 / 4 and the third made orthogonal to both under the matrix:
        // b'A e3 = -1 and b'A b = 11/4 for b = e2 - e1 / 4, thus e3 + 4/11 b.
        let memory = remembering(&[[1.0, 0.0, 0.0], [-0.25, 1.0, 0.0], [-1.0 / 11.0, 4.0 / 11.0, 1.0]]);
        let wanted = [0.3, -2.0, 1.5];
        let answer = memory.apply(times(&wanted), by_diagonal);
        for (got, wanted) in answer.iter().zip(wanted) {
            assert!((got - wanted).abs() < 1e-12, "{answer:?}");
        }
    }

    #[test]
    fn steps_along_which_the_slope_falls_are_left_out() {
        let mut memory = Memory::default();
        assert!(!memory.remember(vec![1.0, 0.0, 0.0], vec![-1.0, 0.0, 0.0]));
        assert!(!memory.remember(vec![0.0; 3], vec![0.0; 3]));
        assert!(memory.steps.is_empty());
        for k in 0..2 * REMEMBERED {
            memory.remember(vec![1.0, k as f64, 0.0], vec![1.0, k as f64, 0.0]);
        }
        assert_eq!(memory.steps.len(), REMEMBERED);
        assert_eq!(memory.steps[0].step[1], REMEMBERED as f64);
    }
}
