//! Distances of one object to all others, on demand.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use crate::stress::Incidence;
use crate::{DistanceMatrix, PairDistances};

/// Where methods for many objects take their distances from: a few rows of a table that need not
/// exist as a whole.
pub trait DistanceRows {
    /// Number of objects.
    fn objects(&self) -> usize;

    /// Distances of `object` to all objects: `>= 0`, symmetric, 0 to itself, infinite if unknown.
    fn row(&self, object: usize) -> Vec<f64>;
}

impl DistanceRows for DistanceMatrix {
    fn objects(&self) -> usize {
        self.objects()
    }

    fn row(&self, object: usize) -> Vec<f64> {
        self.row(object).to_vec()
    }
}

/// Lengths of shortest paths over known pairs: the rows of their
/// [metric closure](DistanceMatrix::metric_closure), without the table.
///
/// A row costs `O((n + m) log n)` for `m` pairs (Dijkstra's algorithm).
pub struct ShortestPaths<'a> {
    pairs: &'a PairDistances,
    incidence: Incidence,
}

impl<'a> ShortestPaths<'a> {
    /// Paths over the listed pairs; the weights play no part.
    #[must_use]
    pub fn new(pairs: &'a PairDistances) -> Self {
        Self { pairs, incidence: Incidence::new(pairs) }
    }
}

impl DistanceRows for ShortestPaths<'_> {
    fn objects(&self) -> usize {
        self.pairs.objects()
    }

    fn row(&self, object: usize) -> Vec<f64> {
        let mut lengths = vec![f64::INFINITY; self.objects()];
        lengths[object] = 0.0;
        // Lengths are not negative, so that their bits are in the order of the numbers.
        let mut queue = BinaryHeap::from([Reverse((0.0_f64.to_bits(), object as u32))]);
        while let Some(Reverse((bits, from))) = queue.pop() {
            let length = f64::from_bits(bits);
            if length > lengths[from as usize] {
                continue;
            }
            for &(to, pair) in self.incidence.of(from as usize) {
                let longer = length + self.pairs.pairs()[pair as usize].distance;
                if longer < lengths[to as usize] {
                    lengths[to as usize] = longer;
                    queue.push(Reverse((longer.to_bits(), to)));
                }
            }
        }
        lengths
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Pair;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn shortest_paths_are_the_rows_of_the_closure(
            ends in prop::collection::btree_map((0_u32..12, 0_u32..12), 0_u8..20, 0..30),
        ) {
            let pairs = ends.iter().filter(|((i, j), _)| i < j);
            let pairs = pairs.map(|(&(i, j), &d)| Pair { i, j, distance: f64::from(d), weight: 1.0 });
            let pairs = PairDistances::new(12, pairs.collect()).unwrap();
            let closure = DistanceMatrix::from_pairs(&pairs).metric_closure();
            let paths = ShortestPaths::new(&pairs);
            for object in 0..12 {
                prop_assert_eq!(paths.row(object), DistanceRows::row(&closure, object));
            }
        }
    }
}
