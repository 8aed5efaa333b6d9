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

use crate::EmbedError;
use crate::isotonic::check_observations;

mod design;

pub(crate) use design::SplineDesign;

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
        let coefficients = SplineDesign::new(self, x, weights).nearest(y);
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
mod tests;
