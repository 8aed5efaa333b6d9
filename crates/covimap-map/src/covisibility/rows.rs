//! Sparse rows, kept in the blocks they were counted in: joining them would take the memory twice.

/// All rows of a sparse matrix.
#[derive(Debug, Clone)]
pub(super) struct Rows {
    blocks: Vec<RowBlock>,
    /// Block of each row.
    block_of: Vec<u32>,
}

/// Some consecutive rows.
#[derive(Debug, Clone)]
pub(super) struct RowBlock {
    /// Number of the first row.
    first: usize,
    /// Row `first + k`: `starts[k]..starts[k + 1]` of the other two.
    starts: Vec<usize>,
    columns: Vec<u32>,
    values: Vec<u32>,
}

impl RowBlock {
    /// No row yet; the first one will be row `first`.
    pub(super) fn new(first: usize) -> Self {
        Self { first, starts: vec![0], columns: Vec::new(), values: Vec::new() }
    }

    /// Rows of these sizes, to be filled in any order.
    pub(super) fn sized(sizes: &[usize]) -> Self {
        let mut starts = vec![0];
        starts.extend(sizes.iter().scan(0, |end, size| {
            *end += size;
            Some(*end)
        }));
        let entries = starts[sizes.len()];
        Self { first: 0, starts, columns: vec![0; entries], values: vec![0; entries] }
    }

    /// Puts an entry behind those that a row of [`RowBlock::sized`] has already: `starts` tells how far that is.
    pub(super) fn put(&mut self, row: usize, column: u32, value: u32) {
        let place = &mut self.starts[row];
        self.columns[*place] = column;
        self.values[*place] = value;
        *place += 1;
    }

    /// The rows of [`RowBlock::sized`], all of them filled.
    pub(super) fn ended(mut self) -> Self {
        // Every start has moved to its end, the start of the next row.
        self.starts.insert(0, 0);
        self.starts.pop();
        self
    }

    /// Appends an entry to the row that is being made; columns ascend.
    pub(super) fn push(&mut self, column: u32, value: u32) {
        self.columns.push(column);
        self.values.push(value);
    }

    /// Appends entries that follow those of the row that is being made.
    pub(super) fn extend(&mut self, columns: &[u32], values: &[u32]) {
        self.columns.extend_from_slice(columns);
        self.values.extend_from_slice(values);
    }

    /// Ends the row that is being made.
    pub(super) fn end_row(&mut self) {
        self.starts.push(self.columns.len());
    }

    /// Gives back memory that is not needed any more.
    pub(super) fn finish(mut self) -> Self {
        self.columns.shrink_to_fit();
        self.values.shrink_to_fit();
        self
    }
}

impl Rows {
    /// All rows, given in order.
    pub(super) fn new(blocks: Vec<RowBlock>) -> Self {
        let numbered = (0_u32..).zip(&blocks);
        let block_of = numbered
            .flat_map(|(number, block)| std::iter::repeat_n(number, block.starts.len() - 1))
            .collect();
        Self { blocks, block_of }
    }

    /// Columns and values of a row.
    pub(super) fn row(&self, row: usize) -> (&[u32], &[u32]) {
        let block = &self.blocks[self.block_of[row] as usize];
        let place = row - block.first;
        let range = block.starts[place]..block.starts[place + 1];
        (&block.columns[range.clone()], &block.values[range])
    }

    /// Number of entries.
    pub(super) fn entries(&self) -> usize {
        self.blocks.iter().map(|block| block.columns.len()).sum()
    }
}

/// The same rows, however they are divided into blocks.
impl PartialEq for Rows {
    fn eq(&self, other: &Self) -> bool {
        self.block_of.len() == other.block_of.len()
            && (0..self.block_of.len()).all(|row| self.row(row) == other.row(row))
    }
}

impl Eq for Rows {}
