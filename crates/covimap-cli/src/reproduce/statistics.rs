//! Means with standard errors, and correlations.

/// A mean over independent runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mean {
    /// Number of values.
    pub n: usize,
    /// Mean; NaN of no values.
    pub mean: f64,
    /// Standard error of the mean, `sqrt(sum (x - mean)^2 / (n (n - 1)))`; `None` of fewer than two values.
    pub error: Option<f64>,
}

impl Mean {
    pub fn of(values: &[f64]) -> Self {
        let n = values.len();
        let mean = values.iter().sum::<f64>() / n as f64;
        let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
        let error = (n > 1).then(|| (squares / (n as f64 * (n as f64 - 1.0))).sqrt());
        Self { n, mean, error }
    }

    /// The standard error as text, empty where there is none.
    pub fn error_text(&self) -> String {
        self.error.map_or(String::new(), |error| format!("{error:.5}"))
    }
}

/// Least-squares line through points and their correlation coefficient (Pearson).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Line {
    /// Value at 0.
    pub intercept: f64,
    /// Change per unit of x.
    pub slope: f64,
    /// Correlation coefficient, -1 to 1.
    pub correlation: f64,
}

impl Line {
    /// `None` where x or y does not vary.
    pub fn fit(points: &[[f64; 2]]) -> Option<Self> {
        let n = points.len() as f64;
        let centre = [0, 1].map(|axis| points.iter().map(|point| point[axis]).sum::<f64>() / n);
        let moment = |a: usize, b: usize| -> f64 {
            points.iter().map(|point| (point[a] - centre[a]) * (point[b] - centre[b])).sum()
        };
        let (xx, xy, yy) = (moment(0, 0), moment(0, 1), moment(1, 1));
        let slope = xy / xx;
        (xx > 0.0 && yy > 0.0).then(|| Self {
            intercept: centre[1] - slope * centre[0],
            slope,
            correlation: xy / (xx * yy).sqrt(),
        })
    }

    pub fn at(&self, x: f64) -> f64 {
        self.intercept + self.slope * x
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mean_has_an_error_from_two_values_on() {
        // Mean 3; squares 4 + 0 + 4 = 8; sqrt(8 / (3 * 2)).
        let mean = Mean::of(&[1.0, 3.0, 5.0]);
        assert_eq!((mean.n, mean.mean), (3, 3.0));
        assert!((mean.error.unwrap() - (8.0f64 / 6.0).sqrt()).abs() < 1e-15);
        assert_eq!(Mean::of(&[2.0]), Mean { n: 1, mean: 2.0, error: None });
        assert!(Mean::of(&[]).mean.is_nan());
        assert_eq!(Mean::of(&[2.0]).error_text(), "");
    }

    #[test]
    fn a_line_through_its_points_and_their_correlation() {
        // Centre (2, 3); xx = 2, xy = -2, yy = 8 / 3 with deviations (-1, 4/3), (0, -2/3), (1, -2/3).
        let line = Line::fit(&[[1.0, 13.0 / 3.0], [2.0, 7.0 / 3.0], [3.0, 7.0 / 3.0]]).unwrap();
        assert!((line.slope + 1.0).abs() < 1e-14 && (line.at(2.0) - 3.0).abs() < 1e-14, "{line:?}");
        assert!((line.correlation + 2.0 / (2.0f64 * 8.0 / 3.0).sqrt()).abs() < 1e-14, "{line:?}");
        assert_eq!(Line::fit(&[[1.0, 2.0], [1.0, 3.0]]), None);
        assert_eq!(Line::fit(&[]), None);
    }
}
