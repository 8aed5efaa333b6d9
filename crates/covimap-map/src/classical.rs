//! The method of the CoviMap paper, to the letter: dense, for small logs and for comparison.
//!
//! 1. `f_ij = n_ij / (n_i + n_j - n_ij)`, eq. (4);
//! 2. squared distances `phi(f_ij)` within `[lo, hi]`, eqs. (9), (10); a pair never seen together
//!    has `f = 0` and so gets `hi`;
//! 3. triangle-inequality constraint, eq. (6): each distance becomes that of the shortest path;
//! 4. classical scaling.
//!
//! The one departure: components that no sighting connects are scaled each by itself, where the
//! paper would hold them `sqrt(hi)` apart.
//!
//! # Complexity
//! `O(N^3)` time and `O(N^2)` memory for N landmarks.
//!
//! # References
//! T. Yairi, K. Hori, K. Hirama, "Qualitative map learning based on co-visibility of
//! objects" (the CoviMap paper).

use covimap_embed::{ClassicalScaling, DistanceMatrix, PairDistances, classical_scaling, stress1};

use crate::component::{Basis, ComponentMap, put_in_frame};
use crate::{
    ClassicalParams, CoVisibility, LandmarkId, LinkGraph, MapError, Observer, Phi, SeamsReport, Stage,
};

/// Most landmarks of a component that the dense method accepts: 3000 take about 72 MB a table and
/// some ten seconds.
pub const CLASSICAL_LIMIT: usize = 3000;

impl ClassicalParams {
    /// Factor of the distance function: the one set, or the paper's.
    #[must_use]
    pub fn factor(&self) -> f64 {
        self.alpha.unwrap_or(match self.phi {
            Phi::Phi1 => 0.05,
            Phi::Phi2 => 0.3,
        })
    }

    /// Squared distance of two landmarks with co-visibility frequency `f` in `[0, 1]`.
    #[must_use]
    pub fn squared_distance(&self, f: f64) -> f64 {
        let distance = match self.phi {
            Phi::Phi1 => self.factor() * (1.0 / f - 1.0), // eq. (9)
            Phi::Phi2 => -self.factor() * f.ln(),         // eq. (10)
        };
        distance.clamp(self.lo, self.hi)
    }

    pub(crate) fn check(&self) -> Result<(), MapError> {
        let bad = |name, value, wanted| Err(MapError::BadParameter { name, value, wanted });
        if !(self.factor() > 0.0 && self.factor().is_finite()) {
            return bad("classical.alpha", self.factor(), "a positive number");
        }
        if !(self.lo >= 0.0 && self.lo.is_finite()) {
            return bad("classical.lo", self.lo, "a number that is not negative");
        }
        if !(self.hi >= self.lo && self.hi > 0.0 && self.hi.is_finite()) {
            return bad("classical.hi", self.hi, "a positive number not below classical.lo");
        }
        Ok(())
    }
}

/// Empirical squared distances among `members`, after the triangle-inequality constraint if it is on.
///
/// # Errors
/// None for checked parameters; the result of the distance table is passed on.
pub fn squared_distances(
    counts: &CoVisibility,
    members: &[u32],
    params: &ClassicalParams,
) -> Result<DistanceMatrix, MapError> {
    let squared = DistanceMatrix::from_fn(members.len(), |i, j| {
        params.squared_distance(counts.frequency(LandmarkId(members[i]), LandmarkId(members[j])))
    })?;
    if !params.tic {
        return Ok(squared);
    }
    let constrained = squared.map(f64::sqrt)?.metric_closure(); // eq. (6)
    Ok(constrained.map(|distance| distance * distance)?)
}

/// The paper's map of one component.
pub(crate) fn solve(
    counts: &CoVisibility,
    members: &[u32],
    params: &ClassicalParams,
) -> Result<ClassicalScaling, MapError> {
    if members.len() > CLASSICAL_LIMIT {
        return Err(MapError::TooLargeForClassical { landmarks: members.len(), limit: CLASSICAL_LIMIT });
    }
    Ok(classical_scaling(&squared_distances(counts, members, params)?)?)
}

/// The map of one component by the paper's method; it counts as one region.
pub(crate) fn map_component(
    counts: &CoVisibility,
    graph: &LinkGraph,
    members: &[u32],
    params: &ClassicalParams,
    observer: &dyn Observer,
) -> Result<ComponentMap, MapError> {
    observer.started(Stage::Classical, None);
    if observer.interrupted() {
        return Err(MapError::Interrupted);
    }
    let mut points = solve(counts, members, params)?.points;
    put_in_frame(&mut points, &mut []);
    observer.finished(Stage::Classical);
    let pairs = paper_pairs(counts, graph, members, params);
    Ok(ComponentMap {
        stress1: stress1(&pairs, &points),
        region: vec![0; members.len()],
        basis: Basis { polished: points.clone(), law: None, sensor: None },
        points,
        regions: 1,
        branch_of: vec![0],
        seams: SeamsReport::default(),
        path_pull: 0.0,
        network: false,
        iterations: 0,
        converged: true,
        distances: None,
        ranges: None,
    })
}

/// The co-seen pairs with the paper's distances, all of weight 1.
fn paper_pairs(
    counts: &CoVisibility,
    graph: &LinkGraph,
    members: &[u32],
    params: &ClassicalParams,
) -> PairDistances {
    graph.restricted_to(members).to_pairs_with(|i, j| {
        let f = counts.frequency(LandmarkId(members[i as usize]), LandmarkId(members[j as usize]));
        (params.squared_distance(f).sqrt(), 1.0)
    })
}

#[cfg(test)]
mod tests;
