//! Roads made ready for many routes: an overlay over cells, in the manner of customisable route planning.
//!
//! A way enters and leaves a cell at its border. The cheapest ways inside a cell from each landmark at its
//! border to the others there are found once and kept as *passages*: their ends and costs. A search then walks
//! over roads in the cells of its two ends, and elsewhere over passages and the roads between cells; inside
//! each passage of what it finds, the landmarks are searched for again. Any way falls into pieces within
//! cells and roads between them, so that none costs less than what is found.
//!
//! A passage over another landmark at the border is left out, being made of two others. That landmark must be
//! away from both ends by more than rounding: then both parts cost less than the whole, and no two
//! passages are left out because of each other.
//!
//! # Complexity
//! A cell of `s` landmarks has some `4 sqrt(s)` at its border, with a search of `O(s log s)` each. Few
//! passages are left: cheapest ways run together.
//!
//! # References
//! D. Delling, A. V. Goldberg, T. Pajor, R. F. Werneck: Customizable route planning. SEA 2011.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use covimap_map::LandmarkId;
use rayon::prelude::*;

use super::Roads;
use super::bound::Bound;
use super::cells::Cells;
use crate::search::{AStar, RouteSearch, SearchGraph};

/// Two costs this much of the dearest road of a cell apart differ by more than rounding.
const CLEAR: f64 = 1e-9;

/// Passages through the cells of a map.
#[derive(Debug, Clone)]
pub(super) struct Overlay {
    cells: Cells,
    /// Of landmarks by place.
    bound: Bound,
    /// Those from place p are `passages[starts[p]..starts[p + 1]]`: ways inside its cell, and roads out of it.
    starts: Vec<u32>,
    passages: Vec<(u32, f64)>,
}

impl Overlay {
    /// Over cells of at most so many landmarks: see the module. On all threads.
    pub fn new(roads: &Roads<'_>, most: usize) -> Self {
        let cells = Cells::new(roads, most);
        let of_cell = |cell| Inside { roads, cells: &cells, cell }.passages();
        let by_cell: Vec<Vec<Vec<(u32, f64)>>> =
            (0..cells.count() as u32).into_par_iter().map(of_cell).collect();
        let mut starts = Vec::with_capacity(cells.order.len() + 1);
        let mut passages = Vec::with_capacity(by_cell.iter().flatten().map(Vec::len).sum());
        starts.push(0);
        for from in by_cell.into_iter().flatten() {
            passages.extend(from);
            starts.push(passages.len() as u32);
        }
        Self { bound: roads.bound.reordered(&cells.order), cells, starts, passages }
    }
}

impl RouteSearch<Roads<'_>> for Overlay {
    fn search(&self, roads: &Roads<'_>, from: LandmarkId, to: LandmarkId) -> Option<Vec<LandmarkId>> {
        let [from, to] = [from, to].map(|id| self.cells.place(id));
        let open = [from, to].map(|place| self.cells.of(place));
        let way = AStar.search(&Across { overlay: self, roads, open }, LandmarkId(from), LandmarkId(to))?;
        let mut landmarks = vec![self.cells.order[from as usize]];
        for leg in way.windows(2) {
            let [from, to] = [leg[0].0, leg[1].0];
            let cell = self.cells.of(from);
            if cell != self.cells.of(to) || open.contains(&cell) {
                landmarks.push(self.cells.order[to as usize]);
            } else {
                landmarks.extend(Inside { roads, cells: &self.cells, cell }.way(from, to));
            }
        }
        Some(landmarks)
    }
}

/// Roads in the open cells, and passages elsewhere; landmarks are numbered by their places.
struct Across<'a> {
    overlay: &'a Overlay,
    roads: &'a Roads<'a>,
    open: [u32; 2],
}

impl SearchGraph for Across<'_> {
    fn landmarks(&self) -> usize {
        self.overlay.cells.order.len()
    }

    fn roads_from(&self, from: LandmarkId) -> impl Iterator<Item = (LandmarkId, f64)> {
        let Overlay { cells, starts, passages, .. } = self.overlay;
        let is_open = self.open.contains(&cells.of(from.0));
        let roads = is_open.then(|| self.roads.roads_from(cells.order[from.index()]));
        let roads = roads.into_iter().flatten().map(|(to, cost)| (LandmarkId(cells.place(to)), cost));
        let [start, end] = [from.index(), from.index() + 1].map(|i| starts[i] as usize);
        let passages = if is_open { &[] } else { &passages[start..end] };
        roads.chain(passages.iter().map(|&(to, cost)| (LandmarkId(to), cost)))
    }

    fn at_least(&self, from: LandmarkId, to: LandmarkId) -> f64 {
        self.overlay.bound.at_least(from, to)
    }
}

/// The roads inside one cell; its landmarks are numbered by their places, from 0 on.
struct Inside<'a> {
    roads: &'a Roads<'a>,
    cells: &'a Cells,
    cell: u32,
}

impl Inside<'_> {
    fn first(&self) -> u32 {
        self.cells.places(self.cell).start
    }

    fn id(&self, number: LandmarkId) -> LandmarkId {
        self.cells.order[(self.first() + number.0) as usize]
    }

    /// The landmarks of a cheapest way between two places, without the first.
    fn way(&self, from: u32, to: u32) -> impl Iterator<Item = LandmarkId> {
        let [from, to] = [from, to].map(|place| LandmarkId(place - self.first()));
        let way = AStar.search(self, from, to).expect("a passage is a way inside a cell (bug in covimap)");
        way.into_iter().skip(1).map(|number| self.id(number))
    }

    /// From every place of the cell: passages, and roads to other cells. None from inside the cell.
    fn passages(&self) -> Vec<Vec<(u32, f64)>> {
        let border = self.cells.border(self.cell).len();
        let numbers = 0..self.landmarks() as u32;
        let inside: Vec<Vec<(u32, f64)>> = numbers
            .clone()
            .map(|number| self.roads_from(LandmarkId(number)).map(|(to, cost)| (to.0, cost)).collect())
            .collect();
        let dearest = inside.iter().flatten().map(|road| road.1).fold(0.0, f64::max);
        let from = |number: u32| {
            if number as usize >= border {
                return Vec::new();
            }
            let passages = passages_from(number, &inside, border, CLEAR * dearest);
            let passages = passages.into_iter().map(|(to, cost)| (self.first() + to, cost));
            let roads = self.roads.roads_from(self.id(LandmarkId(number)));
            let roads = roads.map(|(to, cost)| (self.cells.place(to), cost));
            passages.chain(roads.filter(|&(to, _)| self.cells.of(to) != self.cell)).collect()
        };
        numbers.map(from).collect()
    }
}

impl SearchGraph for Inside<'_> {
    fn landmarks(&self) -> usize {
        self.cells.places(self.cell).len()
    }

    fn roads_from(&self, from: LandmarkId) -> impl Iterator<Item = (LandmarkId, f64)> {
        let (places, first) = (self.cells.places(self.cell), self.first());
        let roads = self.roads.roads_from(self.id(from));
        roads
            .map(|(to, cost)| (self.cells.place(to), cost))
            .filter(move |(to, _)| places.contains(to))
            .map(move |(to, cost)| (LandmarkId(to - first), cost))
    }

    fn at_least(&self, from: LandmarkId, to: LandmarkId) -> f64 {
        self.roads.at_least(self.id(from), self.id(to))
    }
}

/// The cheapest ways from one landmark at the border to the others there, but for those that lead over another
/// one which is more than `clear` away from both ends. Dijkstra's search.
fn passages_from(from: u32, roads: &[Vec<(u32, f64)>], border: usize, clear: f64) -> Vec<(u32, f64)> {
    let mut costs = vec![f64::INFINITY; roads.len()];
    let mut made_of_others = vec![false; roads.len()];
    let mut found = Vec::new();
    // Costs are not negative, so that their bits are in their order.
    let mut open = BinaryHeap::from([Reverse((0_u64, from))]);
    costs[from as usize] = 0.0;
    let mut left = border;
    while let Some(Reverse((bits, at))) = open.pop() {
        let (cost, here) = (f64::from_bits(bits), at as usize);
        if cost > costs[here] {
            continue;
        }
        let between = here < border && at != from;
        if here < border {
            left -= 1;
            if between && !made_of_others[here] {
                found.push((at, cost));
            }
            if left == 0 {
                break;
            }
        }
        for &(next, step) in &roads[here] {
            let (to, cost_there) = (next as usize, cost + step);
            if cost_there < costs[to] {
                costs[to] = cost_there;
                made_of_others[to] = made_of_others[here] || (between && cost > clear && step > clear);
                open.push(Reverse((cost_there.to_bits(), next)));
            }
        }
    }
    found
}

#[cfg(test)]
mod tests;
