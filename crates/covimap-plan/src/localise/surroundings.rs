//! The landmarks of every chart by square cells: what stands near a place.

use covimap_embed::Point;
use covimap_map::{GlobalMap, LandmarkId, Sensing};

/// Component, column and row.
type Cell = (u32, [i64; 2]);

/// Landmarks by cells one range wide.
#[derive(Debug, Clone)]
pub(super) struct Surroundings {
    /// Width of a cell, by component.
    sides: Vec<f64>,
    /// Cell and number of every landmark, ascending.
    filled: Vec<(Cell, LandmarkId)>,
}

impl Surroundings {
    pub fn new(map: &GlobalMap, sensing: &Sensing) -> Self {
        let sides: Vec<f64> = sensing.sensors().iter().map(|sensor| sensor.range).collect();
        let entry = |(number, placed): (u32, &covimap_map::PlacedLandmark)| {
            let side = sides[placed.component as usize];
            ((placed.component, placed.position.map(|c| (c / side).floor() as i64)), LandmarkId(number))
        };
        let mut filled: Vec<_> = (0..).zip(map.landmarks()).map(entry).collect();
        filled.sort_unstable();
        Self { sides, filled }
    }

    /// The landmarks of the cells that a disc touches, and so all that are in the disc.
    pub fn around(&self, component: u32, middle: Point, radius: f64) -> impl Iterator<Item = LandmarkId> {
        let side = self.sides[component as usize];
        let cell = |at: f64| (at / side).floor() as i64;
        let rows = [cell(middle[1] - radius), cell(middle[1] + radius)];
        (cell(middle[0] - radius)..=cell(middle[0] + radius)).flat_map(move |column| {
            let [first, last] = rows.map(|row| (component, [column, row]));
            let from = self.filled.partition_point(|entry| entry.0 < first);
            self.filled[from..].iter().take_while(move |entry| entry.0 <= last).map(|entry| entry.1)
        })
    }
}
