//! Tails of the Poisson distribution.

/// `ln P(X >= n)` for a Poisson variable of this mean; 0 where `n` does not exceed the mean, which
/// is no evidence of anything. Exact to `1e-9`.
pub(super) fn ln_tail(n: u32, mean: f64) -> f64 {
    if f64::from(n) <= mean {
        return 0.0;
    }
    if mean <= 0.0 {
        return f64::NEG_INFINITY;
    }
    // P(X = n) (1 + mean / (n + 1) + mean^2 / ((n + 1) (n + 2)) + ...)
    let (mut term, mut sum, mut next) = (1.0, 1.0, f64::from(n));
    while term > 1e-12 * sum {
        next += 1.0;
        term *= mean / next;
        sum += term;
    }
    (f64::from(n) * mean.ln() - mean - ln_factorial(n) + sum.ln()).min(0.0)
}

/// `ln n!`; from 10 on by Stirling's series, whose first term left out is below `1e-10` there.
fn ln_factorial(n: u32) -> f64 {
    if n < 10 {
        return (2..=n).map(f64::from).product::<f64>().ln();
    }
    let x = f64::from(n);
    let square = x * x;
    let correction = (1.0 / 12.0 - (1.0 / 360.0 - 1.0 / (1260.0 * square)) / square) / x;
    (x + 0.5) * x.ln() - x + 0.5 * std::f64::consts::TAU.ln() + correction
}

/// Which counts are too high for their mean, at one level of probability: a table instead of a
/// tail for every pair.
pub(super) struct Significance {
    ln_level: f64,
    /// Entry n: the largest mean at which n is still too high.
    largest_mean: Vec<f64>,
}

impl Significance {
    /// Counts in the table; means grow with the count, so that higher counts seldom need a tail.
    const TABLE: u32 = 64;

    /// Counts `n` with `ln P(X >= n) <= ln_level`.
    pub fn new(ln_level: f64) -> Self {
        let largest_mean = |n: u32| {
            let (mut low, mut high) = (0.0, f64::from(n));
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if ln_tail(n, middle) <= ln_level { low = middle } else { high = middle }
            }
            low
        };
        Self { ln_level, largest_mean: (0..Self::TABLE).map(largest_mean).collect() }
    }

    pub fn is_too_high(&self, n: u32, mean: f64) -> bool {
        mean <= self.largest_mean[n.min(Self::TABLE - 1) as usize] && n > 0
            || n >= Self::TABLE && ln_tail(n, mean) <= self.ln_level
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One minus the probabilities of 0 to n - 1, added up.
    fn slow_tail(n: u32, mean: f64) -> f64 {
        let mut term = (-mean).exp();
        let mut below = 0.0;
        for k in 0..n {
            below += term;
            term *= mean / f64::from(k + 1);
        }
        1.0 - below
    }

    #[test]
    fn tails_equal_the_sum_of_what_is_left() {
        for (n, mean) in [(1, 0.1), (2, 0.1), (3, 2.5), (9, 3.0), (10, 3.0), (25, 20.0), (40, 22.0)] {
            let (got, wanted) = (ln_tail(n, mean).exp(), slow_tail(n, mean));
            assert!((got - wanted).abs() < 1e-9 * wanted + 1e-14, "{n}, {mean}: {got}, {wanted}");
        }
        // P(X >= 1) = 1 - exp(-0.5) = 0.393469340.
        assert!((ln_tail(1, 0.5).exp() - 0.393_469_340).abs() < 1e-9);
        // Far out, where the probabilities below add up to 1: 5! = 120, (1e-3)^5 / 120 = 8.325e-18.
        let wanted = 1e-15 / 120.0 * (-1e-3f64).exp() * (1.0 + 1e-3 / 6.0);
        assert!((ln_tail(5, 1e-3).exp() / wanted - 1.0).abs() < 1e-6);
    }

    #[test]
    fn tails_without_evidence_and_without_chance() {
        assert_eq!(ln_tail(0, 0.0), 0.0);
        assert_eq!(ln_tail(0, 3.0), 0.0);
        assert_eq!(ln_tail(3, 3.0), 0.0);
        assert_eq!(ln_tail(1, 0.0), f64::NEG_INFINITY);
    }

    #[test]
    fn factorials_join_where_the_series_begins() {
        // ln 10! = ln 3628800.
        assert!((ln_factorial(10) - 3_628_800f64.ln()).abs() < 1e-9);
        assert!((ln_factorial(9) - 362_880f64.ln()).abs() < 1e-12);
        assert_eq!(ln_factorial(0), 0.0);
    }

    #[test]
    fn the_table_says_what_the_tail_says() {
        let level = 1e-7f64.ln();
        let significance = Significance::new(level);
        for n in [0, 1, 2, 5, 30, 63, 64, 65, 300] {
            for mean in [0.0, 1e-8, 0.01, 0.3, 1.0, 4.0, 20.0, 25.0, 200.0, 230.0] {
                let wanted = n > 0 && ln_tail(n, mean) <= level;
                assert_eq!(significance.is_too_high(n, mean), wanted, "{n}, {mean}");
            }
        }
    }
}
