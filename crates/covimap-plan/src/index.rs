//! A map made ready for questions: what is where, what is near, what is next to what.

use std::sync::{Arc, OnceLock};

use covimap_embed::Point;
use covimap_map::{GlobalMap, LandmarkId, PlacedLandmark};
use rayon::prelude::*;

use crate::charts::{Chart, Near, charts};
use crate::confidence::{Confidence, Covariance};
use crate::delaunay::Neighbours;
use crate::names::NameTable;
use crate::{LandmarkRef, PlanError};

/// A map made ready for questions. Immutable: threads share one behind an [`Arc`].
///
/// Landmarks are given by their string ID or by their [`LandmarkId`], see [`LandmarkRef`]. Coordinates are those
/// of the map; a place is always a place in the frame of one component.
///
/// Takes `O(n log n)` time and `O(n)` memory to make for `n` landmarks. What only some questions need,
/// the Delaunay graph and the covariances, is made when the first of them is asked.
#[derive(Debug, Clone)]
pub struct MapIndex {
    map: Arc<GlobalMap>,
    table: NameTable,
    /// By component.
    charts: Vec<Chart>,
    /// All landmarks, by region and number.
    by_region: Vec<LandmarkId>,
    neighbours: OnceLock<Neighbours>,
    confidence: OnceLock<Confidence>,
}

impl MapIndex {
    /// Makes a map ready.
    #[must_use]
    pub fn new(map: Arc<GlobalMap>) -> Self {
        let (table, charts) = rayon::join(|| NameTable::new(map.names()), || charts(&map));
        let mut by_region: Vec<LandmarkId> = (0..map.len() as u32).map(LandmarkId).collect();
        by_region.sort_by_key(|id| map.landmarks()[id.index()].region);
        let (neighbours, confidence) = (OnceLock::new(), OnceLock::new());
        Self { map, table, charts, by_region, neighbours, confidence }
    }

    /// The map behind the index.
    #[must_use]
    pub fn map(&self) -> &Arc<GlobalMap> {
        &self.map
    }

    /// The number of a landmark, which is given by its ID or by its number. `O(1)`.
    ///
    /// # Errors
    /// [`PlanError::UnknownLandmark`], [`PlanError::UnknownNumber`].
    pub fn id(&self, landmark: impl LandmarkRef) -> Result<LandmarkId, PlanError> {
        landmark.find_in(self)
    }

    /// The string ID of a landmark of this map.
    #[must_use]
    pub fn name(&self, id: LandmarkId) -> &str {
        self.map.names().name(id)
    }

    /// What the map says of a landmark: position, component, region, evidence. `O(1)`.
    ///
    /// # Errors
    /// Those of [`MapIndex::id`].
    pub fn landmark(&self, landmark: impl LandmarkRef) -> Result<&PlacedLandmark, PlanError> {
        Ok(self.placed(self.id(landmark)?))
    }

    /// How well the position of a landmark is known. See `docs/maths/planning.md` for what it rests on.
    /// The first call is `O(n)`, later ones are `O(1)`.
    ///
    /// # Errors
    /// Those of [`MapIndex::id`].
    pub fn covariance(&self, landmark: impl LandmarkRef) -> Result<Covariance, PlanError> {
        Ok(self.covariance_of(self.id(landmark)?))
    }

    /// The landmarks in the core of a region, ascending; none for a region that the map does not have.
    #[must_use]
    pub fn region(&self, region: u32) -> &[LandmarkId] {
        let of = |id: &LandmarkId| self.placed(*id).region;
        let start = self.by_region.partition_point(|id| of(id) < region);
        let length = self.by_region[start..].partition_point(|id| of(id) == region);
        &self.by_region[start..start + length]
    }

    /// The numbers of all components, ascending.
    pub fn components(&self) -> impl ExactSizeIterator<Item = u32> {
        self.charts.iter().map(|chart| chart.component)
    }

    /// The landmarks of a component, ascending.
    ///
    /// # Errors
    /// [`PlanError::UnknownComponent`].
    pub fn component(&self, component: u32) -> Result<&[LandmarkId], PlanError> {
        Ok(&self.chart(component)?.members)
    }

    /// The `k` other landmarks nearest to a landmark, nearest first, equally near ones by number; all of the
    /// component if it has fewer.
    ///
    /// `O(k log n)`: microseconds.
    ///
    /// # Errors
    /// Those of [`MapIndex::id`].
    pub fn nearest(&self, landmark: impl LandmarkRef, k: usize) -> Result<Vec<Near>, PlanError> {
        let id = self.id(landmark)?;
        let placed = self.placed(id);
        Ok(self.chart(placed.component)?.nearest(placed.position, k, |other| other != id))
    }

    /// The `k` landmarks nearest to a place in the frame of a component, as [`MapIndex::nearest`].
    ///
    /// # Errors
    /// [`PlanError::UnknownComponent`], [`PlanError::Nowhere`].
    pub fn nearest_to(&self, component: u32, place: Point, k: usize) -> Result<Vec<Near>, PlanError> {
        check_place(place)?;
        Ok(self.chart(component)?.nearest(place, k, |_| true))
    }

    /// The other landmarks within a radius of a landmark, nearest first, equally near ones by number.
    ///
    /// # Errors
    /// Those of [`MapIndex::id`]; [`PlanError::BadRadius`].
    pub fn within(&self, landmark: impl LandmarkRef, radius: f64) -> Result<Vec<Near>, PlanError> {
        let id = self.id(landmark)?;
        let placed = self.placed(id);
        let mut found = self.within_of(placed.component, placed.position, radius)?;
        found.retain(|near| near.landmark != id);
        Ok(found)
    }

    /// The landmarks within a radius of a place in the frame of a component, as [`MapIndex::within`].
    ///
    /// # Errors
    /// [`PlanError::UnknownComponent`], [`PlanError::Nowhere`], [`PlanError::BadRadius`].
    pub fn within_of(&self, component: u32, place: Point, radius: f64) -> Result<Vec<Near>, PlanError> {
        check_place(place)?;
        if !(radius.is_finite() && radius >= 0.0) {
            return Err(PlanError::BadRadius { radius });
        }
        Ok(self.chart(component)?.within(place, radius))
    }

    /// [`MapIndex::nearest`] of many landmarks, on all threads.
    ///
    /// # Errors
    /// Those of the first landmark that has some.
    pub fn nearest_of_each<L>(&self, landmarks: &[L], k: usize) -> Result<Vec<Vec<Near>>, PlanError>
    where
        L: LandmarkRef + Sync,
    {
        each(landmarks, |landmark| self.nearest(landmark, k))
    }

    /// [`MapIndex::within`] of many landmarks, on all threads.
    ///
    /// # Errors
    /// Those of the first landmark that has some.
    pub fn within_of_each<L>(&self, landmarks: &[L], radius: f64) -> Result<Vec<Vec<Near>>, PlanError>
    where
        L: LandmarkRef + Sync,
    {
        each(landmarks, |landmark| self.within(landmark, radius))
    }

    /// The landmarks that share a Delaunay edge with a landmark, ascending. The first call is
    /// `O(n log n)`, later ones are `O(1)`.
    ///
    /// # Errors
    /// Those of [`MapIndex::id`].
    pub fn neighbours(&self, landmark: impl LandmarkRef) -> Result<&[LandmarkId], PlanError> {
        let id = self.id(landmark)?;
        Ok(made(&self.neighbours, || Neighbours::new(&self.map, &self.charts)).of(id))
    }

    pub(crate) fn placed(&self, id: LandmarkId) -> &PlacedLandmark {
        &self.map.landmarks()[id.index()]
    }

    pub(crate) fn covariance_of(&self, id: LandmarkId) -> Covariance {
        self.confidence().covariances[id.index()]
    }

    /// By how much variances grow between landmarks this far apart in a component of the map.
    pub(crate) fn growth(&self, component: u32, apart: f64) -> f64 {
        let chart = self.charts.partition_point(|chart| chart.component < component);
        self.confidence().growth(chart, apart)
    }

    pub(crate) fn confidence(&self) -> &Confidence {
        made(&self.confidence, || Confidence::new(&self.map, &self.charts))
    }

    /// Whether two landmarks are in one frame.
    ///
    /// # Errors
    /// [`PlanError::Apart`] if not.
    pub(crate) fn check_together(&self, a: LandmarkId, b: LandmarkId) -> Result<(), PlanError> {
        let components = [a, b].map(|id| self.placed(id).component);
        if components[0] == components[1] {
            return Ok(());
        }
        Err(PlanError::Apart { ids: [a, b].map(|id| self.name(id).to_owned()), components })
    }

    fn chart(&self, component: u32) -> Result<&Chart, PlanError> {
        let found = self.charts.binary_search_by_key(&component, |chart| chart.component);
        let unknown = |_| PlanError::UnknownComponent { component, components: self.charts.len() };
        Ok(&self.charts[found.map_err(unknown)?])
    }

    /// The landmark of that name, if there is one. `O(1)`.
    pub(crate) fn lookup(&self, name: &str) -> Option<LandmarkId> {
        self.table.find(self.map.names(), name)
    }
}

/// Answers to many questions, in their order, asked on all threads; the first error in that order.
pub(crate) fn each<Q: Sync, A: Send>(
    questions: &[Q],
    answer: impl Fn(&Q) -> Result<A, PlanError> + Sync + Send,
) -> Result<Vec<A>, PlanError> {
    questions.par_iter().map(answer).collect::<Vec<_>>().into_iter().collect()
}

fn check_place(position: Point) -> Result<(), PlanError> {
    if position.iter().all(|v| v.is_finite()) { Ok(()) } else { Err(PlanError::Nowhere { position }) }
}

/// What a cell holds, which is made at first.
///
/// It is made outside of the lock of the cell: making it shares work among threads, and one that waits for the others may take up another
/// task that asks for the same cell. Under the lock it would then wait for itself.
fn made<T>(cell: &OnceLock<T>, make: impl FnOnce() -> T) -> &T {
    if let Some(made) = cell.get() {
        return made;
    }
    let made = make();
    cell.get_or_init(|| made)
}

#[cfg(test)]
mod tests;
