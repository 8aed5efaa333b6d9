//! The product: where every landmark is.

use covimap_embed::Point;

use rustc_hash::FxHashSet;
use serde::{Deserialize, Serialize};

use crate::{BuildReport, LandmarkNames, MapError, MapperParams, Sensing, SightLines};

/// Where one landmark was placed, and on what evidence.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
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
    /// Branch of its component, 0 being the largest: how landmarks of two branches lie to each other is
    /// known but for the side, for either branch may be the mirror image of what the map shows.
    pub branch: u32,
    /// Whether its links leave it a choice of places: they lead to fewer than three landmarks, or to
    /// landmarks on a line, on whose other side it may be.
    pub loose: bool,
}

/// How a component was carried into a frame that is known from outside.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ChartFit {
    /// Component.
    pub component: u32,
    /// Known units, such as metres, that one map unit of the build came to; 1 if the scale is not known.
    pub scale: f64,
    /// Landmarks of known position that the fit used.
    pub anchors: u64,
    /// Known distances that the fit used.
    pub distances: u64,
    /// Root mean square of what the fit leaves of the positions or distances, in known units; 0 without any.
    pub rmse: f64,
    /// Whether the handedness is known, so that the component is no mirror image.
    pub handed: bool,
}

/// A finished map. Immutable; frames and units are those of `docs/conventions.md`.
#[derive(Debug, Clone, PartialEq)]
pub struct GlobalMap {
    pub(crate) names: LandmarkNames,
    pub(crate) landmarks: Vec<PlacedLandmark>,
    pub(crate) params: MapperParams,
    pub(crate) report: BuildReport,
    pub(crate) sight_lines: SightLines,
    pub(crate) alignment: Vec<ChartFit>,
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
        let (sight_lines, alignment) = (SightLines::default(), Vec::new());
        Ok(Self { names, landmarks, params, report, sight_lines, alignment, sensing: None })
    }

    /// The map with its lines of sight.
    ///
    /// # Errors
    /// [`MapError::InvalidMap`] when one joins two components, or counts more steps than show either end.
    pub fn with_sight_lines(mut self, sight_lines: SightLines) -> Result<Self, MapError> {
        sight_lines.check(&self.landmarks)?;
        self.sight_lines = sight_lines;
        Ok(self)
    }

    /// The map with other positions, in frames that `alignment` describes; one entry a component at most.
    /// Lengths of the sensor model take the new scales.
    ///
    /// # Errors
    /// [`MapError::InvalidMap`] when there is not one position a landmark; [`MapError::NotFinite`] for
    /// one that is nowhere.
    pub fn with_positions(mut self, positions: &[Point], alignment: Vec<ChartFit>) -> Result<Self, MapError> {
        if positions.len() != self.len() {
            let what = format!("{} positions for {} landmarks; give one each", positions.len(), self.len());
            return Err(MapError::InvalidMap { what });
        }
        if let Some(index) = positions.iter().position(|point| !point.iter().all(|v| v.is_finite())) {
            return Err(MapError::NotFinite { index, position: positions[index] });
        }
        for (placed, &position) in self.landmarks.iter_mut().zip(positions) {
            placed.position = position;
        }
        let scale = |fits: &[ChartFit], component| {
            fits.iter().find(|fit| fit.component == component).map_or(1.0, |fit| fit.scale)
        };
        let ratio = |component| scale(&alignment, component) / scale(&self.alignment, component);
        self.sensing = self.sensing.take().map(|sensing| sensing.scaled(&self.landmarks, ratio));
        self.alignment = alignment;
        Ok(self)
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

    /// Which neighbours were seen together. A map file of an older covimap holds none.
    #[must_use]
    pub fn sight_lines(&self) -> &SightLines {
        &self.sight_lines
    }

    /// The components that are in a frame known from outside; the others are in map units.
    #[must_use]
    pub fn alignment(&self) -> &[ChartFit] {
        &self.alignment
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SensorModel;

    #[test]
    fn parts_that_contradict_each_other_make_no_map() {
        let at = |position| PlacedLandmark { position, ..PlacedLandmark::default() };
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

    #[test]
    fn positions_are_replaced_all_or_none() {
        let at = |position| PlacedLandmark {
            position,
            component: 0,
            region: 0,
            sightings: 1,
            partners: 0,
            ..Default::default()
        };
        let map = || {
            let names = ["A", "B"].into_iter().collect();
            let landmarks = vec![at([0.0; 2]), at([1.0; 2])];
            GlobalMap::from_parts(names, landmarks, MapperParams::default(), BuildReport::default()).unwrap()
        };
        let sensor =
            |length| SensorModel { range: length, edge: 0.1 * length, detectability: 0.9, outliers: 0.01 };
        let sensing = |length| {
            let sensed = crate::Sensed { detectability: 0.9, deviation: 0.25 * length, warp: 0.125 * length };
            Sensing::from_parts(vec![sensor(length)], vec![sensed; 2], &[]).unwrap()
        };
        let fit = ChartFit { component: 0, scale: 2.0, anchors: 2, distances: 0, rmse: 0.0, handed: false };
        let moved = map().with_positions(&[[2.0; 2], [4.0; 2]], vec![fit.clone()]).unwrap();
        assert_eq!(moved.landmarks()[1], at([4.0; 2]));
        assert_eq!(moved.alignment(), std::slice::from_ref(&fit));
        // Lengths of the sensor go with the scale, from what it was to what it is.
        let sensed = map().with_sensing(sensing(0.5)).unwrap();
        let twice = sensed.with_positions(&[[0.0; 2]; 2], vec![fit.clone()]).unwrap();
        assert_eq!(twice.sensing(), Some(&sensing(1.0)));
        let six = twice.with_positions(&[[0.0; 2]; 2], vec![ChartFit { scale: 12.0, ..fit }]).unwrap();
        assert_eq!(six.sensing(), Some(&sensing(6.0)));
        let refusal =
            |positions: &[Point]| map().with_positions(positions, Vec::new()).unwrap_err().to_string();
        assert_eq!(refusal(&[[0.0; 2]]), "1 positions for 2 landmarks; give one each");
        assert!(refusal(&[[0.0; 2], [f64::NAN, 0.0]]).starts_with("point 1 is at (NaN, 0)"));
    }
}
