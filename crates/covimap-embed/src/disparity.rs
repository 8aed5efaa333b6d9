//! Disparities: what the distances of a map are compared with.
//!
//! A disparity `e_ij` is a dissimilarity `d_ij` after a transformation that is fitted to the map.
//! With the configuration held fixed, the disparities that fit best are
//!
//! `e = argmin sum w_ij (e_ij - |x_i - x_j|)^2` over the set that the transformation admits.  (1)
//!
//! | transformation | admits | names elsewhere |
//! |---|---|---|
//! | [`Ratio`](Transformation::Ratio) | `e = d` | metric |
//! | [`Interval`](Transformation::Interval) | `e = a + b (d - min d)`, `a, b >= 0` | linear with an additive constant |
//! | [`Ordinal`](Transformation::Ordinal) | `e` rises with `d` | non-metric |
//! | [`MSpline`](Transformation::MSpline) | `e = f(d)`, `f` a rising [spline](crate::MonotoneSpline) | |
//! | [`Bounds`](Transformation::Bounds) | `lower <= e <= upper`, pair by pair | censored, hinge |
//!
//! The three in the middle admit every multiple of what they admit, zero too, so that all objects
//! in one place would fit perfectly. They are therefore held at the size of the dissimilarities,
//! `sum w e^2 = sum w d^2`. Over a cone the nearest point of given size is the nearest point,
//! rescaled; so (1) keeps its solution and the map its unit.
//!
//! # References
//! J. B. Kruskal, "Multidimensional scaling by optimizing goodness of fit to a nonmetric
//! hypothesis", Psychometrika 29, 1964. I. Borg, P. J. F. Groenen, "Modern Multidimensional
//! Scaling", 2nd ed., Springer 2005, ch. 9. R. L. Dykstra, "An algorithm for restricted least
//! squares regression", J. Am. Stat. Assoc. 78, 1983.

use rayon::prelude::*;

use crate::spline::SplineDesign;
use crate::stress::{CHUNK, distance};
use crate::{DissimilarityOrder, EmbedError, MonotoneSplineBasis, PairDistances, Point, Ties};

/// Rounds of [`non_negative_tertiary`] before its values stand as they are; one is the rule.
const ROUNDS: usize = 200;
/// A value is positive if it is above minus this share of the largest distance.
const POSITIVE: f64 = 1e-12;

/// How disparities follow from dissimilarities; the vocabulary is that of R's smacof.
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Transformation {
    /// The dissimilarities are distances in some unit.
    #[default]
    Ratio,
    /// Distances but for an additive constant and a factor, both fitted and `>= 0`.
    Interval,
    /// Only their order counts.
    Ordinal(Ties),
    /// Distances after a smooth rising curve.
    MSpline {
        /// Degree of the polynomial pieces, 1 or more; 2 is usual.
        degree: usize,
        /// Number of pieces less one; 2 is usual.
        interior_knots: usize,
    },
    /// Any distance within the bounds of a pair is right.
    Bounds(PairBounds),
}

/// A lower and an upper bound for each pair of a list.
///
/// A pair that is known to be *at least* so far apart has an infinite upper bound. The distance of
/// the pair itself, brought within the bounds, serves the first step only.
#[derive(Debug, Clone, PartialEq)]
pub struct PairBounds {
    lower: Vec<f64>,
    upper: Vec<f64>,
}

impl PairBounds {
    /// Bounds in the order of the pairs.
    ///
    /// # Errors
    /// [`EmbedError::Lengths`] if there are not as many of each; [`EmbedError::BadObservation`]
    /// unless `0 <= lower <= upper` and `lower` is finite.
    pub fn new(lower: Vec<f64>, upper: Vec<f64>) -> Result<Self, EmbedError> {
        if lower.len() != upper.len() {
            return Err(EmbedError::Lengths { first: lower.len(), second: upper.len() });
        }
        let good = |(lower, upper): (&f64, &f64)| *lower >= 0.0 && lower.is_finite() && upper >= lower;
        if let Some(index) = lower.iter().zip(&upper).position(|bounds| !good(bounds)) {
            let what = "bounds must satisfy 0 <= lower <= upper with a finite lower one";
            return Err(EmbedError::BadObservation { index, what });
        }
        Ok(Self { lower, upper })
    }

    fn clip(&self, values: &[f64]) -> Vec<f64> {
        let bounds = self.lower.iter().zip(&self.upper);
        values.iter().zip(bounds).map(|(value, (&lower, &upper))| value.clamp(lower, upper)).collect()
    }
}

/// Eq. (1) for one pair list.
pub(crate) struct Disparities<'a> {
    pairs: &'a PairDistances,
    weights: Vec<f64>,
    /// `sum w d^2`.
    size: f64,
    rule: Rule<'a>,
}

enum Rule<'a> {
    /// They are the dissimilarities.
    Fixed,
    Bounds(&'a PairBounds),
    Ordinal(DissimilarityOrder, Ties),
    Spline(SplineDesign),
}

impl<'a> Disparities<'a> {
    /// Prepares the transformation.
    pub fn new(pairs: &'a PairDistances, transformation: &'a Transformation) -> Result<Self, EmbedError> {
        let weights: Vec<f64> = pairs.pairs().iter().map(|pair| pair.weight).collect();
        let given: Vec<f64> = pairs.pairs().iter().map(|pair| pair.distance).collect();
        let spline = |interior_knots, degree| {
            match MonotoneSplineBasis::at_quantiles(&given, interior_knots, degree) {
                Ok(basis) => Ok(Rule::Spline(SplineDesign::new(&basis, &given, &weights))),
                // Equal dissimilarities stay equal, and of the size that they have.
                Err(EmbedError::NoRange { .. }) => Ok(Rule::Fixed),
                Err(error) => Err(error),
            }
        };
        let rule = match transformation {
            Transformation::Ratio => Rule::Fixed,
            Transformation::Interval => spline(0, 1)?,
            Transformation::Ordinal(ties) => Rule::Ordinal(DissimilarityOrder::new(&given)?, *ties),
            &Transformation::MSpline { degree, interior_knots } => spline(interior_knots, degree)?,
            Transformation::Bounds(bounds) => {
                if bounds.lower.len() != given.len() {
                    return Err(EmbedError::Lengths { first: given.len(), second: bounds.lower.len() });
                }
                Rule::Bounds(bounds)
            }
        };
        let size = given.iter().zip(&weights).map(|(d, w)| w * d * d).sum();
        Ok(Self { pairs, weights, size, rule })
    }

    /// Those before the first step: the dissimilarities, which all transformations admit, within
    /// their bounds if they have any.
    pub fn first(&self) -> Vec<f64> {
        let given: Vec<f64> = self.pairs.pairs().iter().map(|pair| pair.distance).collect();
        match self.rule {
            Rule::Bounds(bounds) => bounds.clip(&given),
            _ => given,
        }
    }

    /// Whether they change with the points.
    pub fn are_fitted(&self) -> bool {
        !matches!(self.rule, Rule::Fixed)
    }

    /// Those that fit `points` best; none if what fits is all zero, as where all objects coincide,
    /// or if they are the dissimilarities anyhow.
    pub fn fit(&self, points: &[Point]) -> Option<Vec<f64>> {
        let mut fitted = match &self.rule {
            Rule::Fixed => return None,
            Rule::Bounds(bounds) => return Some(bounds.clip(&self.distances(points))),
            Rule::Ordinal(order, Ties::Tertiary) => {
                non_negative_tertiary(order, &self.distances(points), &self.weights)
            }
            Rule::Ordinal(order, ties) => order.nearest(&self.distances(points), &self.weights, *ties),
            Rule::Spline(design) => design.values(&design.nearest(&self.distances(points))),
        };
        let size: f64 = fitted.iter().zip(&self.weights).map(|(e, w)| w * e * e).sum();
        let factor = (self.size / size).sqrt();
        fitted.iter_mut().for_each(|disparity| *disparity *= factor);
        (size > 0.0).then_some(fitted)
    }

    fn distances(&self, points: &[Point]) -> Vec<f64> {
        let of = |pair: &crate::Pair| distance(points[pair.i as usize], points[pair.j as usize]);
        self.pairs.pairs().par_iter().with_min_len(CHUNK).map(of).collect()
    }
}

/// The tertiary disparities nearest to the distances that are not negative.
///
/// A tie that is lowered as a whole may fall below zero with its least distances, and
/// majorisation needs disparities `>= 0`. Dykstra's algorithm: to and fro between the two
/// demands, each time taking back what the same demand changed before.
fn non_negative_tertiary(order: &DissimilarityOrder, distances: &[f64], weights: &[f64]) -> Vec<f64> {
    let largest = distances.iter().fold(0.0, |most: f64, &d| most.max(d));
    let mut values = distances.to_vec();
    let mut by_order = vec![0.0; values.len()];
    let mut by_sign = vec![0.0; values.len()];
    for _ in 0..ROUNDS {
        let asked: Vec<f64> = values.iter().zip(&by_order).map(|(value, change)| value + change).collect();
        let ordered = order.nearest(&asked, weights, Ties::Tertiary);
        let least = ordered.iter().fold(0.0, |least: f64, &value| least.min(value));
        for k in 0..values.len() {
            by_order[k] = asked[k] - ordered[k];
            values[k] = (ordered[k] + by_sign[k]).max(0.0);
            by_sign[k] += ordered[k] - values[k];
        }
        if least >= -POSITIVE * largest {
            break;
        }
    }
    values
}

#[cfg(test)]
mod tests;
