//! Multidimensional scaling in the plane: distances in, coordinates out.
//!
//! The crate knows no landmark, log or robot. Distances come either complete
//! ([`DistanceMatrix`]) or as a weighted list of known pairs ([`PairDistances`]): a pair that
//! is not listed is *unknown*, which is not the same as far away.

mod anchored;
mod cholesky;
mod classical;
mod closure;
mod descent;
mod disparity;
mod distance_function;
mod distance_rows;
mod distances;
mod eigen;
mod error;
mod fastmap;
mod flexibility;
mod forces;
mod isotonic;
mod laplacian;
mod lift;
mod limited_memory;
mod majorise;
mod newton;
mod nnls;
mod pairs;
mod pivot;
mod procrustes;
mod relocate;
mod shepard;
mod similarity;
mod smacof;
mod solve;
mod spline;
mod spring;
mod starts;
mod stress;
mod synchronise;
mod unfold;
mod wide;

pub use anchored::anchored_while;
pub use cholesky::{LowerTriangle, SparseCholesky};
pub use classical::{ClassicalScaling, classical_scaling};
pub use disparity::{PairBounds, Transformation};
pub use distance_function::{
    DistanceCurve, DistanceFamily, DistanceFunction, InverseSquare, Lens, Observation, StretchedExponential,
    Tabulated,
};
pub use distance_rows::{DistanceRows, ShortestPaths};
pub use distances::DistanceMatrix;
pub use error::EmbedError;
pub use fastmap::fastmap;
pub use flexibility::{DistanceErrors, flexibility, flexibility_steps};
pub use isotonic::{DissimilarityOrder, Ties, isotonic_regression};
pub use lift::{Apart, Bound, LIFT_STEPS, lift};
pub use newton::{Newton, newton};
pub use pairs::{Pair, PairDistances};
pub use pivot::{PivotDistances, landmark_scaling, pivot_scaling};
pub use procrustes::{
    Correspondence, ProcrustesFit, ProcrustesOptions, Reflection, RobustFit, procrustes, robust_procrustes,
};
pub use shepard::ShepardPoint;
pub use similarity::Similarity;
pub use smacof::{ComparedStarts, Scaling, Smacof, Steps, smacof};
pub use solve::{Embedding, StopRule, Termination};
pub use spline::{MonotoneSpline, MonotoneSplineBasis};
pub use spring::spring_embedding;
pub use starts::{random_starts, torgerson_start};
pub use stress::{raw_stress, stress1};
pub use synchronise::{
    EdgeReport, Estimate, RelativeFrame, SynchroniseOptions, Synchronised, handedness, synchronise,
};
pub use unfold::{Unfolded, unfold};
pub use wide::wide;

/// A position in the plane, `[x, y]`.
pub type Point = [f64; 2];
