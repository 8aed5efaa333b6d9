//! Where each chart goes on the page.
//!
//! The highest chart comes first and makes a shelf; the others fill shelves from left to right and
//! stand below each other where a shelf is high enough, each at the first place with room for
//! it. The common scale is about the largest at which all shelves fit.

/// Largest drawn area, in pixels.
const WIDTH: f64 = 1120.0;
const HEIGHT: f64 = 820.0;
/// Room between charts.
const GAP: f64 = 24.0;
/// Halvings of the scale's interval.
const HALVINGS: u32 = 40;

/// A rectangle of the page.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cell {
    pub x: f64,
    pub y: f64,
    pub width: f64,
    pub height: f64,
}

/// Cells of all charts, and the area they take.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Layout {
    /// Pixels a unit.
    pub scale: f64,
    pub cells: Vec<Cell>,
    pub width: f64,
    pub height: f64,
}

/// What a chart needs.
#[derive(Debug, Clone, Copy)]
pub(super) struct Need {
    /// Width and height, in units.
    pub extent: [f64; 2],
    /// Besides that, in pixels.
    pub room: Room,
}

/// Room besides a chart's own extent, in pixels.
#[derive(Debug, Clone, Copy)]
pub(super) struct Room {
    /// On all sides.
    pub padding: f64,
    /// Below, for a caption.
    pub caption: f64,
    /// At least so wide in all.
    pub narrowest: f64,
}

impl Layout {
    /// Packs charts on a page of a `share` of the largest size.
    pub fn new(needs: &[Need], share: f64) -> Self {
        let smallest = Self::at(0.0, needs).height;
        // Where padding and captions alone take much of the page, the page grows.
        let highest = (share * HEIGHT).max(2.0 * smallest);
        let limit = needs.iter().map(|need| need.limit([share * WIDTH, highest]));
        let limit = limit.fold(f64::INFINITY, f64::min);
        if limit == f64::INFINITY {
            // Charts of one place each look the same at every scale.
            return Self::at(1.0, needs);
        }
        let fits = |scale: f64| Self::at(scale, needs).height <= highest;
        if fits(limit) {
            return Self::at(limit, needs);
        }
        let (mut low, mut high) = (0.0, limit);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if fits(middle) { low = middle } else { high = middle }
        }
        Self::at(low, needs)
    }

    fn at(scale: f64, needs: &[Need]) -> Self {
        let cell = |need: &Need| need.cell(scale);
        let mut order: Vec<usize> = (0..needs.len()).collect();
        order.sort_by(|&a, &b| cell(&needs[b]).1.total_cmp(&cell(&needs[a]).1));
        let mut shelves = Shelves::default();
        let mut cells = vec![Cell { x: 0.0, y: 0.0, width: 0.0, height: 0.0 }; needs.len()];
        for index in order {
            let (width, height) = cell(&needs[index]);
            cells[index] = shelves.place(width, height);
        }
        let width = cells.iter().map(|cell| cell.x + cell.width).fold(0.0, f64::max);
        let height = cells.iter().map(|cell| cell.y + cell.height).fold(0.0, f64::max);
        Self { scale, cells, width, height }
    }
}

impl Need {
    /// Width and height in pixels.
    fn cell(&self, scale: f64) -> (f64, f64) {
        let [width, height] = self.extent.map(|extent| scale * extent + 2.0 * self.room.padding);
        (width.max(self.room.narrowest), height + self.room.caption)
    }

    /// Largest scale at which the chart fits alone on a page.
    fn limit(&self, page: [f64; 2]) -> f64 {
        let Room { padding, caption, .. } = self.room;
        let free = [page[0] - 2.0 * padding, page[1] - 2.0 * padding - caption];
        (free[0] / self.extent[0]).min(free[1] / self.extent[1])
    }
}

#[derive(Default)]
struct Shelves {
    shelves: Vec<Shelf>,
    columns: Vec<Column>,
}

struct Shelf {
    top: f64,
    height: f64,
    /// Right end of the last column.
    right: f64,
}

/// Cells below each other.
struct Column {
    shelf: usize,
    left: f64,
    width: f64,
    /// Height that is taken.
    taken: f64,
}

impl Shelves {
    /// The first place with room for a cell that is not higher than those before it.
    fn place(&mut self, width: f64, height: f64) -> Cell {
        let below = |column: &&mut Column| {
            width <= column.width && column.taken + GAP + height <= self.shelves[column.shelf].height
        };
        if let Some(column) = self.columns.iter_mut().find(below) {
            let y = self.shelves[column.shelf].top + column.taken + GAP;
            column.taken += GAP + height;
            return Cell { x: column.left, y, width, height };
        }
        let beside = self.shelves.iter().position(|shelf| shelf.right + GAP + width <= WIDTH);
        let shelf = beside.unwrap_or_else(|| self.add_shelf(height));
        let Shelf { top, ref mut right, .. } = self.shelves[shelf];
        let left = if beside.is_some() { *right + GAP } else { 0.0 };
        *right = left + width;
        self.columns.push(Column { shelf, left, width, taken: height });
        Cell { x: left, y: top, width, height }
    }

    fn add_shelf(&mut self, height: f64) -> usize {
        let top = self.shelves.last().map_or(0.0, |shelf| shelf.top + shelf.height + GAP);
        self.shelves.push(Shelf { top, height, right: 0.0 });
        self.shelves.len() - 1
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    const ROOM: Room = Room { padding: 20.0, caption: 18.0, narrowest: 60.0 };

    fn layout(extents: &[[f64; 2]], room: Room) -> Layout {
        Layout::new(&extents.iter().map(|&extent| Need { extent, room }).collect::<Vec<_>>(), 1.0)
    }

    fn overlap(a: &Cell, b: &Cell) -> bool {
        a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height
    }

    proptest! {
        #[test]
        fn cells_hold_their_charts_stay_on_the_page_and_do_not_overlap(
            extents in prop::collection::vec([0.0..10.0f64, 0.0..10.0f64], 0..60)
        ) {
            let layout = layout(&extents, ROOM);
            prop_assert!(layout.scale > 0.0 && layout.width <= WIDTH + 1e-6 && layout.height <= HEIGHT + 1e-6);
            for (index, (cell, extent)) in layout.cells.iter().zip(&extents).enumerate() {
                prop_assert!(cell.width >= layout.scale * extent[0] + 40.0 - 1e-9);
                prop_assert!(cell.height >= layout.scale * extent[1] + 58.0 - 1e-9);
                prop_assert!(cell.x + cell.width <= layout.width && cell.y + cell.height <= layout.height);
                prop_assert!(layout.cells[..index].iter().all(|other| !overlap(cell, other)));
            }
        }
    }

    #[test]
    fn one_chart_fills_the_page_in_one_direction() {
        let room = Room { padding: 10.0, caption: 0.0, narrowest: 0.0 };
        assert_eq!(layout(&[[11.0, 1.0]], room).width, WIDTH);
        assert_eq!(layout(&[[1.0, 8.0]], room).height, HEIGHT);
        // 100 pixels a unit: (1120 - 20) / 11.
        assert_eq!(layout(&[[11.0, 1.0]], room).scale, 100.0);
        assert_eq!(Layout::new(&[Need { extent: [1.0, 8.0], room }], 0.5).height, 0.5 * HEIGHT);
    }

    #[test]
    fn small_charts_stand_below_each_other_beside_a_large_one() {
        let room = Room { padding: 0.0, caption: 0.0, narrowest: 0.0 };
        let packed = layout(&[[8.0, 8.0], [1.0, 1.0], [1.0, 1.0]], room);
        let [large, first, second] = packed.cells[..] else { panic!("three cells") };
        assert_eq!((large.x, large.y, first.y), (0.0, 0.0, 0.0));
        assert_eq!((second.x, second.y), (first.x, first.height + GAP));
    }

    #[test]
    fn charts_without_extent_get_their_room() {
        let layout_of_two = layout(&[[0.0, 0.0], [0.0, 0.0]], ROOM);
        assert_eq!((layout_of_two.scale, layout_of_two.height), (1.0, 58.0));
        assert_eq!(layout_of_two.cells[1].x, 60.0 + GAP);
        assert_eq!(layout(&[], ROOM).width, 0.0);
    }

    #[test]
    fn a_page_of_very_many_charts_grows_and_keeps_half_for_them() {
        let many = layout(&[[1.0, 1.0]; 400], ROOM);
        // 13 of 60 + 24 pixels fit side by side: 31 rows of 58 + 24.
        assert!(many.height > HEIGHT && many.height <= 2.0 * 31.0 * 82.0, "{}", many.height);
        assert!(many.scale > 10.0, "{}", many.scale);
    }
}
