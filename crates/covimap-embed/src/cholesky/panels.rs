//! Where the numbers of a factor are.

use std::ops::Range;

use faer::sparse::linalg::cholesky::supernodal::SymbolicSupernodalCholesky;

/// The runs of a factor's columns, each with one dense panel: the triangle of its columns, and the rows below.
pub(super) struct Panels {
    /// First column of each run, and at last their number.
    pub columns: Vec<u32>,
    /// Rows below the triangle of run `s`: `rows[below[s]..below[s + 1]]`, ascending.
    rows: Vec<u32>,
    below: Vec<usize>,
    /// Where the panel of each run is among the values.
    panels: Vec<usize>,
    /// Runs of each part. The rest comes after them.
    pub parts: Vec<Range<usize>>,
}

impl Panels {
    /// Of a matrix of order 0.
    pub fn none() -> Self {
        Self { columns: vec![0], rows: Vec::new(), below: vec![0], panels: vec![0], parts: Vec::new() }
    }

    /// Of objects with `size` unknowns each; `parts` are the objects at which independent parts end.
    pub fn of(symbolic: &SymbolicSupernodalCholesky<u32>, parts: &[u32], size: usize) -> Self {
        let per = size as u32;
        let mut columns: Vec<u32> = symbolic.supernode_begin().iter().map(|&column| per * column).collect();
        columns.push(per * symbolic.ncols() as u32);
        let mut from = 0;
        // The last run of a part may go on into the rest, to which it then belongs.
        let within = |&end: &u32| {
            let to = columns.partition_point(|&column| column <= per * end).saturating_sub(1);
            Some(std::mem::replace(&mut from, to)..to)
        };
        let parts = parts.iter().filter_map(within).collect();
        let times = |list: &[u32], by: usize| list.iter().map(|&k| by * k as usize).collect::<Vec<usize>>();
        Self {
            rows: symbolic.row_idx().iter().flat_map(|&row| per * row..per * (row + 1)).collect(),
            below: times(symbolic.col_ptr_for_row_idx(), size),
            panels: times(symbolic.col_ptr_for_val(), size * size),
            columns,
            parts,
        }
    }

    /// How many numbers there are.
    pub fn size(&self) -> usize {
        *self.panels.last().expect("there is an end (bug in covimap)")
    }

    /// Number of columns.
    pub fn order(&self) -> u32 {
        *self.columns.last().expect("there is an end (bug in covimap)")
    }

    /// The runs that wait for all parts.
    pub fn rest(&self) -> Range<usize> {
        self.parts.last().map_or(0, |part| part.end)..self.columns.len() - 1
    }

    /// The columns of a run.
    pub fn of_run(&self, run: usize) -> Range<u32> {
        self.columns[run]..self.columns[run + 1]
    }

    /// The rows below the triangle of a run.
    pub fn rows(&self, run: usize) -> &[u32] {
        &self.rows[self.below[run]..self.below[run + 1]]
    }

    /// Where the values of some runs are.
    pub fn values(&self, runs: Range<usize>) -> Range<usize> {
        self.panels[runs.start]..self.panels[runs.end]
    }

    /// The values of a run by columns, and the rows below its triangle.
    pub fn panel<'a>(&'a self, run: usize, values: &'a [f64]) -> (&'a [f64], &'a [u32]) {
        (&values[self.values(run..run + 1)], self.rows(run))
    }

    /// The run that a column belongs to.
    pub fn run_of(&self, column: u32) -> usize {
        self.columns.partition_point(|&first| first <= column) - 1
    }
}
