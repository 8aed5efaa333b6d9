//! Uniform grids: what is near a place, without looking at everything.

use crate::geometry::{Point, Rect, Segment};

/// Cells per thing in the grid, at most; coarser cells are taken for worlds that are mostly empty.
const CELLS_PER_THING: f64 = 8.0;

/// A rectangle cut into square cells, numbered row by row.
#[derive(Debug, Clone)]
struct Cells {
    min: Point,
    side: f64,
    columns: usize,
    rows: usize,
}

impl Cells {
    fn new(bounds: Rect, wanted_side: f64, things: usize) -> Self {
        let most = CELLS_PER_THING * (things as f64 + 128.0);
        let side = wanted_side.max((bounds.area() / most).sqrt());
        let count = |axis: usize| ((bounds.max[axis] - bounds.min[axis]) / side).ceil().max(1.0) as usize;
        Self { min: bounds.min, side, columns: count(0), rows: count(1) }
    }

    fn len(&self) -> usize {
        self.columns * self.rows
    }

    fn column(&self, x: f64) -> usize {
        (((x - self.min[0]) / self.side).max(0.0) as usize).min(self.columns - 1)
    }

    fn row(&self, y: f64) -> usize {
        (((y - self.min[1]) / self.side).max(0.0) as usize).min(self.rows - 1)
    }

    fn cell(&self, point: Point) -> usize {
        self.row(point[1]) * self.columns + self.column(point[0])
    }
}

/// Puts `(cell, thing)` pairs into one array by cell; returns where each cell starts, and the things.
fn sort_by_cell(cells: usize, pairs: &[(usize, u32)]) -> (Vec<u32>, Vec<u32>) {
    let mut starts = vec![0_u32; cells + 1];
    for &(cell, _) in pairs {
        starts[cell + 1] += 1;
    }
    for cell in 0..cells {
        starts[cell + 1] += starts[cell];
    }
    let mut next = starts.clone();
    let mut things = vec![0; pairs.len()];
    for &(cell, thing) in pairs {
        things[next[cell] as usize] = thing;
        next[cell] += 1;
    }
    (starts, things)
}

/// Points by cell.
#[derive(Debug, Clone)]
pub(crate) struct PointGrid {
    cells: Cells,
    starts: Vec<u32>,
    numbers: Vec<u32>,
    points: Vec<Point>,
}

impl PointGrid {
    /// Sorts the points into cells fit for searches of the given radius. Time and memory `O(n)`.
    pub(crate) fn new(points: &[Point], bounds: Rect, reach: f64) -> Self {
        let cells = Cells::new(bounds, reach / 2.0, points.len());
        let pairs: Vec<_> = (0_u32..).zip(points).map(|(number, &p)| (cells.cell(p), number)).collect();
        let (starts, numbers) = sort_by_cell(cells.len(), &pairs);
        let points = numbers.iter().map(|&number| points[number as usize]).collect();
        Self { cells, starts, numbers, points }
    }

    /// Calls `visit(number, offset, squared distance)` for every point nearer than `reach`, cell by cell.
    pub(crate) fn for_each_within(&self, at: Point, reach: f64, mut visit: impl FnMut(u32, Point, f64)) {
        let columns = self.cells.column(at[0] - reach)..=self.cells.column(at[0] + reach);
        for row in self.cells.row(at[1] - reach)..=self.cells.row(at[1] + reach) {
            let first = self.starts[row * self.cells.columns + columns.start()] as usize;
            let last = self.starts[row * self.cells.columns + columns.end() + 1] as usize;
            for (&number, point) in self.numbers[first..last].iter().zip(&self.points[first..last]) {
                let offset = [point[0] - at[0], point[1] - at[1]];
                let distance2 = offset[0] * offset[0] + offset[1] * offset[1];
                if distance2 < reach * reach {
                    visit(number, offset, distance2);
                }
            }
        }
    }
}

/// For each cell the walls that come within reach of any of its points.
#[derive(Debug, Clone)]
pub(crate) struct WallGrid {
    cells: Cells,
    starts: Vec<u32>,
    walls: Vec<Segment>,
}

impl WallGrid {
    /// Lists walls by cell, for questions that concern places up to `reach` from the robot.
    pub(crate) fn new(walls: &[Segment], bounds: Rect, reach: f64) -> Self {
        let length: f64 = walls.iter().map(|wall| (wall.b[0] - wall.a[0]).hypot(wall.b[1] - wall.a[1])).sum();
        let cells = Cells::new(bounds, reach / 2.0, walls.len() + (length / reach) as usize);
        let mut pairs = Vec::new();
        for (number, wall) in (0_u32..).zip(walls) {
            let low = [0, 1].map(|axis| wall.a[axis].min(wall.b[axis]) - reach);
            let high = [0, 1].map(|axis| wall.a[axis].max(wall.b[axis]) + reach);
            for row in cells.row(low[1])..=cells.row(high[1]) {
                let columns = cells.column(low[0])..=cells.column(high[0]);
                pairs.extend(columns.map(|column| (row * cells.columns + column, number)));
            }
        }
        let (starts, numbers) = sort_by_cell(cells.len(), &pairs);
        let walls = numbers.iter().map(|&number| walls[number as usize]).collect();
        Self { cells, starts, walls }
    }

    /// All walls that come within reach of the place, and perhaps a few more.
    pub(crate) fn near(&self, at: Point) -> &[Segment] {
        let cell = self.cells.cell(at);
        &self.walls[self.starts[cell] as usize..self.starts[cell + 1] as usize]
    }
}
