//! Uniform grids: what is near a place, without looking at everything.

use crate::geometry::{Point, Rect, Segment};

/// Cells per thing in the grid, at most; coarser cells are taken for worlds that are mostly empty.
const CELLS_PER_THING: f64 = 8.0;

/// Cells that any grid may have, however few things are in it.
const FREE_CELLS: f64 = 1024.0;

/// A rectangle cut into square cells, numbered row by row.
#[derive(Debug, Clone)]
struct Cells {
    min: Point,
    side: f64,
    columns: usize,
    rows: usize,
}

impl Cells {
    /// Cells of the wanted side, or larger ones if that would be too many for so many things.
    fn new(bounds: Rect, wanted_side: f64, things: usize) -> Self {
        let most = CELLS_PER_THING * things as f64 + FREE_CELLS;
        let [width, height] = [0, 1].map(|axis| bounds.max[axis] - bounds.min[axis]);
        let side = wanted_side.min(width.max(height)).max((bounds.area() / most).sqrt());
        let count = |length: f64| (length / side).ceil().max(1.0) as usize;
        Self { min: bounds.min, side, columns: count(width), rows: count(height) }
    }

    fn len(&self) -> usize {
        self.columns * self.rows
    }

    /// Column of the place, the nearest one for a place outside.
    fn column(&self, x: f64) -> usize {
        (((x - self.min[0]) / self.side).max(0.0) as usize).min(self.columns - 1)
    }

    /// Row of the place, the nearest one for a place outside.
    fn row(&self, y: f64) -> usize {
        (((y - self.min[1]) / self.side).max(0.0) as usize).min(self.rows - 1)
    }

    fn cell(&self, at: Point) -> usize {
        self.row(at[1]) * self.columns + self.column(at[0])
    }
}

/// Things in one array, cell by cell.
#[derive(Debug, Clone)]
struct ByCell<T> {
    cells: Cells,
    /// Where the things of each cell start, and at last the number of things.
    starts: Vec<u32>,
    things: Vec<T>,
}

impl<T: Copy> ByCell<T> {
    /// Counting sort. `list` calls its argument with every `(cell, thing)`, and does so twice the same way:
    /// first they are counted, then put in their places. Things of one cell stay in order.
    fn new(cells: Cells, list: impl Fn(&mut dyn FnMut(usize, T))) -> Self {
        let mut starts = vec![0_u32; cells.len() + 1];
        let mut any = None;
        list(&mut |cell, thing| {
            starts[cell + 1] += 1;
            any = Some(thing);
        });
        for cell in 0..cells.len() {
            starts[cell + 1] += starts[cell];
        }
        let mut things = any.map_or_else(Vec::new, |thing| vec![thing; starts[cells.len()] as usize]);
        let mut next = starts.clone();
        list(&mut |cell, thing| {
            things[next[cell] as usize] = thing;
            next[cell] += 1;
        });
        Self { cells, starts, things }
    }

    /// The things of the cells from `first` to before `end`.
    fn of(&self, first: usize, end: usize) -> &[T] {
        &self.things[self.starts[first] as usize..self.starts[end] as usize]
    }
}

/// A point that a search found.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Found {
    /// Its number.
    pub number: u32,
    /// From the place of the search to the point.
    pub offset: Point,
    /// The offset's length, squared.
    pub distance2: f64,
}

/// Points by cell.
#[derive(Debug, Clone)]
pub(crate) struct PointGrid(ByCell<(u32, Point)>);

impl PointGrid {
    /// Sorts the points into cells fit for searches of the given radius. Time and memory `O(n)`.
    pub(crate) fn new(points: &[Point], bounds: Rect, reach: f64) -> Self {
        let cells = Cells::new(bounds, reach / 2.0, points.len());
        Self(ByCell::new(cells.clone(), |add| {
            for (number, &point) in (0_u32..).zip(points) {
                add(cells.cell(point), (number, point));
            }
        }))
    }

    /// Calls `visit` for every point nearer than `reach`, in an order that depends on the grid alone.
    pub(crate) fn for_each_within(&self, at: Point, reach: f64, mut visit: impl FnMut(Found)) {
        let cells = &self.0.cells;
        let columns = [cells.column(at[0] - reach), cells.column(at[0] + reach)];
        for row in cells.row(at[1] - reach)..=cells.row(at[1] + reach) {
            let [first, last] = columns.map(|column| row * cells.columns + column);
            for &(number, point) in self.0.of(first, last + 1) {
                let offset = [point[0] - at[0], point[1] - at[1]];
                let distance2 = offset[0] * offset[0] + offset[1] * offset[1];
                if distance2 < reach * reach {
                    visit(Found { number, offset, distance2 });
                }
            }
        }
    }
}

/// Rectangles and what belongs to them, listed in every cell that they touch.
#[derive(Debug, Clone)]
pub(crate) struct BoxGrid<T>(ByCell<T>);

impl<T: Copy> BoxGrid<T> {
    /// Lists the boxes by cells of about the given side.
    pub(crate) fn new(bounds: Rect, side: f64, boxes: &[(Rect, T)]) -> Self {
        // As many cells as the boxes cover do no harm: their lists are that long anyway.
        let covered: f64 = boxes.iter().map(|(rect, _)| rect.area() / (side * side)).sum();
        let cells = Cells::new(bounds, side, boxes.len() + covered as usize);
        Self(ByCell::new(cells.clone(), |add| {
            for (rect, thing) in boxes {
                for row in cells.row(rect.min[1])..=cells.row(rect.max[1]) {
                    for column in cells.column(rect.min[0])..=cells.column(rect.max[0]) {
                        add(row * cells.columns + column, *thing);
                    }
                }
            }
        }))
    }

    /// Everything whose box contains the place, and perhaps more from close by.
    pub(crate) fn near(&self, at: Point) -> &[T] {
        let cell = self.0.cells.cell(at);
        self.0.of(cell, cell + 1)
    }
}

/// Walls listed so that one look gives all that come within `reach` of a place, and perhaps a few more.
pub(crate) fn wall_grid(walls: &[Segment], bounds: Rect, reach: f64) -> BoxGrid<Segment> {
    let boxes: Vec<_> = walls
        .iter()
        .map(|wall| {
            let min = [0, 1].map(|axis| wall.a[axis].min(wall.b[axis]) - reach);
            let max = [0, 1].map(|axis| wall.a[axis].max(wall.b[axis]) + reach);
            (Rect { min, max }, *wall)
        })
        .collect();
    BoxGrid::new(bounds, reach, &boxes)
}

#[cfg(test)]
mod tests;
