//! Complete tables of distances between objects.

use crate::{EmbedError, PairDistances};

/// A symmetric table of distances with a zero diagonal, stored row by row.
///
/// Entries are `>= 0` and never NaN. Infinity says that nothing is known of a pair;
/// [`metric_closure`](Self::metric_closure) replaces it where a path of known distances exists.
/// Memory: `8 n^2` bytes.
///
/// ```
/// use covimap_embed::DistanceMatrix;
///
/// let line = DistanceMatrix::from_fn(3, |i, j| (j - i) as f64)?;
/// assert_eq!(line.row(0), [0.0, 1.0, 2.0]);
/// assert_eq!(line.map(|d| d * d)?.get(2, 0), 4.0);
/// # Ok::<(), covimap_embed::EmbedError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct DistanceMatrix {
    n: usize,
    values: Vec<f64>,
}

impl DistanceMatrix {
    /// Asks `distance(i, j)` for each pair `i < j` of `n` objects.
    ///
    /// # Errors
    /// [`EmbedError::BadDistance`] if an answer is negative or NaN.
    pub fn from_fn(n: usize, mut distance: impl FnMut(usize, usize) -> f64) -> Result<Self, EmbedError> {
        let mut values = vec![0.0; n * n];
        for i in 0..n {
            for j in i + 1..n {
                let d = checked(i, j, distance(i, j))?;
                values[i * n + j] = d;
                values[j * n + i] = d;
            }
        }
        Ok(Self { n, values })
    }

    /// Takes a table of `n` rows of `n` entries.
    ///
    /// # Errors
    /// [`EmbedError::NotSquare`] if there are not `n * n` entries; [`EmbedError::BadDistance`] for
    /// the first entry that is negative or NaN, off zero on the diagonal, or not equal to its
    /// mirror image.
    pub fn from_rows(n: usize, values: Vec<f64>) -> Result<Self, EmbedError> {
        if n.checked_mul(n) != Some(values.len()) {
            return Err(EmbedError::NotSquare { n, entries: values.len() });
        }
        for i in 0..n {
            for j in 0..=i {
                let distance = checked(i, j, values[i * n + j])?;
                let bad = |what| Err(EmbedError::BadDistance { i, j, distance, what });
                if i == j && distance != 0.0 {
                    return bad("the distance of an object to itself must be zero");
                }
                if distance != values[j * n + i] {
                    return bad("the table must be symmetric; average the two entries first");
                }
            }
        }
        Ok(Self { n, values })
    }

    /// The listed distances; every other pair is infinite, that is, unknown.
    #[must_use]
    pub fn from_pairs(known: &PairDistances) -> Self {
        let n = known.objects();
        let mut values = vec![f64::INFINITY; n * n];
        for i in 0..n {
            values[i * n + i] = 0.0;
        }
        for pair in known.pairs() {
            let (i, j) = (pair.i as usize, pair.j as usize);
            values[i * n + j] = pair.distance;
            values[j * n + i] = pair.distance;
        }
        Self { n, values }
    }

    /// Number of objects.
    #[must_use]
    pub fn objects(&self) -> usize {
        self.n
    }

    /// The distance of objects `i` and `j`.
    ///
    /// # Panics
    /// If `i` or `j` is not smaller than the number of objects.
    #[must_use]
    pub fn get(&self, i: usize, j: usize) -> f64 {
        self.row(i)[j]
    }

    /// The distances of object `i` to all objects.
    ///
    /// # Panics
    /// If `i` is not smaller than the number of objects.
    #[must_use]
    pub fn row(&self, i: usize) -> &[f64] {
        &self.values[i * self.n..(i + 1) * self.n]
    }

    /// The table of `f(distance)` over all pairs of different objects.
    ///
    /// # Errors
    /// [`EmbedError::BadDistance`] if `f` returns a negative number or NaN.
    pub fn map(&self, mut f: impl FnMut(f64) -> f64) -> Result<Self, EmbedError> {
        Self::from_fn(self.n, |i, j| f(self.get(i, j)))
    }

    /// The first pair, row by row, of which nothing is known.
    #[must_use]
    pub fn first_unknown(&self) -> Option<(usize, usize)> {
        let at = self.values.iter().position(|d| d.is_infinite())?;
        Some((at / self.n, at % self.n))
    }

    /// All entries, row by row, for stages that keep the table valid.
    pub(crate) fn values_mut(&mut self) -> &mut [f64] {
        &mut self.values
    }
}

fn checked(i: usize, j: usize, distance: f64) -> Result<f64, EmbedError> {
    if distance >= 0.0 {
        return Ok(distance);
    }
    Err(EmbedError::BadDistance { i, j, distance, what: "a distance must be a number and not negative" })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Pair;

    #[test]
    fn entries_are_asked_once_per_pair_and_mirrored() {
        let mut asked = Vec::new();
        let matrix = DistanceMatrix::from_fn(3, |i, j| {
            asked.push((i, j));
            (10 * i + j) as f64
        })
        .unwrap();
        assert_eq!(asked, [(0, 1), (0, 2), (1, 2)]);
        assert_eq!(
            matrix,
            DistanceMatrix::from_rows(3, vec![0.0, 1.0, 2.0, 1.0, 0.0, 12.0, 2.0, 12.0, 0.0]).unwrap()
        );
        assert_eq!(matrix.first_unknown(), None);
    }

    #[test]
    fn bad_tables_are_refused_with_the_entry() {
        let at = |result: Result<DistanceMatrix, EmbedError>| match result.unwrap_err() {
            EmbedError::BadDistance { i, j, .. } => (i, j),
            other => panic!("{other}"),
        };
        assert_eq!(at(DistanceMatrix::from_fn(3, |i, _| if i == 1 { f64::NAN } else { 1.0 })), (1, 2));
        assert_eq!(at(DistanceMatrix::from_fn(2, |_, _| -1.0)), (0, 1));
        assert_eq!(at(DistanceMatrix::from_rows(2, vec![0.0, 1.0, 2.0, 0.0])), (1, 0));
        assert_eq!(at(DistanceMatrix::from_rows(2, vec![0.0, 1.0, 1.0, 0.5])), (1, 1));
        assert!(matches!(
            DistanceMatrix::from_rows(2, vec![0.0; 3]),
            Err(EmbedError::NotSquare { n: 2, entries: 3 })
        ));
        let text = DistanceMatrix::from_fn(2, |_, _| -1.0).unwrap_err().to_string();
        assert_eq!(text, "distance of objects (0, 1) is -1: a distance must be a number and not negative");
    }

    #[test]
    fn pairs_that_are_not_listed_are_unknown() {
        let pair = Pair { i: 0, j: 2, distance: 4.0, weight: 1.0 };
        let matrix = DistanceMatrix::from_pairs(&PairDistances::new(3, vec![pair]).unwrap());
        assert_eq!(matrix.row(2), [4.0, f64::INFINITY, 0.0]);
        assert_eq!(matrix.first_unknown(), Some((0, 1)));
    }

    #[test]
    fn no_objects_make_an_empty_table() {
        let empty = DistanceMatrix::from_fn(0, |_, _| 1.0).unwrap();
        assert_eq!((empty.objects(), empty.first_unknown()), (0, None));
    }
}
