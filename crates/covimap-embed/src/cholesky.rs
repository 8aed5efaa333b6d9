//! Sparse symmetric positive definite matrices, factored.
//!
//! `A = L L'` with the unknowns in the order of an [`Elimination`]. The columns of `L` come in runs (supernodes) with the
//! same rows below their triangle; each is a dense panel. Solves go over the panels ([`substitution`]), with the parts
//! of a large matrix at the same time.

use std::sync::Arc;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::perm::PermRef;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Par, Side, Spec};
use rayon::prelude::*;

use crate::EmbedError;

mod elimination;
mod substitution;

pub(crate) use elimination::Elimination;
use substitution::Runs;

/// Unknowns of one parallel task.
const CHUNK: usize = 1 << 15;

/// A symmetric positive definite sparse matrix with its Cholesky factor.
///
/// Factorisation runs on the calling thread: the parallel form is slower at these sizes, for most fronts are small.
pub(crate) struct Factored {
    structure: Arc<Structure>,
    values: Vec<f64>,
}

/// What factors of matrices with the same places of entries have in common.
struct Structure {
    symbolic: SymbolicCholesky<usize>,
    /// Unknown at each place of the elimination, and the place of each.
    order: Vec<usize>,
    places: Vec<usize>,
    runs: Runs,
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

    fn structure(&self) -> SymbolicSparseColMatRef<'_, usize> {
        SymbolicSparseColMatRef::new_checked(self.order(), self.order(), &self.starts, None, &self.rows)
    }

    /// The places of entries below the diagonal, as `(column, row)`, ascending.
    fn entries(&self) -> impl Iterator<Item = (u32, u32)> + Clone {
        (0..self.order()).flat_map(|column| {
            let own = self.starts[column] + 1..self.starts[column + 1];
            self.rows[own].iter().map(move |&row| (column as u32, row as u32))
        })
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

    /// Factors `A = L L'` in an order with little fill, and checks the factor on a known solution.
    pub fn new(matrix: &LowerTriangle) -> Result<Self, EmbedError> {
        Self::eliminated(matrix, Elimination::of(matrix.order(), matrix.entries())?)
    }

    /// As [`Factored::new`], in a given order.
    pub fn eliminated(matrix: &LowerTriangle, elimination: Elimination) -> Result<Self, EmbedError> {
        let n = matrix.order();
        let Elimination { order, places, parts } = elimination;
        // Any number of operations is above the threshold, zero too: the factor always comes in runs.
        let runs = SupernodalThreshold(-1.0);
        let symbolic = factorize_symbolic_cholesky(
            matrix.structure(),
            Side::Lower,
            SymmetricOrdering::Custom(PermRef::new_checked(&order, &places, n)),
            CholeskySymbolicParams { supernodal_flop_ratio_threshold: runs, ..Default::default() },
        )
        .map_err(|_| EmbedError::OutOfMemory { what: "ordering a sparse matrix", order: n })?;
        let runs = match symbolic.raw() {
            SymbolicCholeskyRaw::Supernodal(raw) => Runs::of(raw, &parts),
            // A matrix of order 0.
            SymbolicCholeskyRaw::Simplicial(_) => Runs::none(),
        };
        let structure = Arc::new(Structure { symbolic, order, places, runs });
        let factored = Self::numeric(structure, Vec::new(), matrix)?;
        factored.check(matrix)?;
        Ok(factored)
    }

    /// Factors another matrix with the same places of entries and entries of like size, without ordering anew and
    /// without a check.
    pub fn another(&self, matrix: &LowerTriangle) -> Result<Self, EmbedError> {
        Self::numeric(Arc::clone(&self.structure), Vec::new(), matrix)
    }

    /// As [`Factored::another`], in the memory of this one.
    pub fn refactor(self, matrix: &LowerTriangle) -> Result<Self, EmbedError> {
        Self::numeric(self.structure, self.values, matrix)
    }

    /// The factor, in the memory of `values`, whatever they are.
    fn numeric(
        structure: Arc<Structure>,
        mut values: Vec<f64>,
        matrix: &LowerTriangle,
    ) -> Result<Self, EmbedError> {
        let n = matrix.order();
        let symbolic = &structure.symbolic;
        let out_of_memory = EmbedError::OutOfMemory { what: "factoring a sparse matrix", order: n };
        let more = symbolic.len_val().saturating_sub(values.len());
        if values.try_reserve_exact(more).is_err() {
            return Err(out_of_memory);
        }
        values.resize(symbolic.len_val(), 0.0);
        let scratch = symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Spec::default());
        let Ok(mut memory) = MemBuffer::try_new(scratch) else { return Err(out_of_memory) };
        symbolic
            .factorize_numeric_llt(
                &mut values,
                SparseColMatRef::new(matrix.structure(), &matrix.values),
                Side::Lower,
                LltRegularization::default(),
                Par::Seq,
                MemStack::new(&mut memory),
                Spec::default(),
            )
            .map_err(|_| EmbedError::Singular { order: n })?;
        Ok(Self { structure, values })
    }

    fn check(&self, matrix: &LowerTriangle) -> Result<(), EmbedError> {
        let n = matrix.order();
        // A bounded, aperiodic probe: the fractional parts of multiples of the golden ratio.
        let probe: Vec<f64> = (0..n).map(|k| (k as f64 * 0.618_033_988_749_895).fract() - 0.5).collect();
        let wanted = matrix.times(&probe);
        let mut solved = wanted.clone();
        self.solve(solved.as_chunks_mut::<1>().0);
        let reached = matrix.times(&solved);
        let largest =
            |values: &mut dyn Iterator<Item = f64>| values.fold(0.0f64, |most, value| most.max(value.abs()));
        let miss = largest(&mut reached.iter().zip(&wanted).map(|(a, b)| a - b));
        let size = largest(&mut wanted.iter().copied());
        // Written so that a NaN fails the check.
        if miss <= Self::SOUND * size { Ok(()) } else { Err(EmbedError::Singular { order: n }) }
    }

    /// Replaces `K` right-hand sides, an unknown a row, by the solutions.
    pub fn solve<const K: usize>(&self, rows: &mut [[f64; K]]) {
        self.structure.solve(&self.values, rows);
    }
}

impl Structure {
    fn solve<const K: usize>(&self, values: &[f64], rows: &mut [[f64; K]]) {
        let in_order = self.order.par_iter().with_min_len(CHUNK).map(|&unknown| rows[unknown]);
        let mut in_order: Vec<[f64; K]> = in_order.collect();
        self.runs.substitute(values, &mut in_order);
        let own = rows.par_iter_mut().zip(&self.places).with_min_len(CHUNK);
        own.for_each(|(row, &place)| *row = in_order[place]);
    }
}

#[cfg(test)]
mod tests;
