//! Every setting of a build, with its default and the reason for it.

use covimap_embed::{DistanceFamily, StopRule};
use serde::{Deserialize, Serialize};

use crate::MapError;

/// Which estimator makes the map.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// Regions, local maps, stitching and polish: the best the project has, at any size.
    #[default]
    Auto,
    /// The method of the CoviMap paper to the letter: dense, for small logs and comparison.
    Classical,
}

/// Distance function of the paper.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Phi {
    /// Eq. (9): `clamp(alpha1 (1/f - 1), lo, hi)`.
    Phi1,
    /// Eq. (10): `clamp(-alpha2 ln f, lo, hi)`.
    #[default]
    Phi2,
}

/// Settings of the paper's method; defaults are the paper's values.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct ClassicalParams {
    /// Distance function. Default `phi2`.
    pub phi: Phi,
    /// Factor of the distance function, `> 0`; `None`: 0.05 for `phi1`, 0.3 for `phi2`.
    pub alpha: Option<f64>,
    /// Smallest squared distance, `>= 0`. Default 0.1.
    pub lo: f64,
    /// Largest squared distance, that of a pair never seen together, `>= lo`. Default 2.
    pub hi: f64,
    /// Triangle-inequality constraint, eq. (6): shortest-path closure of the distances. Default on.
    pub tic: bool,
}

impl Default for ClassicalParams {
    fn default() -> Self {
        Self { phi: Phi::Phi2, alpha: None, lo: 0.1, hi: 2.0, tic: true }
    }
}

/// Sizes of the overlapping regions.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct RegionParams {
    /// Landmarks that a core should have, `>= 4`; cores may be somewhat larger. Default 12: small
    /// cores with wide halos fold less, and neighbouring regions share most of their landmarks.
    pub core: usize,
    /// Most landmarks of a region, halo included, at least twice `core`. A component of at most this
    /// many is one region. Default 150.
    pub members: usize,
    /// Links into the core that a landmark of the halo must have, `>= 1`. Default 3: fewer leave it
    /// a choice of two places.
    pub halo_links: usize,
}

impl Default for RegionParams {
    fn default() -> Self {
        Self { core: 12, members: 150, halo_links: 3 }
    }
}

/// When an iteration stops.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct StopParams {
    /// Most steps, `>= 1`.
    pub max_iterations: usize,
    /// Converged when a step lowers the stress by less than this share, `> 0`.
    pub tolerance: f64,
}

impl StopParams {
    pub(crate) fn rule(self) -> StopRule {
        StopRule { max_iterations: self.max_iterations, tolerance: self.tolerance }
    }
}

/// Which distance function turns frequencies into distances.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DistanceChoice {
    /// The family that foretells held-out counts best, fitted to the log.
    #[default]
    Auto,
    /// `sqrt(-0.3 ln f)`, the paper's logarithm, and no fit at all.
    FixedLog,
    /// This family, fitted to the log.
    #[serde(untagged)]
    Family(DistanceFamily),
}

impl DistanceChoice {
    /// The families to fit; none if nothing is to be learnt.
    pub(crate) fn families(self) -> Vec<DistanceFamily> {
        match self {
            Self::FixedLog => Vec::new(),
            Self::Auto => DistanceFamily::ALL.to_vec(),
            Self::Family(family) => vec![family],
        }
    }
}

/// Settings of `auto`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct AutoParams {
    /// Sizes of the regions.
    pub regions: RegionParams,
    /// When a local map is done. Default 100 steps or a gain of 1e-5: it is a start, not a result.
    pub local_stop: StopParams,
    /// When the polish is done. Default 40 steps or a gain of 1e-6.
    pub polish_stop: StopParams,
    /// Distance function. Default `auto`.
    pub distance: DistanceChoice,
    /// Whether an ID that is seen in several places becomes as many landmarks, `A#1`, `A#2` and so on. Default
    /// no: it is only told. A robot that comes to a place by two ways now and then looks like two places.
    pub split_aliases: bool,
    /// Most iterations of the refinement by the likelihood of the log. Default 4: more gain little,
    /// and the model of the sensor is never quite true; 0 leaves the configuration of least stress.
    pub refine_iterations: usize,
}

impl Default for AutoParams {
    fn default() -> Self {
        Self {
            regions: RegionParams::default(),
            local_stop: StopParams { max_iterations: 100, tolerance: 1e-5 },
            polish_stop: StopParams { max_iterations: 40, tolerance: 1e-6 },
            distance: DistanceChoice::Auto,
            split_aliases: false,
            refine_iterations: 4,
        }
    }
}

impl AutoParams {
    pub(crate) fn check(&self) -> Result<(), MapError> {
        let bad = |name, value: f64, wanted| Err(MapError::BadParameter { name, value, wanted });
        if self.regions.core < 4 {
            return bad("auto.regions.core", self.regions.core as f64, "at least 4");
        }
        if self.regions.members / 2 < self.regions.core {
            let wanted = "at least twice auto.regions.core";
            return bad("auto.regions.members", self.regions.members as f64, wanted);
        }
        if self.regions.halo_links == 0 {
            return bad("auto.regions.halo_links", 0.0, "at least 1");
        }
        for (name, stop) in [("auto.local_stop", self.local_stop), ("auto.polish_stop", self.polish_stop)] {
            if stop.max_iterations == 0 {
                return bad(name, 0.0, "at least 1 step");
            }
            if !(stop.tolerance > 0.0 && stop.tolerance.is_finite()) {
                return bad(name, stop.tolerance, "a positive tolerance");
            }
        }
        Ok(())
    }
}

/// All settings of a build.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct MapperParams {
    /// Estimator. Default `auto`.
    pub method: Method,
    /// Seed of every random choice. Default 0.
    pub seed: u64,
    /// Settings of `auto`; `classical` does not read them.
    pub auto: AutoParams,
    /// Settings of `classical`; `auto` does not read them.
    pub classical: ClassicalParams,
}

#[cfg(test)]
mod tests;
