//! Laying a piece of a map onto landmarks that have a place.

use covimap_embed::{
    Correspondence, Point, ProcrustesFit, ProcrustesOptions, Reflection, Similarity, robust_procrustes,
};

use crate::stitch::LEAST_MISFIT;

/// A similarity without scale, and how sure its handedness is.
pub(super) struct Fit {
    pub similarity: Similarity,
    pub shared: usize,
    pub residual: f64,
    pub condition: f64,
    /// Logarithm of how much likelier this handedness is than the other, as of seams.
    pub evidence: f64,
}

impl Fit {
    /// To at least one pair; where pairs leave the turn open, nothing is turned.
    pub fn of(pairs: &[Correspondence]) -> Self {
        let options = ProcrustesOptions { scale: false, reflection: Reflection::Allow };
        let shared = pairs.len();
        match robust_procrustes(pairs, options) {
            Ok(robust) => {
                let ProcrustesFit { target_from_source, rmse, rmse_other, condition, .. } = robust.fit;
                let variance = rmse * rmse + LEAST_MISFIT * LEAST_MISFIT;
                let evidence = shared as f64 * (rmse_other * rmse_other - rmse * rmse) / (2.0 * variance);
                Self { similarity: target_from_source, shared, residual: rmse, condition, evidence }
            }
            Err(_) => {
                let mean = |of: fn(&Correspondence) -> Point| {
                    [0, 1].map(|axis| pairs.iter().map(|pair| of(pair)[axis]).sum::<f64>() / shared as f64)
                };
                let (from, to) = (mean(|pair| pair.source), mean(|pair| pair.target));
                let shift = [to[0] - from[0], to[1] - from[1]];
                let similarity = Similarity { shift, ..Similarity::IDENTITY };
                Self { similarity, shared, residual: 0.0, condition: 0.0, evidence: 0.0 }
            }
        }
    }
}
