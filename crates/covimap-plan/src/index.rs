//! A map whose landmarks are found by ID or number.

use std::sync::Arc;

use covimap_map::{GlobalMap, LandmarkId, PlacedLandmark};

use crate::PlanError;
use crate::names::{NameTable, most_similar};

/// A map made ready for questions. Immutable: threads share one behind an [`Arc`].
///
/// Takes `O(n log n)` time and `O(n)` memory to make for `n` landmarks.
#[derive(Debug, Clone)]
pub struct MapIndex {
    map: Arc<GlobalMap>,
    table: NameTable,
}

impl MapIndex {
    /// Makes a map ready.
    #[must_use]
    pub fn new(map: Arc<GlobalMap>) -> Self {
        let table = NameTable::new(map.names());
        Self { map, table }
    }

    /// The map behind the index.
    #[must_use]
    pub fn map(&self) -> &Arc<GlobalMap> {
        &self.map
    }

    /// The number of a landmark, which is given by its ID or by its number.
    ///
    /// # Errors
    /// [`PlanError::UnknownLandmark`], [`PlanError::UnknownNumber`].
    pub fn id(&self, landmark: impl LandmarkRef) -> Result<LandmarkId, PlanError> {
        landmark.find_in(self)
    }

    /// What the map says of a landmark: position, component, region, evidence.
    ///
    /// # Errors
    /// Those of [`MapIndex::id`].
    pub fn landmark(&self, landmark: impl LandmarkRef) -> Result<&PlacedLandmark, PlanError> {
        Ok(&self.map.landmarks()[self.id(landmark)?.index()])
    }

    /// The number of a landmark, if the map has that ID.
    pub(crate) fn lookup(&self, id: &str) -> Option<LandmarkId> {
        self.table.find(self.map.names(), id)
    }

    /// The string ID of a landmark of this map.
    #[must_use]
    pub fn name(&self, id: LandmarkId) -> &str {
        self.map.names().name(id)
    }
}

/// What names a landmark: its string ID, or its number.
pub trait LandmarkRef {
    /// The number that the landmark has in this map.
    ///
    /// # Errors
    /// [`PlanError::UnknownLandmark`] for an ID that the map does not have, with the most similar one;
    /// [`PlanError::UnknownNumber`] for a number past the last.
    fn find_in(&self, index: &MapIndex) -> Result<LandmarkId, PlanError>;
}

impl LandmarkRef for LandmarkId {
    fn find_in(&self, index: &MapIndex) -> Result<LandmarkId, PlanError> {
        let landmarks = index.map.len();
        if self.index() < landmarks {
            Ok(*self)
        } else {
            Err(PlanError::UnknownNumber { number: self.0, landmarks })
        }
    }
}

impl LandmarkRef for str {
    fn find_in(&self, index: &MapIndex) -> Result<LandmarkId, PlanError> {
        let names = index.map.names();
        index.table.find(names, self).ok_or_else(|| PlanError::UnknownLandmark {
            id: self.to_owned(),
            nearest: most_similar(names, self).map(str::to_owned),
        })
    }
}

impl LandmarkRef for String {
    fn find_in(&self, index: &MapIndex) -> Result<LandmarkId, PlanError> {
        self.as_str().find_in(index)
    }
}

impl<T: LandmarkRef + ?Sized> LandmarkRef for &T {
    fn find_in(&self, index: &MapIndex) -> Result<LandmarkId, PlanError> {
        (**self).find_in(index)
    }
}
