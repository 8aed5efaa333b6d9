//! Which landmark of the map is which of the truth, component by component.

use std::collections::BTreeMap;

use covimap_embed::Point;
use rustc_hash::FxHashMap;

use crate::{GlobalMap, LandmarkId, LandmarkNames, MapError, Truth};

/// Fewest shared landmarks that have a shape.
const FEWEST: usize = 3;

/// The landmarks of one component that the truth knows too.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Chart {
    /// Component of the map.
    pub component: u32,
    /// Their numbers in the map, ascending.
    pub landmarks: Vec<LandmarkId>,
    /// Their positions in the map.
    pub map: Vec<Point>,
    /// Their surveyed positions.
    pub truth: Vec<Point>,
}

impl Chart {
    /// Number of landmarks.
    pub fn len(&self) -> usize {
        self.landmarks.len()
    }
}

/// Map and truth brought together by ID.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Matching {
    /// Components with at least three shared landmarks, by number.
    pub charts: Vec<Chart>,
    /// Landmarks of the truth that the map lacks.
    pub missing: usize,
    /// Landmarks of the map that the truth lacks.
    pub unknown: usize,
    /// Shared landmarks of the components that are left out.
    pub isolated: usize,
}

impl Matching {
    /// Matches by string ID.
    ///
    /// # Errors
    /// [`MapError::NoCommonLandmarks`] and [`MapError::TooFewCommon`].
    pub fn of(map: &GlobalMap, truth: &Truth) -> Result<Self, MapError> {
        let surveyed: FxHashMap<&str, Point> =
            truth.names().iter().zip(truth.positions().iter().copied()).collect();
        let mut charts = BTreeMap::<u32, Chart>::new();
        for ((number, id), placed) in (0..).map(LandmarkId).zip(map.names().iter()).zip(map.landmarks()) {
            if let Some(&position) = surveyed.get(id) {
                let component = placed.component;
                let chart =
                    charts.entry(component).or_insert_with(|| Chart { component, ..Chart::default() });
                chart.landmarks.push(number);
                chart.map.push(placed.position);
                chart.truth.push(position);
            }
        }
        let common: usize = charts.values().map(Chart::len).sum();
        if common == 0 {
            let first = |names: &LandmarkNames| names.iter().next().unwrap_or_default().to_owned();
            return Err(MapError::NoCommonLandmarks {
                map: (map.len(), first(map.names())),
                truth: (truth.names().len(), first(truth.names())),
            });
        }
        charts.retain(|_, chart| chart.len() >= FEWEST);
        if charts.is_empty() {
            return Err(MapError::TooFewCommon { common, fewest: FEWEST });
        }
        let compared: usize = charts.values().map(Chart::len).sum();
        Ok(Self {
            charts: charts.into_values().collect(),
            missing: truth.names().len() - common,
            unknown: map.len() - common,
            isolated: common - compared,
        })
    }
}
