//! The similarity that best carries one set of points onto another.
//!
//! For pairs of points `(s_k, t_k)` with weights `w_k`, find the similarity `T` that minimises
//!
//! `sum_k w_k |t_k - T s_k|^2`.  (1)
//!
//! # Algorithm
//! With the plane as complex numbers, `z_k` and `v_k` the source and target less their weighted
//! means, and `z_k` conjugated for a mirrored fit, the minimum has a closed form:
//!
//! `S = sum_k w_k v_k conj(z_k)`, `P = sum_k w_k |z_k|^2`, `T: z -> (S / P) z`  (2)
//!
//! with a free scale, and `S / |S|` in place of `S / P` with the scale held at 1. Both
//! handednesses are always fitted, so that a caller sees by how much the chosen one is better.
//!
//! The condition of a set follows from `Q = sum_k w_k z_k^2`: the singular values of the centred
//! set are `sqrt((P +- |Q|) / 2)`, their ratio `sqrt((P - |Q|) / (P + |Q|))`.  (3)
//!
//! # Complexity
//! `O(n)`; the robust fit some hundred times that.
//!
//! # References
//! J. C. Gower, G. B. Dijksterhuis, "Procrustes Problems", Oxford University Press 2004.
//! S. Umeyama, "Least-squares estimation of transformation parameters between two point
//! patterns", IEEE PAMI 13(4), 1991.

use nalgebra::Complex;

use crate::{EmbedError, Point, Similarity};

mod robust;

pub use robust::{RobustFit, robust_procrustes};

/// Largest absolute coordinate; products of sums stay finite below it.
const LARGEST: f64 = 1e100;
/// A set whose spread is below this share of its largest coordinate has coinciding points.
const COINCIDE: f64 = 1e-14;
/// A set whose ratio (3) is below this lies on a line, as far as rounding can tell.
const COLLINEAR: f64 = 1e-7;
/// `|S|` below this share of the two spreads fixes no rotation.
const NO_ROTATION: f64 = 1e-12;

/// The same object in two frames.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Correspondence {
    /// Where it is in the source frame.
    pub source: Point,
    /// Where it is in the target frame.
    pub target: Point,
    /// Weight of the pair in the fit, `> 0`; best the inverse variance of `source - target`.
    pub weight: f64,
}

/// Which handedness a fit may have.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Reflection {
    /// The better of the two.
    #[default]
    Allow,
    /// A rotation only.
    Forbid,
    /// A mirrored rotation only.
    Require,
}

/// What a fit may do.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ProcrustesOptions {
    /// Whether the scale is fitted (default) or held at 1.
    pub scale: bool,
    /// Which handedness the fit may have (default: the better one).
    pub reflection: Reflection,
}

impl Default for ProcrustesOptions {
    fn default() -> Self {
        Self { scale: true, reflection: Reflection::Allow }
    }
}

/// A fitted similarity and how well the points determine it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProcrustesFit {
    /// The fit: `target_from_source.apply(source)` is near `target`.
    pub target_from_source: Similarity,
    /// Weighted root mean square of `|t_k - T s_k|`, in units of the target.
    pub rmse: f64,
    /// The same for the best fit of the other handedness. A value near `rmse` says that the
    /// points do not tell whether the source is mirrored.
    pub rmse_other: f64,
    /// Smaller over larger singular value of the centred source points, in `[0, 1]`: 0 on a line,
    /// 1 on a round set.
    pub condition: f64,
    /// Whether both sets leave the line, so that the handedness can be told at all. If not, a fit
    /// that may choose does not mirror.
    pub handedness_determined: bool,
}

/// Fits a similarity by weighted least squares, eq. (1).
///
/// # Errors
/// - [`EmbedError::BadCorrespondence`] for a coordinate that is not finite or above 1e100, or a
///   weight that is not finite and positive.
/// - [`EmbedError::CoincidingPoints`] if the source or, with a free scale, the target has fewer
///   than two distinct points.
/// - [`EmbedError::UndeterminedRotation`] if no rotation fits better than any other, as between a
///   round set and its mirror image when reflection is forbidden.
///
/// # Examples
/// ```
/// use covimap_embed::{Correspondence, ProcrustesOptions, procrustes};
///
/// // A quarter turn, twice the size, shifted by (1, 0).
/// let pair = |source, target| Correspondence { source, target, weight: 1.0 };
/// let pairs = [
///     pair([0.0, 0.0], [1.0, 0.0]),
///     pair([1.0, 0.0], [1.0, 2.0]),
///     pair([0.0, 3.0], [-5.0, 0.0]),
/// ];
/// let fit = procrustes(&pairs, ProcrustesOptions::default())?;
/// assert!((fit.target_from_source.scale - 2.0).abs() < 1e-12);
/// assert!((fit.target_from_source.sin - 1.0).abs() < 1e-12);
/// assert!(fit.rmse < 1e-12 && fit.rmse_other > 1.0);
/// # Ok::<(), covimap_embed::EmbedError>(())
/// ```
pub fn procrustes(pairs: &[Correspondence], options: ProcrustesOptions) -> Result<ProcrustesFit, EmbedError> {
    check(pairs)?;
    fit(pairs, options)
}

fn check(pairs: &[Correspondence]) -> Result<(), EmbedError> {
    for (index, pair) in pairs.iter().enumerate() {
        let bad = |what| Err(EmbedError::BadCorrespondence { index, what });
        if !pair.source.iter().chain(&pair.target).all(|x| x.abs() <= LARGEST) {
            return bad("coordinates must be finite and at most 1e100");
        }
        if !(pair.weight > 0.0 && pair.weight <= LARGEST) {
            return bad("the weight must be positive and at most 1e100; leave the pair out instead");
        }
    }
    Ok(())
}

/// The fit of checked pairs.
fn fit(pairs: &[Correspondence], options: ProcrustesOptions) -> Result<ProcrustesFit, EmbedError> {
    let source = Centred::new(pairs, |pair| pair.source);
    let target = Centred::new(pairs, |pair| pair.target);
    if source.coincide() || options.scale && target.coincide() {
        return Err(EmbedError::CoincidingPoints { pairs: pairs.len() });
    }
    let turned = Turn::new(pairs, &source, &target, options.scale, false);
    let mirrored = Turn::new(pairs, &source, &target, options.scale, true);
    let handedness_determined = source.ratio() > COLLINEAR && target.ratio() > COLLINEAR;
    let mirror = match options.reflection {
        Reflection::Allow => handedness_determined && mirrored.rmse < turned.rmse,
        Reflection::Forbid => false,
        Reflection::Require => true,
    };
    let (chosen, other) = if mirror { (mirrored, turned) } else { (turned, mirrored) };
    if !chosen.determined {
        return Err(EmbedError::UndeterminedRotation { pairs: pairs.len() });
    }
    Ok(ProcrustesFit {
        target_from_source: chosen.similarity(&source, &target),
        rmse: chosen.rmse,
        rmse_other: other.rmse,
        condition: source.ratio(),
        handedness_determined,
    })
}

/// A weighted set of points less its mean, as complex numbers.
struct Centred {
    mean: Complex<f64>,
    points: Vec<Complex<f64>>,
    /// Largest absolute coordinate before centring.
    largest: f64,
    /// Sum of weights.
    weight: f64,
    /// `P` of eq. (2).
    spread: f64,
    /// `|Q|` of eq. (3).
    stretch: f64,
}

impl Centred {
    fn new(pairs: &[Correspondence], of: impl Fn(&Correspondence) -> Point) -> Self {
        let weight: f64 = pairs.iter().map(|pair| pair.weight).sum();
        let complex = |pair| Complex::new(of(pair)[0], of(pair)[1]);
        let mean = pairs.iter().map(|pair| complex(pair) * (pair.weight / weight)).sum();
        let points: Vec<_> = pairs.iter().map(|pair| complex(pair) - mean).collect();
        let weighted = || points.iter().zip(pairs);
        Self {
            mean,
            largest: pairs.iter().flat_map(of).fold(0.0, |most, x| most.max(x.abs())),
            weight,
            spread: weighted().map(|(z, pair)| pair.weight * z.norm_sqr()).sum(),
            stretch: weighted().map(|(z, pair)| z * z * pair.weight).sum::<Complex<f64>>().norm(),
            points,
        }
    }

    /// Whether the points are one point, up to rounding (or none).
    fn coincide(&self) -> bool {
        self.spread <= (COINCIDE * self.largest).powi(2) * self.weight
    }

    /// Eq. (3).
    fn ratio(&self) -> f64 {
        ((self.spread - self.stretch).max(0.0) / (self.spread + self.stretch)).sqrt()
    }
}

/// The fit of one handedness.
struct Turn {
    mirrored: bool,
    /// Rotation and scale: `v = factor z`, or `factor conj(z)`.
    factor: Complex<f64>,
    determined: bool,
    rmse: f64,
}

impl Turn {
    /// Eq. (2).
    fn new(
        pairs: &[Correspondence],
        source: &Centred,
        target: &Centred,
        scale: bool,
        mirrored: bool,
    ) -> Self {
        let oriented = |z: &Complex<f64>| if mirrored { z.conj() } else { *z };
        let matched = || source.points.iter().map(oriented).zip(&target.points).zip(pairs);
        let product: Complex<f64> = matched().map(|((z, v), pair)| v * z.conj() * pair.weight).sum();
        let determined = product.norm() > NO_ROTATION * (source.spread * target.spread).sqrt();
        let factor = match (scale, determined) {
            (true, _) => product / source.spread,
            (false, true) => product / product.norm(),
            (false, false) => Complex::ONE,
        };
        let squares: f64 = matched().map(|((z, v), pair)| pair.weight * (v - factor * z).norm_sqr()).sum();
        Self { mirrored, factor, determined, rmse: (squares / source.weight).sqrt() }
    }

    fn similarity(&self, source: &Centred, target: &Centred) -> Similarity {
        let scale = self.factor.norm();
        let mean = if self.mirrored { source.mean.conj() } else { source.mean };
        let shift = target.mean - self.factor * mean;
        Similarity {
            cos: self.factor.re / scale,
            sin: self.factor.im / scale,
            mirrored: self.mirrored,
            scale,
            shift: [shift.re, shift.im],
        }
    }
}

#[cfg(test)]
mod tests;
