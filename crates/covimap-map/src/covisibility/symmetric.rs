//! From the lower triangle of a symmetric sparse matrix to all of it.

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

/// Start of each row (and the end of the last), columns and values of the whole matrix.
pub(super) fn symmetric(size: usize, lower: &[LowerRows]) -> (Vec<usize>, Vec<u32>, Vec<u32>) {
    let mut starts = vec![0; size + 1];
    for (row, columns, _) in lower.iter().flat_map(LowerRows::rows) {
        starts[row + 1] += columns.len();
        for &column in columns {
            starts[column as usize + 1] += 1;
        }
    }
    for row in 0..size {
        starts[row + 1] += starts[row];
    }
    let mut all_columns = vec![0; starts[size]];
    let mut all_values = vec![0; starts[size]];
    let mut next = starts.clone();
    // Rows ascend, so each row first gets its own lower part, then its upper part in order.
    for (row, columns, values) in lower.iter().flat_map(LowerRows::rows) {
        let own = next[row]..next[row] + columns.len();
        all_columns[own.clone()].copy_from_slice(columns);
        all_values[own.clone()].copy_from_slice(values);
        next[row] = own.end;
        for (&column, &value) in columns.iter().zip(values) {
            let place = &mut next[column as usize];
            all_columns[*place] = row as u32;
            all_values[*place] = value;
            *place += 1;
        }
    }
    (starts, all_columns, all_values)
}
