//! How far ranges are off: by how much in any case, and how much more when the landmark is farther.

/// Groups of ranges, from near to far, whose deviations are compared.
const GROUPS: usize = 8;
/// Standard deviation over the median of the absolute values, of a normal distribution.
pub(super) const NORMAL: f64 = 1.4826;
/// Rounds of the fit, each with the weights of the last.
const ROUNDS: usize = 10;

/// Variance of a range over its length, `a + b d^2`, metres squared.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Noise {
    pub fixed: f64,
    pub growing: f64,
}

impl Noise {
    /// Fits the medians of groups of like length. `looks` are lengths and misses, metres; a variance is at least
    /// `least`.
    pub fn fit(mut looks: Vec<(f64, f64)>, least: f64) -> Self {
        looks.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
        let size = looks.len().div_ceil(GROUPS).max(1);
        let groups: Vec<[f64; 2]> = looks
            .chunks(size)
            .filter_map(|group| {
                let square = group.iter().map(|look| look.0 * look.0).sum::<f64>() / group.len() as f64;
                let mut misses: Vec<f64> = group.iter().map(|look| look.1.abs()).collect();
                Some([square, (NORMAL * median(&mut misses)?).powi(2).max(least)])
            })
            .collect();
        let mean = groups.iter().map(|group| group[1]).sum::<f64>() / groups.len().max(1) as f64;
        let mut noise = Self { fixed: mean.max(least), growing: 0.0 };
        for _ in 0..ROUNDS {
            noise = noise.refined(&groups, least);
        }
        noise
    }

    /// `min sum ((v - a - b q) / v')^2` over the groups, `v'` being the variances as they were, `a >= least`, `b >= 0`.
    fn refined(self, groups: &[[f64; 2]], least: f64) -> Self {
        let (mut n, mut sq, mut sqq, mut sv, mut sqv) = (0.0, 0.0, 0.0, 0.0, 0.0);
        for &[q, v] in groups {
            let w = (self.fixed + self.growing * q).powi(-2);
            (n, sq, sqq, sv, sqv) = (n + w, sq + w * q, sqq + w * q * q, sv + w * v, sqv + w * q * v);
        }
        let determinant = n * sqq - sq * sq;
        let both = [(sqq * sv - sq * sqv) / determinant, (n * sqv - sq * sv) / determinant];
        match both {
            [fixed, growing] if fixed >= least && growing >= 0.0 => Self { fixed, growing },
            // One of the two alone.
            [fixed, _] if fixed < least => Self { fixed: least, growing: (sqv / sqq).max(0.0) },
            _ => Self { fixed: (sv / n).max(least), growing: 0.0 },
        }
    }

    pub fn variance(&self, length: f64) -> f64 {
        self.fixed + self.growing * length * length
    }
}

/// `None` of nothing.
pub(super) fn median(values: &mut [f64]) -> Option<f64> {
    let middle = values.len() / 2;
    (!values.is_empty()).then(|| *values.select_nth_unstable_by(middle, f64::total_cmp).1)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Misses of the two signs in turn, of the size that has this standard deviation as its normal one.
    fn looks(deviation: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
        let one = |k: u32| {
            let length = 0.1 + f64::from(k) / 1000.0;
            (length, if k.is_multiple_of(2) { 1.0 } else { -1.0 } * deviation(length) / NORMAL)
        };
        (0..800).map(one).collect()
    }

    #[test]
    fn noise_that_grows_and_noise_that_does_not_are_told_apart() {
        let fixed = Noise::fit(looks(|_| 0.05), 1e-12);
        assert!((fixed.variance(0.1) - 0.0025).abs() < 1e-6 && (fixed.variance(0.9) - 0.0025).abs() < 1e-6);
        let growing = Noise::fit(looks(|length| 0.1 * length), 1e-12);
        assert!((growing.growing - 0.01).abs() < 1e-3 && growing.fixed < 1e-4, "{growing:?}");
        let both = Noise::fit(looks(|length| (0.0025 + 0.01 * length * length).sqrt()), 1e-12);
        assert!((both.growing - 0.01).abs() < 1e-3 && (both.fixed - 0.0025).abs() < 3e-4, "{both:?}");
        // Noise that falls with the length is taken for one that does not change.
        let falling = Noise::fit(looks(|length| 0.1 - 0.05 * length), 1e-12);
        assert!(falling.growing == 0.0 && falling.fixed > 0.0, "{falling:?}");
    }

    #[test]
    fn misses_of_nothing_have_the_least_variance() {
        for looks in [vec![(0.5, 0.0); 20], vec![(0.5, 0.0)], Vec::new()] {
            assert_eq!(Noise::fit(looks, 1e-8).variance(1.0), 1e-8);
        }
    }
}
