//! Known distances between some pairs of objects.

use crate::EmbedError;

/// One known distance, `i < j`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    /// First object, smaller than `j`.
    pub i: u32,
    /// Second object.
    pub j: u32,
    /// Distance asked of the pair, `>= 0`.
    pub distance: f64,
    /// Weight of the pair in the stress, `> 0`.
    pub weight: f64,
}

/// A checked list of known distances: `i < j < n`, ascending, no pair twice, finite.
///
/// The problem that a list states is: find `x_1 .. x_n` in the plane that minimise
/// `sum w_ij (|x_i - x_j| - d_ij)^2` over the listed pairs.
#[derive(Debug, Clone, PartialEq)]
pub struct PairDistances {
    n: usize,
    pairs: Vec<Pair>,
}

impl PairDistances {
    /// Checks `pairs` of `n` objects.
    ///
    /// # Errors
    /// [`EmbedError::BadPair`] for the first pair that is out of range or order, or that is not finite.
    pub fn new(n: usize, pairs: Vec<Pair>) -> Result<Self, EmbedError> {
        let mut last = None;
        for pair in &pairs {
            let bad = |what| EmbedError::BadPair { i: pair.i, j: pair.j, n, what };
            if pair.i >= pair.j || pair.j as usize >= n {
                return Err(bad("objects must satisfy i < j < n"));
            }
            if last >= Some((pair.i, pair.j)) {
                return Err(bad("pairs must ascend and none may be listed twice"));
            }
            if !(pair.distance >= 0.0 && pair.distance.is_finite()) {
                return Err(bad("the distance must be finite and not negative"));
            }
            if !(pair.weight > 0.0 && pair.weight.is_finite()) {
                return Err(bad("the weight must be finite and positive; leave the pair out instead"));
            }
            last = Some((pair.i, pair.j));
        }
        Ok(Self { n, pairs })
    }

    /// Number of objects.
    #[must_use]
    pub fn objects(&self) -> usize {
        self.n
    }

    /// Whether every pair of objects is listed.
    #[must_use]
    pub fn is_complete(&self) -> bool {
        // Ascending and none twice: their number tells.
        self.pairs.len() == self.n * self.n.saturating_sub(1) / 2
    }

    /// The weight of all pairs, if every pair of two objects or more is listed with the same.
    pub(crate) fn complete_weight(&self) -> Option<f64> {
        let weight = self.pairs.first()?.weight;
        (self.is_complete() && self.pairs.iter().all(|pair| pair.weight == weight)).then_some(weight)
    }

    /// The pairs, ascending.
    #[must_use]
    pub fn pairs(&self) -> &[Pair] {
        &self.pairs
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pairs_that_make_no_problem_are_refused() {
        let good = Pair { i: 0, j: 1, distance: 1.0, weight: 1.0 };
        let refusal = |pairs: &[Pair]| match PairDistances::new(3, pairs.to_vec()).unwrap_err() {
            EmbedError::BadPair { i, j, n: 3, what } => (i, j, what),
            other => panic!("{other}"),
        };
        let order = "objects must satisfy i < j < n";
        assert_eq!(refusal(&[Pair { j: 3, ..good }]), (0, 3, order));
        assert_eq!(refusal(&[Pair { i: 1, ..good }]), (1, 1, order));
        assert_eq!(refusal(&[Pair { i: 2, ..good }]), (2, 1, order));
        let ascend = "pairs must ascend and none may be listed twice";
        assert_eq!(refusal(&[good, good]), (0, 1, ascend));
        assert_eq!(refusal(&[Pair { j: 2, ..good }, good]), (0, 1, ascend));
        for distance in [-1.0, f64::NAN, f64::INFINITY] {
            assert_eq!(
                refusal(&[Pair { distance, ..good }]).2,
                "the distance must be finite and not negative"
            );
        }
        for weight in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            let what = "the weight must be finite and positive; leave the pair out instead";
            assert_eq!(refusal(&[Pair { weight, ..good }]).2, what);
        }
        let error = PairDistances::new(3, vec![Pair { j: 3, ..good }]).unwrap_err();
        assert_eq!(error.to_string(), "pair (0, 3) of 3 objects: objects must satisfy i < j < n");
    }

    #[test]
    fn a_distance_of_zero_is_a_distance() {
        let pair = Pair { i: 0, j: 1, distance: 0.0, weight: 1.0 };
        assert_eq!(PairDistances::new(2, vec![pair]).unwrap().pairs(), [pair]);
    }
}
