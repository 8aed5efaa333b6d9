//! Distance functions: how far apart are two objects that are found together so often?
//!
//! Two objects are looked for again and again. In `m` looks at least one of them is found, in `n`
//! of these both are; the frequency `f = n / m` falls with their distance `d`. A *distance
//! function* is that falling curve, read either way:
//!
//! `f = g(d)`, and back `d = phi(f) = g^-1(f)`.  (1)
//!
//! | family | `g(d)` | parameters |
//! |---|---|---|
//! | log | `f0 exp(-(d/a)^2)` | `f0`, `a` |
//! | inverse | `1 / (1/f0 + (d/a)^2)` | `f0`, `a` |
//! | lens | `p l(u) / (2 - p l(u))`, `u = d / 2R` | `p`, `R` |
//! | power | `f0 exp(-(d/a)^c)` | `f0`, `a`, `c` |
//! | spline | `exp(-h(d))`, `h` a rising spline | 8 coefficients |
//! | isotonic | any falling curve | as many as the counts ask for |
//!
//! The lens is what a sensor with a sharp range `R` and detection probability `p` gives: both
//! objects are seen from where two discs overlap, of which
//! `l(u) = (2/pi) (acos u - u sqrt(1 - u^2))` is the share. At `d = 0` a curve starts at `f0 < 1`
//! because objects are missed now and then.
//!
//! # Algorithm
//! Given pairs with distances and counts, every family is fitted by the likelihood of the counts,
//!
//! `sum n ln g(d) + (m - n) ln (1 - g(d))`.  (2)
//!
//! The families with parameters by Fisher scoring with damping, from the best of several lengths;
//! the isotonic one exactly by pooling adjacent violators; the spline by least squares of
//! `-ln f` over bins of distance, weighted by its inverse variance `m f / (1 - f)`.
//!
//! # Complexity
//! `O(n log n)` to sort `n` observations into at most 256 bins; the fit itself sees only the bins.
//!
//! # Failure
//! Observations of a single distance determine no curve: [`EmbedError::NoRange`].
//!
//! # References
//! T. Yairi, K. Hori, K. Hirama, "Qualitative map learning based on co-visibility of objects" (the CoviMap paper), eqs. (9) and (10), for
//! inverse and log;
//! J. O. Ramsay, "Monotone regression splines in action", Statistical Science 3(4), 1988.

mod fit;
mod observation;
mod scoring;
mod shapes;
mod table;

use serde::{Deserialize, Serialize};

pub use observation::Observation;
pub use shapes::{InverseSquare, Lens, StretchedExponential};
pub use table::Tabulated;

/// A falling relation between distance and frequency, eq. (1).
pub trait DistanceFunction {
    /// `g(d)`: the frequency expected at a distance `>= 0`, in `[0, 1)`; falls with the distance.
    fn frequency(&self, distance: f64) -> f64;

    /// `phi(f)`: the distance at which a frequency in `(0, 1)` is expected, `>= 0`; 0 for
    /// frequencies above `g(0)`.
    fn distance(&self, frequency: f64) -> f64;
}

/// The families of distance functions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DistanceFamily {
    /// Gaussian in the distance: `phi(f)^2` is linear in `ln f`.
    Log,
    /// `phi(f)^2` is linear in `1/f`.
    Inverse,
    /// A sensor with a sharp range.
    Lens,
    /// A stretched exponential; log is its case `c = 2`.
    Power,
    /// `-ln f` is a rising spline in the distance.
    Spline,
    /// Any falling curve.
    Isotonic,
}

impl DistanceFamily {
    /// All families, those with fewer degrees of freedom first.
    pub const ALL: [Self; 6] =
        [Self::Log, Self::Inverse, Self::Lens, Self::Power, Self::Spline, Self::Isotonic];

    /// The name that files and command lines use.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Log => "log",
            Self::Inverse => "inverse",
            Self::Lens => "lens",
            Self::Power => "power",
            Self::Spline => "spline",
            Self::Isotonic => "isotonic",
        }
    }
}

/// A distance function of one of the families, with its parameters.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "family", rename_all = "snake_case")]
pub enum DistanceCurve {
    /// Exponent 2.
    Log(StretchedExponential),
    /// See [`InverseSquare`].
    Inverse(InverseSquare),
    /// See [`Lens`].
    Lens(Lens),
    /// Any exponent.
    Power(StretchedExponential),
    /// The spline, read off at many distances.
    Spline(Tabulated),
    /// The pooled values.
    Isotonic(Tabulated),
}

impl DistanceCurve {
    /// The family it is of.
    #[must_use]
    pub fn family(&self) -> DistanceFamily {
        match self {
            Self::Log(_) => DistanceFamily::Log,
            Self::Inverse(_) => DistanceFamily::Inverse,
            Self::Lens(_) => DistanceFamily::Lens,
            Self::Power(_) => DistanceFamily::Power,
            Self::Spline(_) => DistanceFamily::Spline,
            Self::Isotonic(_) => DistanceFamily::Isotonic,
        }
    }

    /// The same curve after all distances have been multiplied by a positive factor.
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        match self {
            Self::Log(curve) => Self::Log(curve.scaled(factor)),
            Self::Inverse(curve) => Self::Inverse(curve.scaled(factor)),
            Self::Lens(curve) => Self::Lens(curve.scaled(factor)),
            Self::Power(curve) => Self::Power(curve.scaled(factor)),
            Self::Spline(curve) => Self::Spline(curve.scaled(factor)),
            Self::Isotonic(curve) => Self::Isotonic(curve.scaled(factor)),
        }
    }

    fn as_function(&self) -> &dyn DistanceFunction {
        match self {
            Self::Log(curve) | Self::Power(curve) => curve,
            Self::Inverse(curve) => curve,
            Self::Lens(curve) => curve,
            Self::Spline(curve) | Self::Isotonic(curve) => curve,
        }
    }
}

impl DistanceFunction for DistanceCurve {
    fn frequency(&self, distance: f64) -> f64 {
        self.as_function().frequency(distance)
    }

    fn distance(&self, frequency: f64) -> f64 {
        self.as_function().distance(frequency)
    }
}

#[cfg(test)]
mod tests;
