//! From the lower triangle of a symmetric sparse matrix to all of it.

use std::ops::Range;

use rayon::prelude::*;

/// Consecutive rows of the strict lower triangle.
pub(super) struct LowerRows {
    first: usize,
    ends: Vec<usize>,
    columns: Vec<u32>,
    values: Vec<u32>,
}

impl LowerRows {
    /// No row yet; the first will be row `first`.
    pub(super) fn new(first: usize) -> Self {
        Self { first, ends: Vec::new(), columns: Vec::new(), values: Vec::new() }
    }

    /// Appends an entry to the present row; columns ascend and are below the row.
    pub(super) fn push(&mut self, column: u32, value: u32) {
        self.columns.push(column);
        self.values.push(value);
    }

    pub(super) fn end_row(&mut self) {
        self.ends.push(self.columns.len());
    }

    /// All rows with their number, columns and values.
    fn rows(&self) -> impl Iterator<Item = (usize, &[u32], &[u32])> {
        let starts = std::iter::once(&0).chain(&self.ends);
        starts.zip(&self.ends).enumerate().map(|(index, (&start, &end))| {
            (self.first + index, &self.columns[start..end], &self.values[start..end])
        })
    }
}

/// A symmetric sparse matrix without diagonal, by rows.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Symmetric {
    /// Start of each row in the other two, and the end of the last.
    pub(super) starts: Vec<usize>,
    /// Columns, ascending within a row.
    pub(super) columns: Vec<u32>,
    pub(super) values: Vec<u32>,
}

impl Symmetric {
    /// Mirrors a lower triangle, given whole and in order.
    ///
    /// Every worker makes a range of rows, for which it looks through all lower rows from there on.
    pub(super) fn from_lower(size: usize, lower: &[LowerRows]) -> Self {
        let workers = rayon::current_num_threads();
        let cut = |worker: usize| size * worker / workers;
        let lengths: Vec<_> =
            (0..workers).into_par_iter().map(|w| row_lengths(cut(w)..cut(w + 1), lower)).collect();
        let mut starts = vec![0; size + 1];
        for (row, length) in lengths.iter().flatten().enumerate() {
            starts[row + 1] = starts[row] + length;
        }
        let mut columns = vec![0; starts[size]];
        let mut values = vec![0; starts[size]];
        parts(&starts, workers, &mut columns, &mut values)
            .into_par_iter()
            .for_each(|mut part| part.fill(&starts, lower));
        Self { starts, columns, values }
    }
}

/// All lower rows from `first` on.
fn rows_from(lower: &[LowerRows], first: usize) -> impl Iterator<Item = (usize, &[u32], &[u32])> {
    lower.iter().flat_map(LowerRows::rows).skip_while(move |&(row, ..)| row < first)
}

/// Lengths of some rows of the whole matrix.
fn row_lengths(rows: Range<usize>, lower: &[LowerRows]) -> Vec<usize> {
    let mut lengths = vec![0; rows.len()];
    for (row, columns, _) in rows_from(lower, rows.start) {
        if rows.contains(&row) {
            lengths[row - rows.start] += columns.len();
        }
        for &column in &columns[within(columns, &rows)] {
            lengths[column as usize - rows.start] += 1;
        }
    }
    lengths
}

/// Some rows of the whole matrix, to be written.
struct Part<'a> {
    rows: Range<usize>,
    columns: &'a mut [u32],
    values: &'a mut [u32],
}

/// Cuts a matrix into parts of about the same number of entries.
fn parts<'a>(
    starts: &[usize],
    count: usize,
    mut columns: &'a mut [u32],
    mut values: &'a mut [u32],
) -> Vec<Part<'a>> {
    let size = starts.len() - 1;
    let mut first = 0;
    let part = |k: usize| {
        let share = starts[size].div_ceil(count) * k;
        let end = if k == count { size } else { starts.partition_point(|&start| start < share).min(size) };
        let rows = first..end.max(first);
        first = rows.end;
        let length = starts[rows.end] - starts[rows.start];
        Part {
            rows,
            columns: columns.split_off_mut(..length).expect("starts fit the matrix (bug in covimap)"),
            values: values.split_off_mut(..length).expect("starts fit the matrix (bug in covimap)"),
        }
    };
    (1..=count).map(part).collect()
}

impl Part<'_> {
    /// Lower rows ascend, so that each row gets its own lower part first, then its upper part in
    /// order.
    fn fill(&mut self, starts: &[usize], lower: &[LowerRows]) {
        let first = self.rows.start;
        let mut next: Vec<usize> = self.rows.clone().map(|row| starts[row] - starts[first]).collect();
        for (row, columns, values) in rows_from(lower, first) {
            if self.rows.contains(&row) {
                let place = &mut next[row - first];
                let own = *place..*place + columns.len();
                self.columns[own.clone()].copy_from_slice(columns);
                self.values[own.clone()].copy_from_slice(values);
                *place = own.end;
            }
            let number = u32::try_from(row).expect("rows are numbered in 32 bits (bug in covimap)");
            let mirrored = within(columns, &self.rows);
            for (&column, &value) in columns[mirrored.clone()].iter().zip(&values[mirrored]) {
                let place = &mut next[column as usize - first];
                self.columns[*place] = number;
                self.values[*place] = value;
                *place += 1;
            }
        }
    }
}

/// Where the columns of a lower row lie within a range.
fn within(columns: &[u32], range: &Range<usize>) -> Range<usize> {
    let cut = |bound: usize| columns.partition_point(|&column| (column as usize) < bound);
    cut(range.start)..cut(range.end)
}
