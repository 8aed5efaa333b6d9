//! Monotone regression: the nearest values that rise in a given order.
//!
//! For values `y_1 .. y_n` with weights `w_k > 0`, find `z_1 <= .. <= z_n` that minimise
//!
//! `sum_k w_k (z_k - y_k)^2`.  (1)
//!
//! In ordinal scaling the order is that of given dissimilarities, the values are the present
//! distances, and `z` are the disparities. What is asked where dissimilarities are equal is a
//! choice, see [`Ties`].
//!
//! # Algorithm
//! Up-and-down blocks: every value opens a block; a block whose mean is below that of its
//! predecessor is merged with it, and again, while there is one out of order. The blocks' means
//! solve (1).
//!
//! # Complexity
//! `O(n)`; with [`Ties::Primary`] `O(n log t)` for at most `t` equal dissimilarities.
//!
//! # References
//! J. B. Kruskal, "Nonmetric multidimensional scaling: a numerical method", Psychometrika 29,
//! 1964. J. de Leeuw, K. Hornik, P. Mair, "Isotone optimization in R", J. Stat. Software 32(5),
//! 2009.

use std::ops::Range;

use crate::EmbedError;

/// What is asked of the disparities of pairs whose dissimilarities are equal.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Ties {
    /// Nothing: they may come apart, in the order of their distances.
    #[default]
    Primary,
    /// They are equal.
    Secondary,
    /// Their mean is monotone; each keeps its distance from the mean.
    Tertiary,
}

/// Minimises (1) in the order given.
///
/// # Errors
/// [`EmbedError::BadObservation`] for a value that is not finite or a weight that is not finite
/// and positive; [`EmbedError::Lengths`] if there are not as many weights as values.
///
/// # Examples
/// ```
/// use covimap_embed::isotonic_regression;
///
/// // 3 before 2 is out of order: both become their mean.
/// assert_eq!(isotonic_regression(&[1.0, 3.0, 2.0, 4.0], &[1.0; 4])?, [1.0, 2.5, 2.5, 4.0]);
/// # Ok::<(), covimap_embed::EmbedError>(())
/// ```
pub fn isotonic_regression(values: &[f64], weights: &[f64]) -> Result<Vec<f64>, EmbedError> {
    check_observations(values, weights)?;
    Ok(pool_adjacent_violators(values.iter().copied().zip(weights.iter().copied())))
}

/// (1) for pairs of value and weight.
fn pool_adjacent_violators(observations: impl Iterator<Item = (f64, f64)>) -> Vec<f64> {
    // Mean, weight and number of values of each block.
    let mut blocks: Vec<(f64, f64, usize)> = Vec::new();
    let mut values = 0;
    for (value, weight) in observations {
        let (mut mean, mut total, mut count) = (value, weight, 1);
        while let Some(&(before, weight, members)) = blocks.last().filter(|block| block.0 > mean) {
            mean = (before * weight + mean * total) / (weight + total);
            total += weight;
            count += members;
            blocks.pop();
        }
        blocks.push((mean, total, count));
        values += 1;
    }
    let mut fitted = Vec::with_capacity(values);
    for (mean, _, count) in blocks {
        fitted.resize(fitted.len() + count, mean);
    }
    fitted
}

/// Refuses numbers that a least-squares fit cannot take.
pub(crate) fn check_observations(values: &[f64], weights: &[f64]) -> Result<(), EmbedError> {
    if values.len() != weights.len() {
        return Err(EmbedError::Lengths { first: values.len(), second: weights.len() });
    }
    let bad = |index, what| Err(EmbedError::BadObservation { index, what });
    if let Some(index) = values.iter().position(|value| !value.is_finite()) {
        return bad(index, "the value must be finite");
    }
    if let Some(index) = weights.iter().position(|weight| !(*weight > 0.0 && weight.is_finite())) {
        return bad(index, "the weight must be finite and positive; leave the observation out instead");
    }
    Ok(())
}

/// The order of dissimilarities, to be used again and again with new distances.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DissimilarityOrder {
    /// Indices by ascending dissimilarity, equal ones by ascending index.
    ascending: Vec<u32>,
    /// Where each run of equal dissimilarities starts, and the end of the last.
    runs: Vec<u32>,
}

impl DissimilarityOrder {
    /// Sorts the dissimilarities, `O(n log n)`.
    ///
    /// # Errors
    /// [`EmbedError::BadObservation`] for a dissimilarity that is NaN.
    pub fn new(dissimilarities: &[f64]) -> Result<Self, EmbedError> {
        if let Some(index) = dissimilarities.iter().position(|d| d.is_nan()) {
            return Err(EmbedError::BadObservation { index, what: "a dissimilarity must be a number" });
        }
        let of = |index: u32| dissimilarities[index as usize];
        let mut ascending: Vec<u32> = (0..dissimilarities.len() as u32).collect();
        // Zero of either sign is the same dissimilarity: adding zero makes it positive.
        ascending.sort_unstable_by(|&a, &b| (of(a) + 0.0).total_cmp(&(of(b) + 0.0)).then(a.cmp(&b)));
        let mut runs = vec![0];
        for run in ascending.chunk_by(|&a, &b| of(a) == of(b)) {
            runs.push(runs[runs.len() - 1] + run.len() as u32);
        }
        Ok(Self { ascending, runs })
    }

    /// The disparities: values near `distances` that rise with the dissimilarities.
    ///
    /// # Errors
    /// As [`isotonic_regression`]; [`EmbedError::Lengths`] also if there are not as many distances
    /// as dissimilarities.
    pub fn disparities(
        &self,
        distances: &[f64],
        weights: &[f64],
        ties: Ties,
    ) -> Result<Vec<f64>, EmbedError> {
        if distances.len() != self.ascending.len() {
            return Err(EmbedError::Lengths { first: self.ascending.len(), second: distances.len() });
        }
        check_observations(distances, weights)?;
        Ok(self.nearest(distances, weights, ties))
    }

    /// The disparities of checked distances, one a dissimilarity.
    pub(crate) fn nearest(&self, distances: &[f64], weights: &[f64], ties: Ties) -> Vec<f64> {
        let mut disparities = vec![0.0; distances.len()];
        match ties {
            Ties::Primary => self.untied(distances, weights, &mut disparities),
            Ties::Secondary | Ties::Tertiary => {
                let keep = f64::from(u8::from(ties == Ties::Tertiary));
                self.by_runs(distances, weights, keep, &mut disparities);
            }
        }
        disparities
    }

    fn untied(&self, distances: &[f64], weights: &[f64], disparities: &mut [f64]) {
        let mut order = self.ascending.clone();
        for run in self.runs() {
            order[run].sort_by(|&a, &b| distances[a as usize].total_cmp(&distances[b as usize]));
        }
        let observation = |&k: &u32| (distances[k as usize], weights[k as usize]);
        let fitted = pool_adjacent_violators(order.iter().map(observation));
        for (k, disparity) in order.into_iter().zip(fitted) {
            disparities[k as usize] = disparity;
        }
    }

    /// One value for each run of equal dissimilarities, plus `keep` times what sets each distance
    /// off from the mean of its run.
    fn by_runs(&self, distances: &[f64], weights: &[f64], keep: f64, disparities: &mut [f64]) {
        let mean = |run: Range<usize>| {
            let (mut sum, mut weight) = (0.0, 0.0);
            for &k in &self.ascending[run] {
                sum += weights[k as usize] * distances[k as usize];
                weight += weights[k as usize];
            }
            (sum / weight, weight)
        };
        let means: Vec<(f64, f64)> = self.runs().map(mean).collect();
        let fitted = pool_adjacent_violators(means.iter().copied());
        for ((run, (mean, _)), fitted) in self.runs().zip(means).zip(fitted) {
            for &k in &self.ascending[run] {
                disparities[k as usize] = fitted + keep * (distances[k as usize] - mean);
            }
        }
    }

    /// The places of each run of equal dissimilarities.
    fn runs(&self) -> impl Iterator<Item = Range<usize>> {
        self.runs.windows(2).map(|ends| ends[0] as usize..ends[1] as usize)
    }
}

#[cfg(test)]
mod tests;
