//! The lower triangle of a matrix as it lies when its objects are put in another order.

use rayon::prelude::*;

use super::{CHUNK, LowerTriangle};

/// Where the blocks of a matrix go.
pub(super) struct Folded {
    /// Where the blocks of the column of each place start, and at last their number.
    starts: Vec<u32>,
    /// Place of the row of each block, and which block of the matrix it is; ascending within a column.
    blocks: Vec<(u32, u32)>,
}

impl Folded {
    /// Of a matrix whose object `k` goes to `places[k]`.
    pub fn of<const B: usize>(matrix: &LowerTriangle<B>, places: &[u32]) -> Self {
        let ends = |column: usize, entry: usize| {
            let [a, b] = [column, matrix.rows[entry] as usize].map(|object| places[object]);
            (a.min(b), a.max(b))
        };
        let mut starts = vec![0_u32; places.len() + 1];
        let all =
            || (0..places.len()).flat_map(|column| matrix.column(column).map(move |entry| (column, entry)));
        all().for_each(|(column, entry)| starts[ends(column, entry).0 as usize + 1] += 1);
        for place in 0..places.len() {
            starts[place + 1] += starts[place];
        }
        let mut next = starts.clone();
        let mut blocks = vec![(0, 0); matrix.rows.len()];
        for (column, entry) in all() {
            let (column, row) = ends(column, entry);
            let at = &mut next[column as usize];
            blocks[*at as usize] = (row, entry as u32);
            *at += 1;
        }
        let mut left = blocks.as_mut_slice();
        let mut columns = Vec::with_capacity(places.len());
        for ends in starts.windows(2) {
            columns
                .push(left.split_off_mut(..(ends[1] - ends[0]) as usize).expect("counted (bug in covimap)"));
        }
        columns.into_par_iter().with_min_len(CHUNK).for_each(|column| column.sort_unstable());
        Self { starts, blocks }
    }

    /// The blocks of the column of a place.
    pub fn column(&self, place: usize) -> &[(u32, u32)] {
        &self.blocks[self.starts[place] as usize..self.starts[place + 1] as usize]
    }
}
