//! The multifrontal factorisation.
//!
//! A run and the rows below it make a dense front. Into it go the blocks of the matrix and what earlier runs leave to
//! it; its columns are eliminated, which fills the panel, and what is left of the rows below is handed to the run of the
//! first of them. Most of the work is in a few large fronts, which are eliminated by all threads; what comes before
//! these falls into parts that are worked on at the same time.
//!
//! # Determinism
//! A front takes what is left to it in the order of the runs that leave it, and dense products have the same order of
//! sums for any number of threads: the same bits.
//!
//! # References
//! J. W. H. Liu, "The multifrontal method for sparse matrix solution: theory and practice", SIAM Review 34(1), 1992.

use std::ops::Range;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::{LltError, cholesky_in_place, cholesky_in_place_scratch};
use faer::linalg::matmul::triangular::{BlockStructure, matmul};
use faer::linalg::triangular_solve::solve_lower_triangular_in_place;
use faer::prelude::{Reborrow, ReborrowMut};
use faer::{Accum, MatMut, Par, Spec};
use rayon::prelude::*;

use super::{LowerTriangle, Structure, transposed};

/// Multiplications from which on a front is eliminated by all threads.
const LARGE: usize = 1 << 24;

/// What the elimination of a run leaves to the rows below it.
struct Left {
    run: usize,
    /// Lower triangle, by columns of full length.
    values: Vec<f64>,
}

impl Structure {
    /// Fills `values` with the factor of a matrix.
    pub(super) fn factor<const B: usize>(
        &self,
        matrix: &LowerTriangle<B>,
        values: &mut [f64],
    ) -> Result<(), LltError> {
        let panels = &self.panels;
        let mut remaining = values;
        let mut own = |runs: &Range<usize>| {
            let length = panels.values(runs.clone()).len();
            remaining.split_off_mut(..length).expect("panels fill the values (bug in covimap)")
        };
        let parts: Vec<(&Range<usize>, &mut [f64])> =
            panels.parts.iter().map(|part| (part, own(part))).collect();
        let rest = panels.rest();
        let of_rest = own(&rest);
        let part =
            |(runs, values): (&Range<usize>, &mut [f64])| self.runs(matrix, runs.clone(), values, Vec::new());
        let left: Vec<Vec<Left>> = parts.into_par_iter().map(part).collect::<Result<_, _>>()?;
        self.runs(matrix, rest, of_rest, left.into_iter().flatten().collect())?;
        Ok(())
    }

    /// Eliminates some runs, to which earlier ones have left something; what they leave to later ones.
    fn runs<const B: usize>(
        &self,
        matrix: &LowerTriangle<B>,
        runs: Range<usize>,
        mut values: &mut [f64],
        left: Vec<Left>,
    ) -> Result<Vec<Left>, LltError> {
        let first = runs.start;
        // For each run, and at last for those to come.
        let mut waiting: Vec<Vec<Left>> = Vec::new();
        waiting.resize_with(runs.len() + 1, Vec::new);
        let hand_on = |left: Left, waiting: &mut [Vec<Left>]| {
            let to = self.panels.run_of(self.panels.rows(left.run)[0]).min(runs.end);
            waiting[to - first].push(left);
        };
        left.into_iter().for_each(|left| hand_on(left, &mut waiting));
        for run in runs.clone() {
            let length = self.panels.values(run..run + 1).len();
            let panel = values.split_off_mut(..length).expect("panels fill the values (bug in covimap)");
            let for_this = std::mem::take(&mut waiting[run - first]);
            if let Some(left) = self.eliminate(matrix, run, panel, for_this)? {
                hand_on(left, &mut waiting);
            }
        }
        Ok(waiting.pop().expect("there is a last list (bug in covimap)"))
    }

    /// Fills the panel of a run.
    fn eliminate<const B: usize>(
        &self,
        matrix: &LowerTriangle<B>,
        run: usize,
        panel: &mut [f64],
        left: Vec<Left>,
    ) -> Result<Option<Left>, LltError> {
        let rows = self.panels.rows(run);
        let (width, below) = (self.panels.of_run(run).len(), rows.len());
        panel.fill(0.0);
        self.assemble(matrix, run, panel);
        let mut rest = vec![0.0; below * below];
        for left in left {
            self.add(run, panel, &mut rest, &left);
        }
        let work = width * (width + below) * (width + below);
        let par = if work >= LARGE { Par::rayon(0) } else { Par::Seq };
        let panel = MatMut::from_column_major_slice_mut(panel, width + below, width);
        let (mut triangle, mut under) = panel.split_at_row_mut(width);
        let mut memory = MemBuffer::new(cholesky_in_place_scratch::<f64>(width, par, Spec::default()));
        let stack = MemStack::new(&mut memory);
        cholesky_in_place(triangle.rb_mut(), Default::default(), par, stack, Spec::default())?;
        if below == 0 {
            return Ok(None);
        }
        solve_lower_triangular_in_place(triangle.rb(), under.rb_mut().transpose_mut(), par);
        matmul(
            MatMut::from_column_major_slice_mut(&mut rest, below, below),
            BlockStructure::TriangularLower,
            Accum::Add,
            under.rb(),
            BlockStructure::Rectangular,
            under.rb().transpose(),
            BlockStructure::Rectangular,
            -1.0,
            par,
        );
        Ok(Some(Left { run, values: rest }))
    }

    /// Puts the blocks of a matrix into the panel of a run.
    fn assemble<const B: usize>(&self, matrix: &LowerTriangle<B>, run: usize, panel: &mut [f64]) {
        let columns = self.panels.of_run(run);
        let rows = self.panels.rows(run);
        let height = columns.len() + rows.len();
        for (k, column) in columns.clone().step_by(B).enumerate() {
            let mut later = 0;
            let at = column as usize / B;
            let object = self.order[at];
            for &(row, block) in self.folded.column(at) {
                let row = B as u32 * row;
                let place = if row < columns.end {
                    (row - columns.start) as usize
                } else {
                    later += rows[later..].iter().take_while(|&&own| own < row).count();
                    columns.len() + later
                };
                // By columns of the factor: those of a block that changed sides are its rows.
                let own = &matrix.blocks[block as usize];
                let changed_sides = !matrix.column(object as usize).contains(&(block as usize));
                let by_columns = if changed_sides { *own } else { transposed(own) };
                for (b, values) in by_columns.iter().enumerate() {
                    let at = (B * k + b) * height + place;
                    panel[at..at + B].copy_from_slice(values);
                }
            }
        }
    }

    /// Adds to a front, which is a panel and the rest below it, what an earlier run has left.
    fn add(&self, run: usize, panel: &mut [f64], rest: &mut [f64], left: &Left) {
        let columns = self.panels.of_run(run);
        let rows = self.panels.rows(run);
        let (width, below) = (columns.len(), rows.len());
        let mut later = 0;
        let place = |&row: &u32| {
            if row < columns.end {
                return (row - columns.start) as usize;
            }
            later += rows[later..].iter().take_while(|&&own| own < row).count();
            width + later
        };
        let places: Vec<usize> = self.panels.rows(left.run).iter().map(place).collect();
        let own = places.partition_point(|&place| place < width);
        for (k, (&column, values)) in places.iter().zip(left.values.chunks_exact(places.len())).enumerate() {
            if k < own {
                let to = &mut panel[column * (width + below)..(column + 1) * (width + below)];
                places[k..].iter().zip(&values[k..]).for_each(|(&row, value)| to[row] += value);
            } else {
                let to = &mut rest[(column - width) * below..(column - width + 1) * below];
                places[k..].iter().zip(&values[k..]).for_each(|(&row, value)| to[row - width] += value);
            }
        }
    }
}
