//! The curve of a family that makes the counts most likely.

use super::observation::Observation;
use super::scoring::{Logistic, maximise};
use super::{DistanceCurve, DistanceFamily, InverseSquare, Lens, StretchedExponential, Tabulated};
use crate::{EmbedError, MonotoneSplineBasis, isotonic_regression};

/// Most bins of the families with parameters.
const BINS: usize = 256;
/// Most bins of the families without, and observations that a bin has at the least.
const COARSE_BINS: (usize, usize) = (64, 4);
/// Degree and interior knots of the spline, and distances at which it is read off.
const SPLINE: (usize, usize, usize) = (2, 5, 64);

impl DistanceFamily {
    /// The curve of the family that makes the counts most likely, eq. (2).
    ///
    /// # Errors
    /// [`EmbedError::BadObservation`] for a distance or counts out of their range;
    /// [`EmbedError::NoRange`] if the distances are all the same, or all counts are, so that nothing
    /// tells how frequencies fall.
    ///
    /// # Examples
    /// ```
    /// use covimap_embed::{DistanceFamily, DistanceFunction, Observation};
    ///
    /// // A thousand looks at each of five pairs; f = 0.8 exp(-d^2).
    /// let pairs = [(0.2, 769.0), (0.5, 623.0), (0.8, 422.0), (1.0, 294.0), (1.5, 84.0)];
    /// let observations =
    ///     pairs.map(|(distance, together)| Observation { distance, together, either: 1000.0 });
    /// let curve = DistanceFamily::Log.fit(&observations)?;
    /// assert!((curve.distance(0.8 * (-0.49_f64).exp()) - 0.7).abs() < 0.01);
    /// # Ok::<(), covimap_embed::EmbedError>(())
    /// ```
    pub fn fit(self, observations: &[Observation]) -> Result<DistanceCurve, EmbedError> {
        for (index, observation) in observations.iter().enumerate() {
            observation.check().map_err(|what| EmbedError::BadObservation { index, what })?;
        }
        let no_range = EmbedError::NoRange { values: observations.len() };
        let same = |a: &Observation, b: &Observation| a.distance == b.distance;
        if observations.windows(2).all(|pair| same(&pair[0], &pair[1])) {
            return Err(no_range);
        }
        let bins = bins(observations, BINS, 1);
        match self {
            Self::Log => Ok(DistanceCurve::Log(maximise(&bins, |[length, nearest]| StretchedExponential {
                nearest: nearest.logistic(),
                length: length.exp(),
                exponent: 2.0,
            }))),
            Self::Inverse => {
                let curve = |[length, nearest]: [f64; 2]| InverseSquare {
                    nearest: nearest.logistic(),
                    length: length.exp(),
                };
                Ok(DistanceCurve::Inverse(maximise(&bins, curve)))
            }
            Self::Lens => {
                let curve = |[range, detectability]: [f64; 2]| Lens {
                    range: range.exp(),
                    detectability: detectability.logistic(),
                };
                Ok(DistanceCurve::Lens(maximise(&bins, curve)))
            }
            Self::Power => {
                let curve = |[length, nearest, exponent]: [f64; 3]| StretchedExponential {
                    nearest: nearest.logistic(),
                    length: length.exp(),
                    exponent: exponent.exp(),
                };
                Ok(DistanceCurve::Power(maximise(&bins, curve)))
            }
            Self::Spline => Ok(DistanceCurve::Spline(spline(&coarse(observations))?.ok_or(no_range)?)),
            Self::Isotonic => Ok(DistanceCurve::Isotonic(isotonic(&coarse(observations))?.ok_or(no_range)?)),
        }
    }
}

fn coarse(observations: &[Observation]) -> Vec<Observation> {
    bins(observations, COARSE_BINS.0, COARSE_BINS.1)
}

/// Observations of about the same distance put together: at most so many bins with about as many
/// observations each, at least so many.
fn bins(observations: &[Observation], most: usize, least: usize) -> Vec<Observation> {
    let mut sorted: Vec<&Observation> = observations.iter().collect();
    sorted.sort_by(|a, b| a.distance.total_cmp(&b.distance));
    let count = (sorted.len() / least).clamp(1, most);
    let bin = |k: usize| {
        let members = &sorted[k * sorted.len() / count..(k + 1) * sorted.len() / count];
        let sum = |of: fn(&Observation) -> f64| members.iter().map(|member| of(member)).sum::<f64>();
        let either = sum(|member| member.either);
        Observation {
            distance: sum(|member| member.either * member.distance) / either,
            together: sum(|member| member.together),
            either,
        }
    };
    (0..count).map(bin).collect()
}

/// The frequency of a bin, shrunken by half a look so that it is neither 0 nor 1.
fn frequency(bin: &Observation) -> f64 {
    (bin.together + 0.5) / (bin.either + 1.0)
}

fn isotonic(bins: &[Observation]) -> Result<Option<Tabulated>, EmbedError> {
    let falling: Vec<f64> = bins.iter().map(|bin| -frequency(bin)).collect();
    let weights: Vec<f64> = bins.iter().map(|bin| bin.either).collect();
    let pooled = isotonic_regression(&falling, &weights)?;
    let points: Vec<_> = bins.iter().zip(pooled).map(|(bin, f)| (bin.distance, -(-f).ln())).collect();
    Ok(Tabulated::through(&points))
}

fn spline(bins: &[Observation]) -> Result<Option<Tabulated>, EmbedError> {
    let (degree, knots, readings) = SPLINE;
    let distances: Vec<f64> = bins.iter().map(|bin| bin.distance).collect();
    let minus_log: Vec<f64> = bins.iter().map(|bin| -frequency(bin).ln()).collect();
    let weight = |bin: &Observation| bin.either * frequency(bin) / (1.0 - frequency(bin));
    let weights: Vec<f64> = bins.iter().map(weight).collect();
    let curve = MonotoneSplineBasis::at_quantiles(&distances, knots, degree)?
        .fit(&distances, &minus_log, &weights)?;
    let (first, last) = (distances[0], distances[distances.len() - 1]);
    let place = |k: usize| first + (last - first) * k as f64 / (readings - 1) as f64;
    let points: Vec<_> = (0..readings).map(|k| (place(k), curve.value(place(k)))).collect();
    Ok(Tabulated::through(&points))
}
