//! The damped second derivative of the stress, eq. (1) of the parent module, and its factor.

use crate::cholesky::{Elimination, Factored, LowerTriangle};
use crate::laplacian::components;
use crate::{EmbedError, PairDistances, Point};

/// The lower triangle of `H + mu V (x) I`, unknowns in the order `x_1 y_1 x_2 y_2 ..`.
pub(crate) struct NormalEquations {
    pub(super) matrix: LowerTriangle,
    /// First entry of the 2 x 2 block of each pair: columns `2i` and `2i + 1`, rows `2j`, `2j + 1`.
    block_of_pair: Vec<[usize; 2]>,
    /// One object of each component, tied down against shifts.
    tied: Vec<bool>,
    /// The factor of the last step, whose ordering serves the next.
    factored: Option<Factored>,
}

impl NormalEquations {
    pub fn new(pairs: &PairDistances) -> Self {
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

    /// Factors the matrix at `points`.
    pub fn factor(
        &mut self,
        pairs: &PairDistances,
        points: &[Point],
        damping: f64,
    ) -> Result<(), EmbedError> {
        self.assemble(pairs, points, damping);
        self.factored = Some(match self.factored.take() {
            None => {
                // Both coordinates of an object have the same neighbours: the order of objects is good for them.
                let edges = pairs.pairs().iter().map(|pair| (pair.i, pair.j));
                let objects = Elimination::of(points.len(), edges)?;
                Factored::eliminated(&self.matrix, objects.in_blocks(2))
            }
            Some(last) => last.refactor(&self.matrix),
        }?);
        Ok(())
    }

    /// Replaces `K` right-hand sides, an unknown a row, by the solutions under the last factor.
    pub fn solve<const K: usize>(&self, rows: &mut [[f64; K]]) {
        self.factored.as_ref().expect("factored before it is solved (bug in covimap)").solve(rows);
    }

    /// Fills the matrix.
    pub(super) fn assemble(&mut self, pairs: &PairDistances, points: &[Point], damping: f64) {
        let n = points.len();
        let values = &mut self.matrix.values;
        let starts = &self.matrix.starts;
        values.fill(0.0);
        for (pair, block) in pairs.pairs().iter().zip(&self.block_of_pair) {
            let (i, j) = (pair.i as usize, pair.j as usize);
            let d = [points[i][0] - points[j][0], points[i][1] - points[j][1]];
            let r = (d[0] * d[0] + d[1] * d[1]).sqrt();
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
    }
}
