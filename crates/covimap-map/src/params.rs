//! Every setting of a build, with its default and the reason for it.

use serde::{Deserialize, Serialize};

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

/// All settings of a build.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[non_exhaustive]
pub struct MapperParams {
    /// Estimator. Default `auto`.
    pub method: Method,
    /// Seed of every random choice. Default 0.
    pub seed: u64,
    /// Settings of `classical`; `auto` does not read them.
    pub classical: ClassicalParams,
}
