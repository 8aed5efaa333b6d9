//! Solves with a Cholesky factor, an unknown a row.
//!
//! A run is a dense panel, so that a solve reads the factor as it lies in memory, looks a row up once a run and not once
//! an entry, and carries all right-hand sides along in one pass. Parts of the factor that do not depend on each other
//! are handled at the same time: what they add to the rest is gathered by each for itself and summed in their order.

use std::ops::Range;

use rayon::prelude::*;

use super::Panels;
use crate::wide::wide;

/// Sums of an inner product.
const LANES: usize = 8;

impl Panels {
    /// Solves `L L' x = y` in place, rows in the order of the factor.
    pub fn substitute<const K: usize>(&self, values: &[f64], y: &mut [[f64; K]]) {
        let rest = self.rest();
        let (own, last) = y.split_at_mut(self.columns[rest.start] as usize);
        let mut slices = Vec::with_capacity(self.parts.len());
        let mut left = own;
        for part in &self.parts {
            let length = self.columns[part.end] - self.columns[part.start];
            let (slice, others) = left.split_at_mut(length as usize);
            slices.push(slice);
            left = others;
        }
        let forward = |(part, own): (&Range<usize>, &mut &mut [[f64; K]])| {
            let mut added = vec![[0.0; K]; last.len()];
            wide(
                #[inline(always)]
                || self.forward(values, part.clone(), own, &mut added),
            );
            added
        };
        let added: Vec<Vec<[f64; K]>> = self.parts.par_iter().zip(&mut slices).map(forward).collect();
        for added in added {
            last.iter_mut().zip(added).for_each(|(y, added)| *y = std::array::from_fn(|k| y[k] + added[k]));
        }
        wide(
            #[inline(always)]
            || {
                self.forward(values, rest.clone(), last, &mut []);
                self.backward(values, rest, last, &[]);
            },
        );
        let last = &*last;
        self.parts.par_iter().zip(slices).for_each(|(part, own)| {
            wide(
                #[inline(always)]
                || self.backward(values, part.clone(), own, last),
            );
        });
    }

    /// `L x = y` in some runs, which hold the rows `own`; `added` collects what is added to the last rows of all.
    #[inline(always)]
    fn forward<const K: usize>(
        &self,
        values: &[f64],
        runs: Range<usize>,
        own: &mut [[f64; K]],
        added: &mut [[f64; K]],
    ) {
        let first = self.columns[runs.start];
        let end = first + own.len() as u32;
        let first_of_added = self.order() - added.len() as u32;
        let mut sides = Sides::<K>::default();
        for run in runs {
            let (panel, rows) = self.panel(run, values);
            let start = (self.columns[run] - first) as usize;
            let width = (self.columns[run + 1] - self.columns[run]) as usize;
            let y = &mut own[start..start + width];
            sides.clear();
            y.iter().for_each(|y| sides.push(*y));
            sides.fill(width + rows.len());
            for (k, column) in panel.chunks_exact(width + rows.len()).enumerate() {
                sides.eliminate(k, &column[k..]);
            }
            for (k, y) in y.iter_mut().enumerate() {
                *y = sides.at(k);
            }
            for (k, &row) in (width..).zip(rows) {
                let change = sides.at(k);
                let to = match row {
                    row if row < end => &mut own[(row - first) as usize],
                    row => &mut added[(row - first_of_added) as usize],
                };
                *to = std::array::from_fn(|side| to[side] + change[side]);
            }
        }
    }

    /// `L' x = y` in some runs, which hold the rows `own`, with the last rows of all known.
    #[inline(always)]
    fn backward<const K: usize>(
        &self,
        values: &[f64],
        runs: Range<usize>,
        own: &mut [[f64; K]],
        last: &[[f64; K]],
    ) {
        let first = self.columns[runs.start];
        let end = first + own.len() as u32;
        let first_of_last = self.order() - last.len() as u32;
        let mut sides = Sides::<K>::default();
        for run in runs.rev() {
            let (panel, rows) = self.panel(run, values);
            let start = (self.columns[run] - first) as usize;
            let width = (self.columns[run + 1] - self.columns[run]) as usize;
            sides.clear();
            own[start..start + width].iter().for_each(|y| sides.push(*y));
            for &row in rows {
                sides.push(match row {
                    row if row < end => own[(row - first) as usize],
                    row => last[(row - first_of_last) as usize],
                });
            }
            for (k, column) in panel.chunks_exact(width + rows.len()).enumerate().rev() {
                sides.substitute(k, &column[k..]);
            }
            own[start..start + width].iter_mut().enumerate().for_each(|(k, y)| *y = sides.at(k));
        }
    }
}

/// The rows that a run concerns, right-hand side by right-hand side: so that a column of the factor meets numbers that
/// lie side by side.
struct Sides<const K: usize>([Vec<f64>; K]);

impl<const K: usize> Default for Sides<K> {
    fn default() -> Self {
        Self(std::array::from_fn(|_| Vec::new()))
    }
}

impl<const K: usize> Sides<K> {
    #[inline(always)]
    fn clear(&mut self) {
        self.0.iter_mut().for_each(Vec::clear);
    }

    #[inline(always)]
    fn push(&mut self, row: [f64; K]) {
        self.0.iter_mut().zip(row).for_each(|(side, value)| side.push(value));
    }

    /// Zeros up to `length` rows.
    #[inline(always)]
    fn fill(&mut self, length: usize) {
        self.0.iter_mut().for_each(|side| side.resize(length, 0.0));
    }

    #[inline(always)]
    fn at(&self, row: usize) -> [f64; K] {
        std::array::from_fn(|side| self.0[side][row])
    }

    /// Divides row `k` by the first entry of its column, from the diagonal down, and takes its multiples from the
    /// rows after it.
    #[inline(always)]
    fn eliminate(&mut self, k: usize, column: &[f64]) {
        let (&diagonal, below) = column.split_first().expect("a column has a diagonal (bug in covimap)");
        for side in &mut self.0 {
            let (own, rest) = side[k..].split_first_mut().expect("every column has its row (bug in covimap)");
            *own /= diagonal;
            for (y, &factor) in rest.iter_mut().zip(below) {
                *y -= factor * *own;
            }
        }
    }

    /// Takes from row `k` the multiples of the rows after it, and divides it by the first entry of its column.
    #[inline(always)]
    fn substitute(&mut self, k: usize, column: &[f64]) {
        let (&diagonal, below) = column.split_first().expect("a column has a diagonal (bug in covimap)");
        for side in &mut self.0 {
            let (own, rest) = side[k..].split_first_mut().expect("every column has its row (bug in covimap)");
            *own = (*own - product(below, rest)) / diagonal;
        }
    }
}

/// `sum factor_i y_i`, in interleaved sums that need not wait for each other.
#[inline(always)]
fn product(factors: &[f64], y: &[f64]) -> f64 {
    let mut sums = [0.0; LANES];
    let (many, rest) = factors.as_chunks::<LANES>();
    let (values, last) = y.as_chunks::<LANES>();
    for (factors, values) in many.iter().zip(values) {
        for ((sum, &factor), y) in sums.iter_mut().zip(factors).zip(values) {
            *sum += factor * y;
        }
    }
    for ((sum, &factor), y) in sums.iter_mut().zip(rest).zip(last) {
        *sum += factor * y;
    }
    sums.iter().sum()
}
