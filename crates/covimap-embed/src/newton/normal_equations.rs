//! The damped second derivative of the stress, eq. (1) of the parent module, and its factor.

use crate::cholesky::{LowerTriangle, SparseCholesky};
use crate::laplacian::components;
use crate::{EmbedError, PairDistances, Point};

/// The lower triangle of `H + mu V (x) I`, unknowns in the order `x_1 y_1 x_2 y_2 ..`.
pub(crate) struct NormalEquations {
    pub(super) matrix: LowerTriangle<2>,
    /// One object of each component, tied down against shifts.
    tied: Vec<bool>,
    /// The factor of the last step, whose ordering serves the next.
    factored: Option<SparseCholesky<2>>,
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
        let mut starts = Vec::with_capacity(n + 1);
        let mut rows = Vec::with_capacity(n + pairs.pairs().len());
        let mut left = pairs.pairs().iter().peekable();
        for object in 0..n as u32 {
            starts.push(rows.len() as u32);
            rows.push(object);
            while let Some(pair) = left.next_if(|pair| pair.i == object) {
                rows.push(pair.j);
            }
        }
        starts.push(rows.len() as u32);
        let blocks = vec![[[0.0; 2]; 2]; rows.len()];
        Self { matrix: LowerTriangle { starts, rows, blocks }, tied, factored: None }
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
            None => SparseCholesky::new(&self.matrix),
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
        let LowerTriangle { starts, blocks, .. } = &mut self.matrix;
        let diagonal = |object: u32| starts[object as usize] as usize;
        (0..points.len() as u32).for_each(|object| blocks[diagonal(object)] = [[0.0; 2]; 2]);
        // The blocks of a column are the diagonal and then the pairs of the object with later ones, in their order.
        for (k, pair) in pairs.pairs().iter().enumerate() {
            let [from, to] = [pair.i, pair.j].map(|object| points[object as usize]);
            let d = [from[0] - to[0], from[1] - to[1]];
            let r = (d[0] * d[0] + d[1] * d[1]).sqrt();
            let (u, ratio) =
                if r > 0.0 { ([d[0] / r, d[1] / r], pair.distance / r) } else { ([0.0; 2], 1.0) };
            let across = (1.0 - ratio).max(0.0);
            let along = 1.0 - across;
            let block = [0, 1].map(|a| {
                [0, 1].map(|b| {
                    pair.weight * (along * u[a] * u[b] + if a == b { across + damping } else { 0.0 })
                })
            });
            for object in [pair.i, pair.j] {
                let own = &mut blocks[diagonal(object)];
                *own = [0, 1].map(|a| [0, 1].map(|b| own[a][b] + block[a][b]));
            }
            blocks[k + pair.i as usize + 1] = block.map(|row| row.map(|k| -k));
        }
        for (object, &tied) in (0..).zip(&self.tied) {
            let own = &mut blocks[diagonal(object)];
            let [x, y] = [own[0][0], own[1][1]];
            // Against the free turn of the whole (a relative nudge), and for objects without a pair.
            let nudge = 1e-9 * (x + y);
            let tie = if tied { x + y + f64::from(u8::from(x <= 0.0)) } else { 0.0 };
            own[0][0] += nudge + tie;
            own[1][1] += nudge + tie;
        }
    }
}
