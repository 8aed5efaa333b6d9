//! Sparse symmetric positive definite matrices, factored.
//!
//! `A = L L'` with the objects in the order of an [`Elimination`]. The columns of `L` come in runs (supernodes) with the
//! same rows below their triangle; each is a dense [panel](panels). They are [factored](factorisation) and
//! [solved with](substitution) run by run, the parts of a large matrix at the same time.

use faer::Side;
use faer::perm::PermRef;
use faer::sparse::SymbolicSparseColMatRef;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, SymbolicCholeskyRaw, SymmetricOrdering, factorize_symbolic_cholesky,
};
use rayon::prelude::*;

use crate::EmbedError;

mod elimination;
mod factorisation;
mod folded;
mod panels;
mod substitution;

pub(crate) use elimination::Elimination;
use folded::Folded;
use panels::Panels;

/// Unknowns of one parallel task.
const CHUNK: usize = 1 << 15;

/// The Cholesky factor of a sparse symmetric positive definite matrix of `B` unknowns an object: `A = L L'`.
///
/// The objects are eliminated in an order of little fill (approximate minimum degree). The same matrix gives the same bits for any
/// number of threads.
///
/// ```
/// use covimap_embed::{LowerTriangle, SparseCholesky};
///
/// // [[4, -1, 0], [-1, 3, -1], [0, -1, 2]]
/// let blocks = [4.0, -1.0, 3.0, -1.0, 2.0].map(|value| [[value]]).to_vec();
/// let matrix = LowerTriangle { starts: vec![0, 2, 4, 5], rows: vec![0, 1, 1, 2, 2], blocks };
/// let mut solution = [[2.0], [2.0], [4.0]];
/// SparseCholesky::new(&matrix)?.solve(&mut solution);
/// assert!(solution.iter().zip([1.0, 2.0, 3.0]).all(|([x], wanted)| (x - wanted).abs() < 1e-12));
/// # Ok::<(), covimap_embed::EmbedError>(())
/// ```
pub struct SparseCholesky<const B: usize> {
    structure: Structure,
    values: Vec<f64>,
}

/// What factors of matrices with the same places of entries have in common.
struct Structure {
    /// Object at each place of the elimination, and the place of each.
    order: Vec<u32>,
    places: Vec<u32>,
    folded: Folded,
    panels: Panels,
}

/// The lower triangle of a symmetric matrix by columns, in blocks of `B` by `B`: an object has `B` unknowns, the one after the other.
///
/// `blocks[k][a][b]` is the entry in row `B rows[k] + a` and column `B c + b` of the matrix, `c` being the column of block
/// `k`. Blocks of the diagonal are whole, and symmetric.
#[derive(Debug, Clone, PartialEq)]
pub struct LowerTriangle<const B: usize> {
    /// Where the blocks of each column start, and at last their number.
    pub starts: Vec<u32>,
    /// Row of each block, ascending within a column; the first one is that of the diagonal, and all must have it.
    pub rows: Vec<u32>,
    /// As `rows` has them.
    pub blocks: Vec<[[f64; B]; B]>,
}

impl<const B: usize> LowerTriangle<B> {
    /// Number of objects.
    fn objects(&self) -> usize {
        self.starts.len() - 1
    }

    /// Number of unknowns.
    fn order(&self) -> usize {
        B * self.objects()
    }

    /// The blocks of a column.
    fn column(&self, column: usize) -> std::ops::Range<usize> {
        self.starts[column] as usize..self.starts[column + 1] as usize
    }

    /// The places of blocks below the diagonal, as `(column, row)`, ascending.
    fn edges(&self) -> impl Iterator<Item = (u32, u32)> + Clone {
        (0..self.objects()).flat_map(move |column| {
            let below = self.column(column).skip(1);
            below.map(move |entry| (column as u32, self.rows[entry]))
        })
    }

    /// `y = A x` for the symmetric matrix whose lower triangle this is.
    pub fn times(&self, x: &[f64]) -> Vec<f64> {
        let x: &[[f64; B]] = x.as_chunks().0;
        let mut y = vec![[0.0; B]; x.len()];
        let product = |block: &[[f64; B]; B], x: [f64; B]| {
            block.map(|row| row.iter().zip(x).map(|(a, x)| a * x).sum::<f64>())
        };
        let add = |y: &mut [f64; B], more: [f64; B]| y.iter_mut().zip(more).for_each(|(y, more)| *y += more);
        for column in 0..self.objects() {
            for entry in self.column(column) {
                let (row, block) = (self.rows[entry] as usize, &self.blocks[entry]);
                add(&mut y[row], product(block, x[column]));
                if row != column {
                    add(&mut y[column], product(&transposed(block), x[row]));
                }
            }
        }
        y.into_flattened()
    }
}

/// A block with rows for columns.
fn transposed<const B: usize>(block: &[[f64; B]; B]) -> [[f64; B]; B] {
    std::array::from_fn(|a| std::array::from_fn(|b| block[b][a]))
}

impl<const B: usize> SparseCholesky<B> {
    /// Largest relative residual of the probe solve that is taken for a sound factorisation.
    const SOUND: f64 = 1e-6;

    /// Factors a matrix in an order with little fill, and checks the factor on a known solution.
    ///
    /// # Errors
    /// [`EmbedError::Singular`] for a matrix that is not positive definite to the accuracy of the numbers;
    /// [`EmbedError::OutOfMemory`].
    pub fn new(matrix: &LowerTriangle<B>) -> Result<Self, EmbedError> {
        let structure = Structure::of(matrix)?;
        let factored = Self::numeric(structure, Vec::new(), matrix)?;
        factored.check(matrix)?;
        Ok(factored)
    }

    /// Factors another matrix with the same places of entries and entries of like size, without ordering anew and
    /// without a check, in the memory of this factor.
    ///
    /// # Errors
    /// As [`SparseCholesky::new`].
    pub fn refactor(self, matrix: &LowerTriangle<B>) -> Result<Self, EmbedError> {
        Self::numeric(self.structure, self.values, matrix)
    }

    /// The factor, in the memory of `values`, whatever they are.
    fn numeric(
        structure: Structure,
        mut values: Vec<f64>,
        matrix: &LowerTriangle<B>,
    ) -> Result<Self, EmbedError> {
        let order = matrix.order();
        let more = structure.panels.size() - values.len();
        if values.try_reserve_exact(more).is_err() {
            return Err(EmbedError::OutOfMemory { what: "factoring a sparse matrix", order });
        }
        // By all threads: to touch that much memory for the first time takes as long as the factorisation.
        values.par_extend(rayon::iter::repeat_n(0.0, more));
        structure.factor(matrix, &mut values).map_err(|_| EmbedError::Singular { order })?;
        Ok(Self { structure, values })
    }

    fn check(&self, matrix: &LowerTriangle<B>) -> Result<(), EmbedError> {
        let order = matrix.order();
        // A bounded, aperiodic probe: the fractional parts of multiples of the golden ratio.
        let probe: Vec<f64> = (0..order).map(|k| (k as f64 * 0.618_033_988_749_895).fract() - 0.5).collect();
        let wanted = matrix.times(&probe);
        let mut solved = wanted.clone();
        self.solve(solved.as_chunks_mut::<1>().0);
        let reached = matrix.times(&solved);
        let largest =
            |values: &mut dyn Iterator<Item = f64>| values.fold(0.0f64, |most, value| most.max(value.abs()));
        let miss = largest(&mut reached.iter().zip(&wanted).map(|(a, b)| a - b));
        let size = largest(&mut wanted.iter().copied());
        // Written so that a NaN fails the check.
        if miss <= Self::SOUND * size { Ok(()) } else { Err(EmbedError::Singular { order }) }
    }

    /// Replaces `K` right-hand sides, an unknown a row, by the solutions.
    ///
    /// # Panics
    /// If there are not as many rows as the matrix has.
    pub fn solve<const K: usize>(&self, rows: &mut [[f64; K]]) {
        let Structure { order, places, panels, .. } = &self.structure;
        let of_objects: &mut [[[f64; K]; B]] = rows.as_chunks_mut().0;
        let in_order = order.par_iter().with_min_len(CHUNK).map(|&object| of_objects[object as usize]);
        let mut in_order: Vec<[[f64; K]; B]> = in_order.collect();
        panels.substitute(&self.values, in_order.as_flattened_mut());
        let own = of_objects.par_iter_mut().zip(places).with_min_len(CHUNK);
        own.for_each(|(row, &place)| *row = in_order[place as usize]);
    }
}

impl Structure {
    /// Of the factor of a matrix, in an order with little fill.
    fn of<const B: usize>(matrix: &LowerTriangle<B>) -> Result<Self, EmbedError> {
        let n = matrix.objects();
        let Elimination { order, places, parts } = Elimination::of(n, matrix.edges())?;
        // Any number of operations is above the threshold, zero too: the factor always comes in runs.
        let runs = SupernodalThreshold(-1.0);
        let symbolic = factorize_symbolic_cholesky(
            SymbolicSparseColMatRef::new_checked(n, n, &matrix.starts, None, &matrix.rows),
            Side::Lower,
            SymmetricOrdering::Custom(PermRef::new_checked(&order, &places, n)),
            CholeskySymbolicParams { supernodal_flop_ratio_threshold: runs, ..Default::default() },
        )
        .map_err(|_| EmbedError::OutOfMemory { what: "ordering a sparse matrix", order: matrix.order() })?;
        let panels = match symbolic.raw() {
            SymbolicCholeskyRaw::Supernodal(raw) => Panels::of(raw, &parts, B),
            // A matrix of order 0.
            SymbolicCholeskyRaw::Simplicial(_) => Panels::none(),
        };
        let folded = Folded::of(matrix, &places);
        Ok(Self { order, places, folded, panels })
    }
}

#[cfg(test)]
mod tests;
