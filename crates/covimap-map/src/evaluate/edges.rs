//! Delaunay error: who is next to whom.

use std::cmp::Ordering;

/// Edges that stand in one of two Delaunay graphs only, pooled over charts.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct EdgeDifference {
    differing: usize,
    /// Sum of `3n - 6`, the most edges that a planar graph can have.
    possible: usize,
}

impl EdgeDifference {
    /// Counts two ascending edge lists over the same `n >= 3` landmarks.
    pub fn add(&mut self, map: &[(u32, u32)], truth: &[(u32, u32)], n: usize) {
        self.differing += map.len() + truth.len() - 2 * shared(map, truth);
        self.possible += 3 * n - 6;
    }

    /// Eq. (7), in `[0, 2]`.
    pub fn error(self) -> f64 {
        self.differing as f64 / self.possible as f64
    }
}

fn shared(mut a: &[(u32, u32)], mut b: &[(u32, u32)]) -> usize {
    let mut count = 0;
    while let ([first, rest @ ..], [other, others @ ..]) = (a, b) {
        let order = first.cmp(other);
        count += usize::from(order == Ordering::Equal);
        if order != Ordering::Greater {
            a = rest;
        }
        if order != Ordering::Less {
            b = others;
        }
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_of_one_side_only_count_whatever_their_order() {
        let mut difference = EdgeDifference::default();
        // Four landmarks, 3 * 4 - 6 = 6: the two diagonals of a quadrilateral differ.
        difference.add(
            &[(0, 1), (0, 2), (0, 3), (1, 2), (2, 3)],
            &[(0, 1), (0, 3), (1, 2), (1, 3), (2, 3)],
            4,
        );
        assert_eq!(difference.error(), 2.0 / 6.0);
        // Three landmarks, 3 * 3 - 6 = 3: a path against a triangle.
        difference.add(&[(0, 1), (1, 2)], &[(0, 1), (0, 2), (1, 2)], 3);
        assert_eq!(difference.error(), 3.0 / 9.0);
    }

    #[test]
    fn nothing_shared_counts_both_sides() {
        assert_eq!(shared(&[(0, 1)], &[]), 0);
        assert_eq!(shared(&[(0, 1), (4, 5)], &[(0, 2), (4, 5), (4, 6)]), 1);
        let mut difference = EdgeDifference::default();
        difference.add(&[(0, 1), (0, 2)], &[(1, 2)], 3);
        assert_eq!(difference.error(), 1.0);
    }
}
