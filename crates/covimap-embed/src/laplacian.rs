//! The weighted Laplacian of a pair list, factored once.
//!
//! Majorisation solves `V X = Y` with the same `V = sum w_ij (e_i - e_j)(e_i - e_j)'` in every
//! step. `V` is singular: in each connected component it maps constants to zero. One object a
//! component is therefore tied to the origin by an extra diagonal entry. For a right-hand side
//! whose columns sum to zero in every component, which is all that majorisation asks for, the
//! tied solution solves the singular system exactly: summing the equations of a component leaves
//! `c x_tied = 0`.
//!
//! A complete list with equal weights `w` needs no factor: `V = w (n I - 11')`, so that the
//! centred solution is `Y / (w n)`.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side, Spec};

use crate::{EmbedError, PairDistances, Point};

mod substitution;

/// A symmetric positive definite sparse matrix with its Cholesky factor.
///
/// Factorisation and solves run on the calling thread: the parallel forms are slower at these
/// sizes, and their results would depend on the thread count.
pub(crate) struct Factored {
    symbolic: SymbolicCholesky<usize>,
    values: Vec<f64>,
}

/// Lower triangle by columns: ascending rows, the diagonal first.
pub(crate) struct LowerTriangle {
    pub starts: Vec<usize>,
    pub rows: Vec<usize>,
    pub values: Vec<f64>,
}

impl LowerTriangle {
    fn order(&self) -> usize {
        self.starts.len() - 1
    }

    /// `y = A x` for the symmetric matrix whose lower triangle this is.
    pub fn times(&self, x: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; x.len()];
        for column in 0..self.order() {
            for entry in self.starts[column]..self.starts[column + 1] {
                let (row, value) = (self.rows[entry], self.values[entry]);
                y[row] += value * x[column];
                if row != column {
                    y[column] += value * x[row];
                }
            }
        }
        y
    }
}

impl Factored {
    /// Largest relative residual of the probe solve that is taken for a sound factorisation.
    const SOUND: f64 = 1e-6;

    /// Factors `A = L L'` after an approximate minimum-degree ordering, and checks the factor on
    /// a known solution.
    pub fn new(matrix: &LowerTriangle) -> Result<Self, EmbedError> {
        Self::with_runs(matrix, SupernodalThreshold::AUTO)
    }

    /// As [`Factored::new`], in the form that [`Factored::solve_points`] takes.
    pub fn for_points(matrix: &LowerTriangle) -> Result<Self, EmbedError> {
        // Any number of operations is above the threshold, zero too.
        Self::with_runs(matrix, SupernodalThreshold(-1.0))
    }

    fn with_runs(matrix: &LowerTriangle, runs: SupernodalThreshold) -> Result<Self, EmbedError> {
        let n = matrix.order();
        let structure = SymbolicSparseColMatRef::new_checked(n, n, &matrix.starts, None, &matrix.rows);
        let symbolic = factorize_symbolic_cholesky(
            structure,
            Side::Lower,
            SymmetricOrdering::Amd,
            CholeskySymbolicParams { supernodal_flop_ratio_threshold: runs, ..Default::default() },
        )
        .map_err(|_| EmbedError::OutOfMemory { what: "ordering a sparse matrix", order: n })?;
        let factored = Self::numeric(symbolic, Vec::new(), matrix)?;
        factored.check(matrix)?;
        Ok(factored)
    }

    /// Factors another matrix with the same places of entries and entries of like size, without ordering anew and
    /// without a check.
    pub fn refactor(self, matrix: &LowerTriangle) -> Result<Self, EmbedError> {
        Self::numeric(self.symbolic, self.values, matrix)
    }

    /// The factor, in the memory of `values`, whatever they are.
    fn numeric(
        symbolic: SymbolicCholesky<usize>,
        mut values: Vec<f64>,
        matrix: &LowerTriangle,
    ) -> Result<Self, EmbedError> {
        let n = matrix.order();
        let out_of_memory = EmbedError::OutOfMemory { what: "factoring a sparse matrix", order: n };
        let more = symbolic.len_val().saturating_sub(values.len());
        if values.try_reserve_exact(more).is_err() {
            return Err(out_of_memory);
        }
        values.resize(symbolic.len_val(), 0.0);
        let structure = SymbolicSparseColMatRef::new_checked(n, n, &matrix.starts, None, &matrix.rows);
        let scratch = symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Spec::default());
        let Ok(mut memory) = MemBuffer::try_new(scratch) else { return Err(out_of_memory) };
        symbolic
            .factorize_numeric_llt(
                &mut values,
                SparseColMatRef::new(structure, &matrix.values),
                Side::Lower,
                LltRegularization::default(),
                Par::Seq,
                MemStack::new(&mut memory),
                Spec::default(),
            )
            .map_err(|_| EmbedError::Singular { order: n })?;
        Ok(Self { symbolic, values })
    }

    fn check(&self, matrix: &LowerTriangle) -> Result<(), EmbedError> {
        let n = matrix.order();
        // A bounded, aperiodic probe: the fractional parts of multiples of the golden ratio.
        let probe: Vec<f64> = (0..n).map(|k| (k as f64 * 0.618_033_988_749_895).fract() - 0.5).collect();
        let wanted = matrix.times(&probe);
        let mut solved = wanted.clone();
        self.solve(&mut solved, 1);
        let reached = matrix.times(&solved);
        let largest =
            |values: &mut dyn Iterator<Item = f64>| values.fold(0.0f64, |most, value| most.max(value.abs()));
        let miss = largest(&mut reached.iter().zip(&wanted).map(|(a, b)| a - b));
        let size = largest(&mut wanted.iter().copied());
        // Written so that a NaN fails the check.
        if miss <= Self::SOUND * size { Ok(()) } else { Err(EmbedError::Singular { order: n }) }
    }

    /// Replaces the `columns` columns of `rhs` (column-major) by the solutions.
    pub fn solve(&self, rhs: &mut [f64], columns: usize) {
        let n = self.symbolic.nrows();
        let mut memory = MemBuffer::new(self.symbolic.solve_in_place_scratch::<f64>(columns, Par::Seq));
        LltRef::new(&self.symbolic, &self.values).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(rhs, n, columns),
            Par::Seq,
            MemStack::new(&mut memory),
        );
    }

    /// The solution for a right-hand side of a point a row.
    pub fn solve_points(&self, y: &[Point]) -> Vec<Point> {
        let SymbolicCholeskyRaw::Supernodal(symbolic) = self.symbolic.raw() else {
            // A matrix of order 0.
            return y.to_vec();
        };
        let order = self.symbolic.perm().map(|order| order.arrays().0);
        let object = |row: usize| order.map_or(row, |order| order[row]);
        let mut rows: Vec<Point> = (0..y.len()).map(|row| y[object(row)]).collect();
        substitution::substitute(symbolic, &self.values, &mut rows);
        let mut solution = vec![[0.0; 2]; y.len()];
        rows.into_iter().enumerate().for_each(|(row, point)| solution[object(row)] = point);
        solution
    }
}

/// `V` of a weighted pair list, ready for solves, with the components that it falls into.
pub(crate) struct Laplacian {
    inverse: Inverse,
    /// Component of each object.
    component: Vec<u32>,
    /// Number of objects in each component.
    sizes: Vec<u32>,
}

/// How `V` is inverted on right-hand sides that sum to zero in every component.
enum Inverse {
    /// By this factor: all pairs weigh the same.
    Factor(f64),
    /// By the factor of the tied Laplacian.
    Factored(Box<Factored>),
}

impl Laplacian {
    /// The Laplacian of a pair list: in closed form where it exists, factored otherwise.
    pub fn of(pairs: &PairDistances) -> Result<Self, EmbedError> {
        let n = pairs.objects();
        if let Some(weight) = pairs.complete_weight() {
            let factor = 1.0 / (n as f64 * weight);
            return Ok(Self {
                inverse: Inverse::Factor(factor),
                component: vec![0; n],
                sizes: vec![n as u32],
            });
        }
        let edges: Vec<_> = pairs.pairs().iter().map(|pair| (pair.i, pair.j, pair.weight)).collect();
        Self::new(n, &edges)
    }

    /// Factors the Laplacian of `n` objects and weighted edges `(i, j, w)`, `i < j`, ascending.
    pub fn new(n: usize, edges: &[(u32, u32, f64)]) -> Result<Self, EmbedError> {
        let (component, sizes) = components(n, edges.iter().map(|&(i, j, _)| (i, j)));
        let factored = Factored::for_points(&tied_laplacian(n, edges, &component))?;
        Ok(Self { inverse: Inverse::Factored(Box::new(factored)), component, sizes })
    }

    /// Component of each object, numbered by its first object.
    pub fn component(&self) -> &[u32] {
        &self.component
    }

    /// Number of components.
    pub fn components(&self) -> usize {
        self.sizes.len()
    }

    /// Solves `V X = Y` for a `Y` that sums to zero in every component; the solution is centred
    /// at the origin in every component.
    pub fn solve(&self, y: &[Point]) -> Vec<Point> {
        let mut solution = match &self.inverse {
            Inverse::Factor(factor) => y.iter().map(|point| point.map(|value| factor * value)).collect(),
            Inverse::Factored(factored) => factored.solve_points(y),
        };
        self.centre(&mut solution);
        solution
    }

    /// Moves every component to the origin.
    pub fn centre(&self, points: &mut [Point]) {
        let mut centres = vec![[0.0; 2]; self.sizes.len()];
        for (point, &component) in points.iter().zip(&self.component) {
            let centre = &mut centres[component as usize];
            centre[0] += point[0];
            centre[1] += point[1];
        }
        for (point, &component) in points.iter_mut().zip(&self.component) {
            let size = f64::from(self.sizes[component as usize]);
            point[0] -= centres[component as usize][0] / size;
            point[1] -= centres[component as usize][1] / size;
        }
    }
}

/// Component of each object, numbered by its first object, and the size of each component.
pub(crate) fn components(n: usize, edges: impl Iterator<Item = (u32, u32)>) -> (Vec<u32>, Vec<u32>) {
    let mut parent: Vec<u32> = (0..n as u32).collect();
    fn root(parent: &mut [u32], mut node: u32) -> u32 {
        while parent[node as usize] != node {
            parent[node as usize] = parent[parent[node as usize] as usize];
            node = parent[node as usize];
        }
        node
    }
    for (i, j) in edges {
        let (a, b) = (root(&mut parent, i), root(&mut parent, j));
        parent[a.max(b) as usize] = a.min(b);
    }
    let mut component = vec![0; n];
    let mut sizes = Vec::new();
    for node in 0..n as u32 {
        let top = root(&mut parent, node);
        if top == node {
            component[node as usize] = sizes.len() as u32;
            sizes.push(0);
        } else {
            component[node as usize] = component[top as usize];
        }
        sizes[component[node as usize] as usize] += 1;
    }
    (component, sizes)
}

/// Lower triangle of `V` plus the tie of the last object of each component.
pub(crate) fn tied_laplacian(n: usize, edges: &[(u32, u32, f64)], component: &[u32]) -> LowerTriangle {
    let mut diagonal = vec![0.0; n];
    let mut starts = vec![0; n + 1];
    for &(i, j, weight) in edges {
        diagonal[i as usize] += weight;
        diagonal[j as usize] += weight;
        starts[i as usize + 1] += 1;
    }
    let mut last_of = vec![0; n];
    for (node, &c) in component.iter().enumerate() {
        last_of[c as usize] = node;
        starts[node + 1] += starts[node] + 1;
    }
    let mut rows = vec![0; n + edges.len()];
    let mut values = vec![0.0; n + edges.len()];
    let mut at = 0;
    for node in 0..n {
        let place = starts[node];
        rows[place] = node;
        values[place] = diagonal[node];
        if last_of[component[node] as usize] == node {
            // A component of one object has no edge; any positive entry will do.
            values[place] = if diagonal[node] > 0.0 { 2.0 * diagonal[node] } else { 1.0 };
        }
        for entry in place + 1..starts[node + 1] {
            let (_, j, weight) = edges[at];
            rows[entry] = j as usize;
            values[entry] = -weight;
            at += 1;
        }
    }
    LowerTriangle { starts, rows, values }
}

#[cfg(test)]
mod tests;
