//! The grid of places around a step, and the visibility curve tabulated on it.
//!
//! All grids are alike: [`CELLS`] x [`CELLS`] places, [`SPACING`] ranges apart, around the middle
//! of what the step shows. What a landmark's visibility is on all of them depends on where it lies
//! relative to the grid alone, and is cut out of one table: a landmark's place is rounded to
//! [`PARTS`] parts of the spacing, a rounding that differs from step to step and so averages out.
//! Rows of a cutting are contiguous, so that the arithmetic over them is done many at a time, eight where the
//! processor can ([`wide`](covimap_embed::wide())). No sum is put into another order by that: results are the same on every processor.

use covimap_embed::Point;

use super::sensor::Sensor;

/// Places of a grid along either axis.
pub(super) const CELLS: usize = 8;
/// Grid spacing, as a share of the range.
pub(super) const SPACING: f64 = 0.2;
/// Landmarks further than this from the middle of the grid, as a share of the range, say nothing.
pub(super) const NEAR: f64 = 2.2;
/// Parts of the spacing to which the offset of a landmark is rounded.
const PARTS: i32 = 4;
/// Place of the grid's middle, in spacings from its first place.
const MIDDLE: f64 = (CELLS - 1) as f64 / 2.0;
/// Entries of the table from the landmark outwards.
const REACH: i32 = (NEAR / SPACING + MIDDLE) as i32 + 1;
const WIDTH: usize = 2 * REACH as usize + 2;

/// A value for every place of a grid, by rows.
pub(super) type Cells = [[f32; CELLS]; CELLS];
/// A value for every place of a row.
pub(super) type Lanes = [f32; CELLS];

/// Sum over the places of a row, in their order.
pub(super) fn sum(lanes: Lanes) -> f64 {
    f64::from(lanes.iter().sum::<f32>())
}

/// Where a landmark lies relative to a grid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cutting {
    /// Entry of the table for the first place.
    first: u32,
    /// Offset of the landmark from the first place, in spacings.
    pub offset: [f32; 2],
}

impl Cutting {
    /// Of a landmark at `at` from the middle of the grid, no further away than [`NEAR`].
    pub fn of(at: Point, spacing: f64) -> Self {
        // Truncation rounds to the nearest once half has been added to what is positive.
        let nearest = |x: f64| (x + f64::from(PARTS * REACH) + 0.5) as i32 - PARTS * REACH;
        let [x, y] = at.map(|along| nearest((along / spacing + MIDDLE) * f64::from(PARTS)));
        let table = y.rem_euclid(PARTS) * PARTS + x.rem_euclid(PARTS);
        let column = REACH - x.div_euclid(PARTS);
        let row = REACH - y.div_euclid(PARTS);
        let first = (table as usize * WIDTH + row as usize) * WIDTH + column as usize;
        Self { first: first as u32, offset: [x, y].map(|parts| parts as f32 / PARTS as f32) }
    }
}

/// The visibility curve on all cuttings.
pub(super) struct Sight {
    pub spacing: f64,
    /// `e`.
    pub false_sighting: f32,
    /// `v`.
    visibility: Vec<f32>,
    /// `v (1 - v) / (s d)` times the spacing: the slope of `-v` along `d` over `d`, per spacing.
    slope: Vec<f32>,
}

impl Sight {
    pub fn new(sensor: Sensor) -> Self {
        let spacing = SPACING * sensor.range;
        let parts = PARTS as usize;
        let length = parts * parts * WIDTH * WIDTH;
        let mut sight = Self {
            spacing,
            false_sighting: sensor.false_sighting as f32,
            visibility: Vec::with_capacity(length),
            slope: Vec::with_capacity(length),
        };
        for table in 0..parts * parts {
            let within = [table % parts, table / parts].map(|part| part as f64 / f64::from(PARTS));
            for entry in 0..WIDTH * WIDTH {
                let along = |index: usize, within: f64| index as f64 - f64::from(REACH) - within;
                let [x, y] = [along(entry % WIDTH, within[0]), along(entry / WIDTH, within[1])];
                // At the landmark itself the curve is flat.
                let distance = x.hypot(y).max(1e-3) * spacing;
                let v = sensor.visibility(distance);
                sight.visibility.push(v as f32);
                sight.slope.push((v * (1.0 - v) / (sensor.edge * distance) * spacing) as f32);
            }
        }
        sight
    }

    /// Visibility of a landmark at the places of a row.
    #[inline(always)]
    pub fn visibility(&self, cutting: Cutting, row: usize) -> &[f32; CELLS] {
        Self::cut(&self.visibility, cutting, row)
    }

    /// Slope of its visibility there.
    #[inline(always)]
    pub fn slope(&self, cutting: Cutting, row: usize) -> &[f32; CELLS] {
        Self::cut(&self.slope, cutting, row)
    }

    #[inline(always)]
    fn cut(table: &[f32], cutting: Cutting, row: usize) -> &[f32; CELLS] {
        table[cutting.first as usize + row * WIDTH..]
            .first_chunk()
            .expect("a cutting lies within the table (bug in covimap)")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SENSOR: Sensor = Sensor { range: 0.6, edge: 0.05, detectability: 0.9, false_sighting: 1e-3 };

    #[test]
    fn cuttings_hold_the_curve_from_wherever_the_landmark_is() {
        let sight = Sight::new(SENSOR);
        // All around the middle, as far as landmarks count as near: 2.2 * 0.6.
        for turn in 0..60 {
            for distance in [0.0, 0.013, 0.3, 0.61, 1.0, 1.3199] {
                let (sin, cos) = (f64::from(turn) * 0.1).sin_cos();
                let at = [distance * cos, distance * sin];
                let cutting = Cutting::of(at, sight.spacing);
                for (axis, along) in at.into_iter().enumerate() {
                    let exact = along / 0.12 + 3.5;
                    assert!((f64::from(cutting.offset[axis]) - exact).abs() <= 0.125 + 1e-6, "{at:?}");
                }
                for (row, column) in [(0, 0), (0, 7), (3, 4), (7, 0), (7, 7)] {
                    let [x, y] = cutting.offset.map(f64::from);
                    let away = (x - column as f64).hypot(y - row as f64) * 0.12;
                    let v = 1.0 / (1.0 + ((away - 0.6) / 0.05).exp());
                    let got = f64::from(sight.visibility(cutting, row)[column]);
                    assert!((got - v).abs() < 1e-5, "{at:?} from {row}, {column}: {got}, {v}");
                    let slope = f64::from(sight.slope(cutting, row)[column]) * away;
                    assert!((slope - v * (1.0 - v) / 0.05 * 0.12).abs() < 1e-3, "{at:?}: {slope}");
                }
            }
        }
    }
}
