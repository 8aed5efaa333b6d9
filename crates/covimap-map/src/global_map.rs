//! The product: where every landmark is.

use covimap_embed::Point;

use rustc_hash::FxHashSet;

use crate::{BuildReport, LandmarkNames, MapError, MapperParams, Sensing};

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
    pub(crate) sensing: Option<Sensing>,
}

impl GlobalMap {
    /// Puts a map together from its parts, `landmarks[i]` being the landmark `names[i]`.
    ///
    /// # Errors
    /// [`MapError::InvalidMap`] when the two differ in length, a position is not finite, or an ID stands
    /// there twice.
    pub fn from_parts(
        names: LandmarkNames,
        landmarks: Vec<PlacedLandmark>,
        params: MapperParams,
        report: BuildReport,
    ) -> Result<Self, MapError> {
        let invalid = |what| Err(MapError::InvalidMap { what });
        if names.len() != landmarks.len() {
            return invalid(format!("{} IDs for {} landmarks; give one each", names.len(), landmarks.len()));
        }
        let mut known = FxHashSet::with_capacity_and_hasher(names.len(), rustc_hash::FxBuildHasher);
        for (index, (id, placed)) in names.iter().zip(&landmarks).enumerate() {
            let [x, y] = placed.position;
            if !(x.is_finite() && y.is_finite()) {
                return invalid(format!(
                    "landmark {index} {id:?} is at ({x}, {y}), positions must be finite"
                ));
            }
            if !known.insert(id) {
                return invalid(format!(
                    "landmark {index} has the ID {id:?} of another one; build the map again"
                ));
            }
        }
        Ok(Self { names, landmarks, params, report, sensing: None })
    }

    /// The map with what it knows of its sensor.
    ///
    /// # Errors
    /// [`MapError::InvalidMap`] when that is of other landmarks or components than the map's.
    pub fn with_sensing(mut self, sensing: Sensing) -> Result<Self, MapError> {
        let components = self.landmarks.iter().map(|placed| placed.component as usize + 1).max().unwrap_or(0);
        let (landmarks, sensors) = (sensing.landmarks(), sensing.sensors().len());
        if landmarks != self.len() || sensors < components {
            return Err(MapError::InvalidMap {
                what: format!(
                    "{landmarks} landmarks and {sensors} components have a sensor model, the map has {} and \
                     {components}; build the map again",
                    self.len()
                ),
            });
        }
        self.sensing = Some(sensing);
        Ok(self)
    }

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

    /// What the map knows of its sensor; `None` if no component has three landmarks, or the file was
    /// written without.
    #[must_use]
    pub fn sensing(&self) -> Option<&Sensing> {
        self.sensing.as_ref()
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_that_contradict_each_other_make_no_map() {
        let at = |position| PlacedLandmark { position, component: 0, region: 0, sightings: 1, partners: 0 };
        let refusal = |ids: &[&str], positions: &[Point]| {
            let names = ids.iter().copied().collect();
            let landmarks = positions.iter().copied().map(at).collect();
            GlobalMap::from_parts(names, landmarks, MapperParams::default(), BuildReport::default())
                .unwrap_err()
                .to_string()
        };
        assert_eq!(refusal(&["A"], &[]), "1 IDs for 0 landmarks; give one each");
        assert_eq!(
            refusal(&["A"], &[[f64::NAN, 1.0]]),
            "landmark 0 \"A\" is at (NaN, 1), positions must be finite"
        );
        assert_eq!(
            refusal(&["A", "A"], &[[0.0; 2]; 2]),
            "landmark 1 has the ID \"A\" of another one; build the map again"
        );
    }
}
