//! Damped Newton steps on the stress, for configurations that are right but for a smooth bend.
//!
//! Majorisation measures a step by `V`, in which turning one half of a long corridor against the
//! other is expensive although it changes no known distance; it needs a number of steps that
//! grows with the square of the length. Newton's quadratic knows which distances a move really
//! changes. Per pair, with `u = (x_i - x_j) / r`, the second derivative is
//! `w [u u' + (1 - d/r) (I - u u')]`; the second term is negative for pairs that are too short
//! and is dropped there, which keeps the sum positive semidefinite. Damping adds
//! `mu V (x) I`, so that a large `mu` gives (short) majorisation steps:
//!
//! `(H + mu V (x) I) s = -g`, `mu` after Levenberg and Marquardt from the ratio of the real to
//! the promised decrease.
//!
//! # Complexity
//! A sparse Cholesky factorisation of order `2 n` a step; the ordering is found once.

use crate::laplacian::{Factored, LowerTriangle, components};
use crate::solve::check_start;
use crate::stress::raw_stress;
use crate::{EmbedError, Embedding, PairDistances, Point, StopRule, Termination};

/// Damping below which steps are plain Newton steps for all purposes.
const LEAST_DAMPING: f64 = 1e-9;
/// Damping above which no decrease is to be hoped for.
const MOST_DAMPING: f64 = 1e9;

/// Minimises the stress of `pairs` from `start` by damped Newton steps.
///
/// # Errors
/// [`EmbedError::BadStart`] for a start that does not fit; [`EmbedError::OutOfMemory`] where the
/// factor does not fit into memory.
pub fn newton(pairs: &PairDistances, start: &[Point], stop: StopRule) -> Result<Embedding, EmbedError> {
    check_start(pairs, start)?;
    let mut points = start.to_vec();
    let mut stress = raw_stress(pairs, &points);
    let mut system = NormalEquations::new(pairs);
    let mut factored: Option<Factored> = None;
    let mut damping = 1e-2;
    let mut termination = Termination::IterationLimit;
    let mut iterations = 0;
    while iterations < stop.max_iterations {
        iterations += 1;
        let gradient = system.assemble(pairs, &points, damping);
        let factor = match factored.take() {
            None => Factored::new(&system.matrix),
            Some(old) => old.refactor(&system.matrix),
        }?;
        let mut step: Vec<f64> = gradient.iter().map(|g| -g).collect();
        factor.solve(&mut step, 1);
        factored = Some(factor);
        let moved: Vec<Point> =
            points.iter().enumerate().map(|(i, p)| [p[0] + step[2 * i], p[1] + step[2 * i + 1]]).collect();
        let moved_stress = raw_stress(pairs, &moved);
        // Half of -g's: the decrease of the damped quadratic; g is the gradient of stress / 2.
        let promised: f64 = gradient.iter().zip(&step).map(|(g, s)| -g * s).sum();
        let gained = stress - moved_stress;
        // Written so that a NaN counts as a failed step.
        if gained >= 0.0 {
            let done = gained <= stop.tolerance * stress && damping < 1.0;
            points = moved;
            stress = moved_stress;
            damping = (damping
                * if gained > 0.7 * promised {
                    0.1
                } else if gained < 0.2 * promised {
                    4.0
                } else {
                    0.5
                })
            .max(LEAST_DAMPING);
            if done {
                termination = Termination::Converged;
                break;
            }
        } else {
            damping *= 10.0;
            if damping > MOST_DAMPING {
                termination = Termination::Converged;
                break;
            }
        }
    }
    Ok(Embedding::of_distances(pairs, points, iterations, termination))
}

/// The lower triangle of `H + mu V (x) I`, unknowns in the order `x_1 y_1 x_2 y_2 ..`.
struct NormalEquations {
    matrix: LowerTriangle,
    /// First entry of the 2 x 2 block of each pair: columns `2i` and `2i + 1`, rows `2j`, `2j + 1`.
    block_of_pair: Vec<[usize; 2]>,
    /// One object of each component, tied down against shifts.
    tied: Vec<bool>,
}

impl NormalEquations {
    fn new(pairs: &PairDistances) -> Self {
        let n = pairs.objects();
        let (component, sizes) = components(n, pairs.pairs().iter().map(|pair| (pair.i, pair.j)));
        let mut tied = vec![false; n];
        let mut seen = vec![false; sizes.len()];
        for (node, &c) in component.iter().enumerate() {
            tied[node] = !std::mem::replace(&mut seen[c as usize], true);
        }
        let mut upper = vec![0; n];
        for pair in pairs.pairs() {
            upper[pair.i as usize] += 1;
        }
        let mut starts = vec![0];
        let mut rows = Vec::with_capacity(3 * n + 4 * pairs.pairs().len());
        let mut block_of_pair = Vec::with_capacity(pairs.pairs().len());
        let mut at = 0;
        for i in 0..n {
            let own = &pairs.pairs()[at..at + upper[i]];
            at += upper[i];
            let first = rows.len();
            rows.extend([2 * i, 2 * i + 1]);
            rows.extend(own.iter().flat_map(|pair| [2 * pair.j as usize, 2 * pair.j as usize + 1]));
            starts.push(rows.len());
            let second = rows.len();
            rows.push(2 * i + 1);
            rows.extend(own.iter().flat_map(|pair| [2 * pair.j as usize, 2 * pair.j as usize + 1]));
            starts.push(rows.len());
            block_of_pair.extend((0..own.len()).map(|k| [first + 2 + 2 * k, second + 1 + 2 * k]));
        }
        let values = vec![0.0; rows.len()];
        Self { matrix: LowerTriangle { starts, rows, values }, block_of_pair, tied }
    }

    /// Fills the matrix and returns the gradient of half the stress.
    fn assemble(&mut self, pairs: &PairDistances, points: &[Point], damping: f64) -> Vec<f64> {
        let n = points.len();
        let values = &mut self.matrix.values;
        let starts = &self.matrix.starts;
        values.fill(0.0);
        let mut gradient = vec![0.0; 2 * n];
        for (pair, block) in pairs.pairs().iter().zip(&self.block_of_pair) {
            let (i, j) = (pair.i as usize, pair.j as usize);
            let d = [points[i][0] - points[j][0], points[i][1] - points[j][1]];
            let r = d[0].hypot(d[1]);
            let (u, ratio) =
                if r > 0.0 { ([d[0] / r, d[1] / r], pair.distance / r) } else { ([0.0; 2], 1.0) };
            let across = (1.0 - ratio).max(0.0);
            let along = 1.0 - across;
            let k = |a: usize, b: usize| {
                pair.weight * (along * u[a] * u[b] + if a == b { across + damping } else { 0.0 })
            };
            for object in [i, j] {
                values[starts[2 * object]] += k(0, 0);
                values[starts[2 * object] + 1] += k(0, 1);
                values[starts[2 * object + 1]] += k(1, 1);
            }
            values[block[0]] = -k(0, 0);
            values[block[0] + 1] = -k(0, 1);
            values[block[1]] = -k(0, 1);
            values[block[1] + 1] = -k(1, 1);
            for axis in 0..2 {
                let pull = pair.weight * (r - pair.distance) * u[axis];
                gradient[2 * i + axis] += pull;
                gradient[2 * j + axis] -= pull;
            }
        }
        for object in 0..n {
            let (x, y) = (starts[2 * object], starts[2 * object + 1]);
            // Against the free turn of the whole (a relative nudge), and for objects without a pair.
            let nudge = 1e-9 * (values[x] + values[y]);
            let tie = if self.tied[object] {
                values[x] + values[y] + f64::from(u8::from(values[x] <= 0.0))
            } else {
                0.0
            };
            values[x] += nudge + tie;
            values[y] += nudge + tie;
        }
        gradient
    }
}
