//! Landmarks in cells: pieces of bounded size that few roads leave.
//!
//! A piece that is too large is cut in two across its longer side, in the middle third, where the fewest
//! roads cross: in a building that is at a wall. The regions of the map are no cells: they are so small that
//! most of their landmarks are at the border, and they follow co-visibility, not the fewest roads across.

use std::ops::Range;
use std::sync::atomic::{AtomicU32, Ordering};

use covimap_embed::Point;
use covimap_map::LandmarkId;

use super::Roads;

/// The landmarks of a map, cell by cell; in each, those at the border of the cell come first.
///
/// The *place* of a landmark is where it stands in this order: what belongs together lies together.
#[derive(Debug, Clone)]
pub(super) struct Cells {
    /// By place.
    pub order: Vec<LandmarkId>,
    /// By landmark.
    place: Vec<u32>,
    /// Cell c holds the places `starts[c]..starts[c + 1]`, of which those before `inner[c]` are at its border.
    starts: Vec<u32>,
    inner: Vec<u32>,
    /// By place.
    cell: Vec<u32>,
}

impl Cells {
    /// Cells of at most so many landmarks, at least 1, of a map that has some. `O(n log^2 n)`; the same for any
    /// number of threads.
    pub fn new(roads: &Roads<'_>, most: usize) -> Self {
        let n = roads.index.map().len();
        let mut order: Vec<LandmarkId> = (0..n as u32).map(LandmarkId).collect();
        let place: Vec<AtomicU32> = (0..n as u32).map(AtomicU32::new).collect();
        let sizes = Cutter { roads, place: &place, most }.cut(&mut order, 0);
        let mut starts = vec![0];
        let mut cell = Vec::with_capacity(n);
        for (number, size) in (0..).zip(sizes) {
            cell.resize(cell.len() + size, number);
            starts.push(cell.len() as u32);
        }
        let place = place.into_iter().map(AtomicU32::into_inner).collect();
        let mut cells = Self { order, place, starts, inner: Vec::new(), cell };
        cells.borders_first(roads);
        cells
    }

    fn borders_first(&mut self, roads: &Roads<'_>) {
        for cell in 0..self.starts.len() as u32 - 1 {
            let places = self.places(cell);
            let leaves =
                |&id: &LandmarkId| roads.lines(id).any(|(line, _)| !places.contains(&self.place(line.to)));
            let here = &self.order[places.start as usize..places.end as usize];
            let (border, inside): (Vec<LandmarkId>, Vec<LandmarkId>) = here.iter().partition(|id| leaves(id));
            self.inner.push(places.start + border.len() as u32);
            for (place, id) in places.zip(border.into_iter().chain(inside)) {
                self.order[place as usize] = id;
                self.place[id.index()] = place;
            }
        }
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.inner.len()
    }

    /// Where a landmark stands.
    pub fn place(&self, id: LandmarkId) -> u32 {
        self.place[id.index()]
    }

    /// The cell of what stands at a place.
    pub fn of(&self, place: u32) -> u32 {
        self.cell[place as usize]
    }

    /// The places of a cell.
    pub fn places(&self, cell: u32) -> Range<u32> {
        self.starts[cell as usize]..self.starts[cell as usize + 1]
    }

    /// The places of a cell from which roads lead to other cells.
    pub fn border(&self, cell: u32) -> Range<u32> {
        self.starts[cell as usize]..self.inner[cell as usize]
    }
}

/// Cuts pieces in two until they are small enough.
struct Cutter<'a> {
    roads: &'a Roads<'a>,
    /// Where each landmark stands at the moment. A piece keeps to its own stretch of places, so that pieces
    /// that are cut at the same time see of each other only that they are elsewhere.
    place: &'a [AtomicU32],
    most: usize,
}

impl Cutter<'_> {
    /// Brings a piece, which stands from `start` on, into the order of its cells, and tells their sizes.
    fn cut(&self, piece: &mut [LandmarkId], start: usize) -> Vec<usize> {
        self.sort(piece, start);
        if piece.len() <= self.most {
            return vec![piece.len()];
        }
        let at = self.thinnest(piece, start);
        let (left, right) = piece.split_at_mut(at);
        let (mut sizes, more) = rayon::join(|| self.cut(left, start), || self.cut(right, start + at));
        sizes.extend(more);
        sizes
    }

    /// Along its longer side.
    fn sort(&self, piece: &mut [LandmarkId], start: usize) {
        let of = |id: LandmarkId| self.roads.index.placed(id).position;
        let (mut low, mut high): (Point, Point) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for &id in &*piece {
            for axis in 0..2 {
                low[axis] = low[axis].min(of(id)[axis]);
                high[axis] = high[axis].max(of(id)[axis]);
            }
        }
        let axis = usize::from(high[1] - low[1] > high[0] - low[0]);
        piece.sort_unstable_by(|&a, &b| of(a)[axis].total_cmp(&of(b)[axis]).then(a.cmp(&b)));
        for (place, id) in (start as u32..).zip(&*piece) {
            self.place[id.index()].store(place, Ordering::Relaxed);
        }
    }

    /// The cut in the middle third of a piece that the fewest roads cross, of several the one nearest the middle.
    fn thinnest(&self, piece: &[LandmarkId], start: usize) -> usize {
        let places = start..start + piece.len();
        let third = (piece.len() / 3).max(1)..=2 * piece.len() / 3;
        let mut crossing = 0_i64;
        let mut best = (i64::MAX, 0, 0);
        for (at, &id) in piece.iter().enumerate() {
            if third.contains(&at) {
                best = best.min((crossing, at.abs_diff(piece.len() / 2), at));
            }
            for (line, _) in self.roads.lines(id) {
                let to = self.place[line.to.index()].load(Ordering::Relaxed) as usize;
                if places.contains(&to) {
                    crossing += if to > start + at { 1 } else { -1 };
                }
            }
        }
        best.2
    }
}

#[cfg(test)]
mod tests;
