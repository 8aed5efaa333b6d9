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
use crate::solve::{check_start, negligible_stress};
use crate::stress::raw_stress;
use crate::{EmbedError, Embedding, PairDistances, Point, StopRule, Termination};

/// Damping of the first step: starts are near enough for bold ones.
const FIRST_DAMPING: f64 = 1e-2;
/// Damping below which steps are plain Newton steps for all purposes.
const LEAST_DAMPING: f64 = 1e-9;
/// Damping above which no decrease is to be hoped for.
const MOST_DAMPING: f64 = 1e9;

/// Minimises the stress of `pairs` from `start` by damped Newton steps.
///
/// Every connected component stays about where its start was. Objects that coincide at the start
/// rest on each other as in [`smacof`](crate::smacof()).
///
/// # Errors
/// [`EmbedError::BadStart`] for a start that does not fit; [`EmbedError::Singular`] where the
/// weights are too different in size for the matrix to be factored; [`EmbedError::OutOfMemory`]
/// where the factor does not fit into memory.
pub fn newton(pairs: &PairDistances, start: &[Point], stop: StopRule) -> Result<Embedding, EmbedError> {
    newton_while(pairs, start, stop, || true)
}

/// As [`newton`], but asks before every step whether to go on; if not, the result is what was
/// reached, with [`Termination::Interrupted`].
///
/// # Errors
/// As [`newton`].
pub fn newton_while(
    pairs: &PairDistances,
    start: &[Point],
    stop: StopRule,
    mut go_on: impl FnMut() -> bool,
) -> Result<Embedding, EmbedError> {
    check_start(pairs, start)?;
    let mut points = start.to_vec();
    let mut stress = raw_stress(pairs, &points);
    let mut system = NormalEquations::new(pairs);
    let mut damping = Damping(FIRST_DAMPING);
    let negligible = negligible_stress(pairs);
    let mut iterations = 0;
    let termination = loop {
        if stress <= negligible || damping.hopeless() {
            break Termination::Converged;
        }
        if iterations == stop.max_iterations {
            break Termination::IterationLimit;
        }
        if !go_on() {
            break Termination::Interrupted;
        }
        iterations += 1;
        let Step { moved, promised } = system.step(pairs, &points, damping.0)?;
        let moved_stress = raw_stress(pairs, &moved);
        let gained = stress - moved_stress;
        // Written so that a NaN counts as a failed step.
        if gained >= 0.0 {
            let done = gained <= stop.tolerance * stress && damping.0 < 1.0;
            points = moved;
            stress = moved_stress;
            if done {
                break Termination::Converged;
            }
            damping.adapt(gained / promised);
        } else {
            damping.raise();
        }
    };
    Ok(Embedding::of_distances(pairs, points, iterations, termination))
}

/// `mu` after Levenberg and Marquardt.
struct Damping(f64);

impl Damping {
    /// After a step that kept this share of its promise.
    fn adapt(&mut self, kept: f64) {
        let factor = match kept {
            good if good > 0.7 => 0.1,
            poor if poor < 0.2 => 4.0,
            _ => 0.5,
        };
        self.0 = (self.0 * factor).max(LEAST_DAMPING);
    }

    /// After a step that would have raised the stress.
    fn raise(&mut self) {
        self.0 *= 10.0;
    }

    /// Whether steps are so short that rounding hides what they gain.
    fn hopeless(&self) -> bool {
        self.0 > MOST_DAMPING
    }
}

/// A step that is not taken yet.
struct Step {
    moved: Vec<Point>,
    /// Decrease of the stress that the damped quadratic promises.
    promised: f64,
}

/// The lower triangle of `H + mu V (x) I`, unknowns in the order `x_1 y_1 x_2 y_2 ..`.
struct NormalEquations {
    matrix: LowerTriangle,
    /// First entry of the 2 x 2 block of each pair: columns `2i` and `2i + 1`, rows `2j`, `2j + 1`.
    block_of_pair: Vec<[usize; 2]>,
    /// One object of each component, tied down against shifts.
    tied: Vec<bool>,
    /// The factor of the last step, whose ordering serves the next.
    factored: Option<Factored>,
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
        for (i, &count) in upper.iter().enumerate() {
            let own = &pairs.pairs()[at..at + count];
            at += count;
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
        Self { matrix: LowerTriangle { starts, rows, values }, block_of_pair, tied, factored: None }
    }

    /// Solves for the step from `points`.
    fn step(&mut self, pairs: &PairDistances, points: &[Point], damping: f64) -> Result<Step, EmbedError> {
        let gradient = self.assemble(pairs, points, damping);
        let factored = match self.factored.take() {
            None => Factored::new(&self.matrix),
            Some(last) => last.refactor(&self.matrix),
        }?;
        let mut step: Vec<f64> = gradient.iter().map(|g| -g).collect();
        factored.solve(&mut step, 1);
        self.factored = Some(factored);
        // The quadratic of half the stress falls by -g's / 2, that of the stress by twice that.
        let promised = gradient.iter().zip(&step).map(|(g, s)| -g * s).sum();
        let moved =
            points.iter().zip(step.chunks_exact(2)).map(|(p, s)| [p[0] + s[0], p[1] + s[1]]).collect();
        Ok(Step { moved, promised })
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

#[cfg(test)]
mod tests;
