//! The product: where every landmark is.

use covimap_embed::Point;

use crate::{BuildReport, LandmarkNames, MapperParams};

/// Where one landmark was placed, and on what evidence.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlacedLandmark {
    /// Position in map units, in the frame of its component.
    pub position: Point,
    /// Component: 0 is the largest.
    pub component: u32,
    /// Region of which the landmark is a core member.
    pub region: u32,
    /// Steps that show it, `n_i`.
    pub sightings: u32,
    /// Number of other landmarks it was seen together with.
    pub partners: u32,
}

/// A finished map. Immutable; frames and units are those of `docs/conventions.md`.
#[derive(Debug, Clone, PartialEq)]
pub struct GlobalMap {
    pub(crate) names: LandmarkNames,
    pub(crate) landmarks: Vec<PlacedLandmark>,
    pub(crate) params: MapperParams,
    pub(crate) report: BuildReport,
}

impl GlobalMap {
    /// Number of landmarks.
    #[must_use]
    pub fn len(&self) -> usize {
        self.landmarks.len()
    }

    /// Whether the map has no landmark.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.landmarks.is_empty()
    }

    /// String IDs, in the order of [`crate::LandmarkId`].
    #[must_use]
    pub fn names(&self) -> &LandmarkNames {
        &self.names
    }

    /// Placed landmarks, in the order of [`crate::LandmarkId`].
    #[must_use]
    pub fn landmarks(&self) -> &[PlacedLandmark] {
        &self.landmarks
    }

    /// The settings that made it.
    #[must_use]
    pub fn params(&self) -> &MapperParams {
        &self.params
    }

    /// What the build says about it.
    #[must_use]
    pub fn report(&self) -> &BuildReport {
        &self.report
    }
}
