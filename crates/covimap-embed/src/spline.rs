//! Monotone splines: a smooth rising curve through a cloud of points.
//!
//! Integrated splines `I_1 .. I_p` of degree `d` rise from 0 to 1 over a range that is cut at
//! interior knots, so that every curve
//!
//! `f(x) = b_0 + sum_m b_m I_m(x)`, `b_m >= 0`  (1)
//!
//! rises, with `p = d + number of interior knots` and `d - 1` continuous derivatives. It is fitted
//! by least squares with coefficients `>= 0`, `b_0` among them: a fitted distance is never
//! negative. With the clamped B-splines `B_0 .. B_p` of the same degree, which sum to one,
//!
//! `I_m(x) = sum_(k >= m) B_k(x)`.  (2)
//!
//! # Complexity
//! `O(n d^2)` for the normal equations of `n` points and `O(p^4)` for their solution.
//!
//! # References
//! J. O. Ramsay, "Monotone regression splines in action", Statistical Science 3(4), 1988.

use nalgebra::{DMatrix, DVector};

use crate::EmbedError;
use crate::isotonic::check_observations;
use crate::nnls::non_negative_least_squares;

/// The curves (1) over a fixed range and fixed knots.
#[derive(Debug, Clone, PartialEq)]
pub struct MonotoneSplineBasis {
    degree: usize,
    /// Clamped knots: each end `degree + 1` times.
    knots: Vec<f64>,
}

/// One curve (1).
#[derive(Debug, Clone, PartialEq)]
pub struct MonotoneSpline {
    basis: MonotoneSplineBasis,
    /// `b_0 .. b_p`.
    coefficients: Vec<f64>,
}

impl MonotoneSplineBasis {
    /// Knots at the quantiles of `x`, so that each piece holds about the same number of points.
    ///
    /// `degree` (1 or more; 2 is usual) is that of the polynomial pieces, `interior_knots` their
    /// number less one. Quantiles that fall together count as one knot.
    ///
    /// # Errors
    /// [`EmbedError::BadObservation`] for a value that is not finite;
    /// [`EmbedError::NoRange`] if there are not two different values; [`EmbedError::BadDegree`] for
    /// degree 0.
    ///
    /// # Examples
    /// ```
    /// use covimap_embed::MonotoneSplineBasis;
    ///
    /// // Points of the square root, which a quadratic spline with two knots follows closely.
    /// let x: Vec<f64> = (1..=100).map(|k| f64::from(k) / 100.0).collect();
    /// let y: Vec<f64> = x.iter().map(|x| x.sqrt()).collect();
    /// let curve = MonotoneSplineBasis::at_quantiles(&x, 2, 2)?.fit(&x, &y, &[1.0; 100])?;
    /// assert!((curve.value(0.5) - 0.5_f64.sqrt()).abs() < 0.01);
    /// # Ok::<(), covimap_embed::EmbedError>(())
    /// ```
    pub fn at_quantiles(x: &[f64], interior_knots: usize, degree: usize) -> Result<Self, EmbedError> {
        if degree == 0 {
            return Err(EmbedError::BadDegree);
        }
        if let Some(index) = x.iter().position(|x| !x.is_finite()) {
            return Err(EmbedError::BadObservation { index, what: "the value must be finite" });
        }
        let mut sorted = x.to_vec();
        sorted.sort_unstable_by(f64::total_cmp);
        let (Some(&lowest), Some(&highest)) = (sorted.first(), sorted.last()) else {
            return Err(EmbedError::NoRange { values: 0 });
        };
        if lowest == highest {
            return Err(EmbedError::NoRange { values: x.len() });
        }
        let quantile = |k: usize| sorted[k * (sorted.len() - 1) / (interior_knots + 1)];
        let mut interior: Vec<f64> = (1..=interior_knots).map(quantile).collect();
        interior.retain(|&knot| knot > lowest && knot < highest);
        interior.dedup();
        let mut knots = vec![lowest; degree + 1];
        knots.extend(interior);
        knots.resize(knots.len() + degree + 1, highest);
        Ok(Self { degree, knots })
    }

    /// Number of coefficients, `p + 1`.
    #[must_use]
    pub fn coefficients(&self) -> usize {
        self.knots.len() - self.degree - 1
    }

    /// The curve nearest to the points `(x, y)` with the given weights, in least squares.
    ///
    /// # Errors
    /// [`EmbedError::Lengths`] if the lists differ in length; [`EmbedError::BadObservation`] for a
    /// number that is not finite or a weight that is not positive.
    pub fn fit(&self, x: &[f64], y: &[f64], weights: &[f64]) -> Result<MonotoneSpline, EmbedError> {
        check_observations(x, weights)?;
        check_observations(y, weights)?;
        let p = self.coefficients();
        let mut gram = DMatrix::zeros(p, p);
        let mut c = DVector::zeros(p);
        for ((&x, &y), &weight) in x.iter().zip(y).zip(weights) {
            // In B-splines only degree + 1 entries of a row are not zero.
            let (first, values) = self.b_splines(x);
            for (i, value) in values.iter().enumerate() {
                c[first + i] += weight * value * y;
                for (j, other) in values.iter().enumerate() {
                    gram[(first + i, first + j)] += weight * value * other;
                }
            }
        }
        // Eq. (2), I = T B with T upper triangular of ones: sums from the end, on either side.
        for k in (1..p).rev() {
            c[k - 1] += c[k];
            let below = gram.row(k).clone_owned();
            gram.row_mut(k - 1).zip_apply(&below, |entry, add| *entry += add);
        }
        for k in (1..p).rev() {
            let after = gram.column(k).clone_owned();
            gram.column_mut(k - 1).zip_apply(&after, |entry, add| *entry += add);
        }
        let coefficients = non_negative_least_squares(&gram, &c).iter().copied().collect();
        Ok(MonotoneSpline { basis: self.clone(), coefficients })
    }

    /// The first B-spline that is not zero at `x` and the values of the `degree + 1` from there.
    /// Values outside the range count as its ends.
    ///
    /// The recurrence of de Boor and Cox.
    fn b_splines(&self, x: f64) -> (usize, Vec<f64>) {
        let (degree, knots) = (self.degree, &self.knots);
        let x = x.clamp(knots[0], knots[knots.len() - 1]);
        // The piece `knots[piece] <= x < knots[piece + 1]`, the last one closed.
        let piece = (knots.partition_point(|&knot| knot <= x) - 1).min(self.coefficients() - 1);
        let mut values = vec![0.0; degree + 1];
        values[0] = 1.0;
        for d in 1..=degree {
            let mut carried = 0.0;
            for (k, value) in values[..d].iter_mut().enumerate() {
                let (from, to) = (knots[piece + k + 1 - d], knots[piece + k + 1]);
                let share = *value / (to - from);
                *value = carried + (to - x) * share;
                carried = (x - from) * share;
            }
            values[d] = carried;
        }
        (piece - degree, values)
    }
}

impl MonotoneSpline {
    /// `f(x)`, eq. (1); constant outside the range of the knots.
    #[must_use]
    pub fn value(&self, x: f64) -> f64 {
        let (first, values) = self.basis.b_splines(x);
        // Eq. (2) exchanged: sum_m b_m sum_(k >= m) B_k = sum_k B_k sum_(m <= k) b_m.
        let mut level: f64 = self.coefficients[..first].iter().sum();
        let mut sum = 0.0;
        for (b, value) in self.coefficients[first..].iter().zip(values) {
            level += b;
            sum += level * value;
        }
        sum
    }

    /// `b_0 .. b_p`, all `>= 0`.
    #[must_use]
    pub fn coefficients(&self) -> &[f64] {
        &self.coefficients
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn grid(n: usize) -> Vec<f64> {
        (0..n).map(|k| k as f64 / (n - 1) as f64).collect()
    }

    #[test]
    fn the_integrated_splines_rise_from_zero_to_one() {
        for degree in 1..4 {
            let basis = MonotoneSplineBasis::at_quantiles(&grid(50), 3, degree).unwrap();
            let p = basis.coefficients();
            assert_eq!(p, degree + 3 + 1);
            for m in 0..p {
                let mut coefficients = vec![0.0; p];
                coefficients[m] = 1.0;
                let curve = MonotoneSpline { basis: basis.clone(), coefficients };
                let values: Vec<f64> = grid(200).iter().map(|&x| curve.value(x)).collect();
                assert!(values.windows(2).all(|pair| pair[0] <= pair[1] + 1e-15), "I_{m} of degree {degree}");
                let start = if m == 0 { 1.0 } else { 0.0 };
                assert!((values[0] - start).abs() < 1e-15 && (values[199] - 1.0).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn a_quadratic_without_knots_is_worked_by_hand() {
        // Degree 2 on [0, 1]: B = (1-x)^2, 2x(1-x), x^2, hence I_1 = 2x - x^2 and I_2 = x^2.
        let basis = MonotoneSplineBasis::at_quantiles(&[0.0, 1.0], 0, 2).unwrap();
        let curve = MonotoneSpline { basis, coefficients: vec![1.0, 2.0, 4.0] };
        // 1 + 2 (0.6 - 0.09) + 4 * 0.09 = 2.38.
        assert!((curve.value(0.3) - 2.38).abs() < 1e-15);
        assert_eq!((curve.value(-5.0), curve.value(9.0)), (1.0, 7.0));
    }

    #[test]
    fn a_curve_of_the_family_is_found_again() {
        let x = grid(60);
        let basis = MonotoneSplineBasis::at_quantiles(&x, 2, 2).unwrap();
        let truth = MonotoneSpline { basis: basis.clone(), coefficients: vec![0.5, 1.0, 0.0, 2.0, 0.3] };
        let y: Vec<f64> = x.iter().map(|&x| truth.value(x)).collect();
        let fitted = basis.fit(&x, &y, &vec![2.0; 60]).unwrap();
        for (found, expected) in fitted.coefficients().iter().zip(truth.coefficients()) {
            assert!((found - expected).abs() < 1e-8, "{:?}", fitted.coefficients());
        }
    }

    proptest! {
        #[test]
        fn fits_rise_stay_above_zero_and_beat_the_constant(
            y in prop::collection::vec(-1.0..4.0_f64, 12), knots in 0_usize..5, degree in 1_usize..4,
        ) {
            let x = grid(12);
            let basis = MonotoneSplineBasis::at_quantiles(&x, knots, degree).unwrap();
            let fitted = basis.fit(&x, &y, &[1.0; 12]).unwrap();
            let values: Vec<f64> = x.iter().map(|&x| fitted.value(x)).collect();
            prop_assert!(values[0] >= 0.0 && values.windows(2).all(|pair| pair[0] <= pair[1] + 1e-12));
            let cost = |value: &dyn Fn(usize) -> f64| (0..12).map(|k| (value(k) - y[k]).powi(2)).sum::<f64>();
            let mean = (y.iter().sum::<f64>() / 12.0).max(0.0);
            prop_assert!(cost(&|k| values[k]) <= cost(&|_| mean) + 1e-9);
        }
    }

    #[test]
    fn repeated_values_make_fewer_knots() {
        let x = [0.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 2.0];
        let basis = MonotoneSplineBasis::at_quantiles(&x, 4, 2).unwrap();
        assert_eq!(basis.coefficients(), 2 + 1 + 1);
        let ends = MonotoneSplineBasis::at_quantiles(&[3.0, 3.0, 3.0, 4.0], 2, 1).unwrap();
        assert_eq!(ends.coefficients(), 2);
    }

    #[test]
    fn weights_decide_between_points_at_one_place() {
        // At x = 1 the values 2 and 5 with weights 2 and 1: 3. At x = 0 the value 1.
        let basis = MonotoneSplineBasis::at_quantiles(&[0.0, 1.0], 0, 1).unwrap();
        let fitted = basis.fit(&[0.0, 1.0, 1.0], &[1.0, 2.0, 5.0], &[1.0, 2.0, 1.0]).unwrap();
        assert!((fitted.value(0.0) - 1.0).abs() < 1e-9 && (fitted.value(1.0) - 3.0).abs() < 1e-9);
    }

    #[test]
    fn unusable_input_is_refused() {
        let of = MonotoneSplineBasis::at_quantiles;
        assert!(matches!(of(&[0.0, 1.0], 2, 0), Err(EmbedError::BadDegree)));
        assert!(matches!(of(&[], 2, 2), Err(EmbedError::NoRange { values: 0 })));
        assert!(matches!(of(&[1.0; 3], 2, 2), Err(EmbedError::NoRange { values: 3 })));
        let nan = of(&[0.0, f64::NAN], 2, 2);
        assert!(matches!(nan, Err(EmbedError::BadObservation { index: 1, .. })));
        let basis = of(&[0.0, 1.0], 0, 2).unwrap();
        assert!(matches!(basis.fit(&[0.0], &[0.0, 1.0], &[1.0]), Err(EmbedError::Lengths { .. })));
        assert!(matches!(basis.fit(&[f64::NAN], &[0.0], &[1.0]), Err(EmbedError::BadObservation { .. })));
        assert!(matches!(basis.fit(&[0.0], &[f64::NAN], &[1.0]), Err(EmbedError::BadObservation { .. })));
    }
}
