//! Procrustes fits that outliers do not pull.

use rand::SeedableRng;
use rand::seq::index;
use rand_chacha::ChaCha8Rng;

use super::{Correspondence, ProcrustesFit, ProcrustesOptions, check, fit};
use crate::EmbedError;

/// Pairs of one random sample.
const SAMPLE: usize = 3;
/// Random samples: with half of the pairs wrong, all of them miss once in a million.
const SAMPLES: usize = 100;
/// Most reweighted fits from one start.
const MAX_REFITS: usize = 50;
/// The fit is done when no trust changes by more than this.
const SETTLED: f64 = 1e-9;
/// `sigma` is at least this share of the extent of the target, so that it is not zero where more
/// than half of the pairs fit exactly.
const FLOOR: f64 = 1e-10;

/// A fit in which pairs that do not agree with the others count less.
#[derive(Debug, Clone, PartialEq)]
pub struct RobustFit {
    /// The fit, with each weight multiplied by its trust; its errors are weighted in that way too.
    pub fit: ProcrustesFit,
    /// What is left of the weight of each pair, in `(0, 1]`: `(sigma^2 / (sigma^2 + r^2))^2`.
    pub trust: Vec<f64>,
    /// Scale of the residuals `r = |t - T s|` of good pairs: 1.48 times their median.
    pub sigma: f64,
}

/// Fits a similarity when up to nearly half of the pairs may be wrong.
///
/// # Algorithm
/// Iteratively reweighted least squares with Geman and McClure's weights
/// `w (sigma^2 / (sigma^2 + r^2))^2`, `sigma = 1.48 median r`, from two starts: the plain fit, and
/// the best of 100 fits to three random pairs (smallest median residual, fixed seed). The end with
/// the smaller `sigma` is returned. With three pairs or fewer there is nothing to tell an outlier
/// by: the plain fit is returned with trust 1.
///
/// # Errors
/// As [`procrustes`](crate::procrustes).
///
/// # References
/// S. Geman, D. E. McClure, "Statistical methods for tomographic image reconstruction", Bull. ISI
/// 52, 1987. P. J. Rousseeuw, "Least median of squares regression", J. Am. Stat. Assoc. 79, 1984.
pub fn robust_procrustes(
    pairs: &[Correspondence],
    options: ProcrustesOptions,
) -> Result<RobustFit, EmbedError> {
    check(pairs)?;
    let plain = fit(pairs, options)?;
    if pairs.len() <= SAMPLE {
        let trust = vec![1.0; pairs.len()];
        return Ok(RobustFit { fit: plain, trust, sigma: sigma_of(&residuals(pairs, &plain), pairs) });
    }
    let from_plain = reweighted(pairs, options, plain);
    let Some(sampled) = best_sample(pairs, options) else { return Ok(from_plain) };
    let from_sample = reweighted(pairs, options, sampled);
    Ok(if from_sample.sigma < from_plain.sigma { from_sample } else { from_plain })
}

/// The fit to three random pairs that leaves the smallest median residual; `None` if all samples
/// were degenerate.
fn best_sample(pairs: &[Correspondence], options: ProcrustesOptions) -> Option<ProcrustesFit> {
    let mut rng = ChaCha8Rng::seed_from_u64(0);
    let fits = (0..SAMPLES).filter_map(|_| {
        let sample: Vec<_> = index::sample(&mut rng, pairs.len(), SAMPLE).iter().map(|k| pairs[k]).collect();
        let fit = fit(&sample, options).ok()?;
        Some((median(residuals(pairs, &fit)), fit))
    });
    fits.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, fit)| fit)
}

/// Fits again and again, with weights from the residuals of the fit before.
fn reweighted(pairs: &[Correspondence], options: ProcrustesOptions, start: ProcrustesFit) -> RobustFit {
    let mut end = RobustFit { fit: start, trust: vec![0.0; pairs.len()], sigma: 0.0 };
    for _ in 0..MAX_REFITS {
        let residuals = residuals(pairs, &end.fit);
        end.sigma = sigma_of(&residuals, pairs);
        let square = end.sigma * end.sigma;
        let trust: Vec<f64> = residuals.iter().map(|r| (square / (square + r * r)).powi(2)).collect();
        let change = trust.iter().zip(&end.trust).fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
        let weighted = pairs.iter().zip(&trust);
        let weighted: Vec<_> = weighted.map(|(&p, t)| Correspondence { weight: p.weight * t, ..p }).collect();
        end.trust = trust;
        // The trusted pairs may coincide where the outliers do not: the last fit stands then.
        let Ok(next) = fit(&weighted, options) else { break };
        end.fit = next;
        if change <= SETTLED {
            break;
        }
    }
    end
}

fn residuals(pairs: &[Correspondence], fit: &ProcrustesFit) -> Vec<f64> {
    let residual = |pair: &Correspondence| {
        let [x, y] = fit.target_from_source.apply(pair.source);
        (pair.target[0] - x).hypot(pair.target[1] - y)
    };
    pairs.iter().map(residual).collect()
}

fn sigma_of(residuals: &[f64], pairs: &[Correspondence]) -> f64 {
    let extent = |axis: usize| {
        let on_axis = || pairs.iter().map(|pair| pair.target[axis]);
        on_axis().fold(f64::MIN, f64::max) - on_axis().fold(f64::MAX, f64::min)
    };
    (1.48 * median(residuals.to_vec())).max(FLOOR * extent(0).max(extent(1)))
}

/// The upper median of at least one number.
fn median(mut values: Vec<f64>) -> f64 {
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}
