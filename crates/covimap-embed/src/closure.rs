//! Metric closure: every distance becomes the length of the shortest path.
//!
//! `d*(i, j) = min over paths i = p_0, p_1, .., p_m = j of sum_k d(p_k-1, p_k)`
//!
//! The result is the largest table that obeys the triangle inequality and nowhere exceeds the
//! given one.
//!
//! # Algorithm
//! Floyd and Warshall's recurrence, taken [`BLOCK`] intermediate objects `K` at a time:
//! 1. close the block `D_KK` by the plain recurrence;
//! 2. `P = D_*K (+) D_KK`, the paths that end in the block and may wander inside it;
//! 3. `D = min(D, P (+) P')`, the paths through the block,
//!
//! where `(A (+) B)_ij = min_k A_ik + B_kj`. The table is symmetric, so that only the lower
//! triangle is worked on. Step 3 runs in parallel over rows.
//!
//! # Complexity
//! `n^3 / 2` additions and minima; `O(BLOCK n)` memory besides the table.
//!
//! # Determinism
//! Each entry is computed by one thread in a fixed order.
//!
//! # References
//! R. W. Floyd, "Algorithm 97: Shortest path", Comm. ACM 5(6), 1962.
//! G. Venkataraman, S. Sahni, S. Mukhopadhyaya, "A blocked all-pairs shortest-paths algorithm",
//! J. Exp. Algorithmics 8, 2003.

use rayon::prelude::*;

use crate::DistanceMatrix;

/// Intermediate objects per round: their panel of one [`TILE`] stays in the second-level cache.
const BLOCK: usize = 64;
/// Columns of a row that are updated together.
const TILE: usize = 256;
/// Rows of one parallel task.
const ROWS: usize = 16;

impl DistanceMatrix {
    /// The table of shortest-path lengths; infinite between objects that no path connects.
    ///
    /// ```
    /// use covimap_embed::DistanceMatrix;
    ///
    /// // 1 + 2 < 9: the way over object 1 is shorter.
    /// let given = DistanceMatrix::from_rows(3, vec![0.0, 1.0, 9.0, 1.0, 0.0, 2.0, 9.0, 2.0, 0.0])?;
    /// assert_eq!(given.metric_closure().get(0, 2), 3.0);
    /// # Ok::<(), covimap_embed::EmbedError>(())
    /// ```
    #[must_use]
    pub fn metric_closure(mut self) -> Self {
        let n = self.objects();
        let values = self.values_mut();
        for start in (0..n).step_by(BLOCK) {
            let block = start..(start + BLOCK).min(n);
            let width = block.len();
            let mut panel = panel_of(values, n, start, width);
            close_block(&mut panel, n, start, width);
            extend_through_block(&mut panel, n, start, width);
            values.par_chunks_mut(ROWS * n).enumerate().for_each(|(chunk, rows)| {
                relax_rows(rows, &panel, n, chunk * ROWS);
            });
        }
        mirror_lower(values, n);
        self
    }
}

/// `P'`: row `k` holds the distances of the block's object `start + k` to all objects, read from
/// the lower triangle.
fn panel_of(values: &[f64], n: usize, start: usize, width: usize) -> Vec<f64> {
    let mut panel = vec![0.0; width * n];
    for (k, row) in panel.chunks_exact_mut(n).enumerate() {
        let object = start + k;
        row[..=object].copy_from_slice(&values[object * n..=object * n + object]);
        for (j, entry) in row.iter_mut().enumerate().skip(object + 1) {
            *entry = values[j * n + object];
        }
    }
    panel
}

/// Step 1 on the columns of the panel that belong to the block itself.
fn close_block(panel: &mut [f64], n: usize, start: usize, width: usize) {
    for via in 0..width {
        for i in 0..width {
            let first = panel[i * n + start + via];
            for j in 0..width {
                let path = first + panel[via * n + start + j];
                let entry = &mut panel[i * n + start + j];
                *entry = entry.min(path);
            }
        }
    }
}

/// Step 2. The block is closed, hence one sweep suffices and the order does not matter.
fn extend_through_block(panel: &mut [f64], n: usize, start: usize, width: usize) {
    let given = panel.to_vec();
    panel.par_chunks_mut(n).enumerate().for_each(|(k, row)| {
        for via in 0..width {
            let first = given[k * n + start + via];
            for (entry, last) in row.iter_mut().zip(&given[via * n..(via + 1) * n]) {
                *entry = lesser(*entry, first + last);
            }
        }
    });
}

/// Step 3 for the rows `first_row..` up to the diagonal.
fn relax_rows(rows: &mut [f64], panel: &[f64], n: usize, first_row: usize) {
    for tile in (0..n).step_by(TILE) {
        for (offset, row) in rows.chunks_exact_mut(n).enumerate() {
            let i = first_row + offset;
            let end = (tile + TILE).min(i + 1);
            if tile < end {
                relax(&mut row[tile..end], panel, n, tile, i);
            }
        }
    }
}

/// `row_j = min(row_j, min_k P_ik + P_jk)`, two `k` at a time to halve the stores.
fn relax(row: &mut [f64], panel: &[f64], n: usize, tile: usize, i: usize) {
    let columns = tile..tile + row.len();
    let mut pairs = panel.chunks_exact(2 * n);
    for pair in &mut pairs {
        let (p, q) = pair.split_at(n);
        let (to_p, to_q) = (p[i], q[i]);
        let tails = p[columns.clone()].iter().zip(&q[columns.clone()]);
        for (entry, (from_p, from_q)) in row.iter_mut().zip(tails) {
            *entry = lesser(*entry, lesser(to_p + from_p, to_q + from_q));
        }
    }
    let p = pairs.remainder();
    if !p.is_empty() {
        let to_p = p[i];
        for (entry, from_p) in row.iter_mut().zip(&p[columns]) {
            *entry = lesser(*entry, to_p + from_p);
        }
    }
}

/// The minimum of two numbers that are not NaN, as one machine instruction.
fn lesser(a: f64, b: f64) -> f64 {
    if b < a { b } else { a }
}

fn mirror_lower(values: &mut [f64], n: usize) {
    for i in 0..n {
        for j in 0..i {
            values[j * n + i] = values[i * n + j];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The textbook recurrence, three loops.
    fn oracle(mut d: Vec<f64>, n: usize) -> Vec<f64> {
        for k in 0..n {
            for i in 0..n {
                for j in 0..n {
                    d[i * n + j] = d[i * n + j].min(d[i * n + k] + d[k * n + j]);
                }
            }
        }
        d
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]

        // Whole numbers, so that the order of the additions cannot show; sparse ones leave
        // several components. The sizes straddle the block and tile limits.
        #[test]
        fn agrees_with_the_textbook_recurrence(
            n in 0_usize..300, seed in 0_u64..1000, density in 1_u64..40,
        ) {
            let given = DistanceMatrix::from_fn(n, |i, j| {
                let mixed = ((i * 7919 + j) as u64 ^ seed).wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 40;
                if mixed % 40 < density { (mixed % 97) as f64 } else { f64::INFINITY }
            }).unwrap();
            let expected = oracle((0..n).flat_map(|i| given.row(i).to_vec()).collect(), n);
            let closed = given.metric_closure();
            for i in 0..n {
                prop_assert_eq!(closed.row(i), &expected[i * n..(i + 1) * n]);
            }
        }
    }

    #[test]
    fn components_stay_apart() {
        let given = DistanceMatrix::from_fn(4, |i, j| if i / 2 == j / 2 { 1.0 } else { f64::INFINITY });
        let closed = given.unwrap().metric_closure();
        assert_eq!(closed.row(3), [f64::INFINITY, f64::INFINITY, 1.0, 0.0]);
    }

    #[test]
    fn the_result_does_not_depend_on_the_number_of_threads() {
        let given = DistanceMatrix::from_fn(200, |i, j| ((i * 31 + j * 17) % 101) as f64 * 0.1).unwrap();
        let run = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| given.clone().metric_closure())
        };
        assert_eq!(run(1), run(4));
    }
}
