//! A robot on the move: the places of one look after the other, joined by what it can have moved.
//!
//! The places are the cells of a grid over the charts, a fifth of a range wide. Before a look the belief `b` is
//! spread out by a normal step, and a small share of it over the whole map, for a robot that was carried away
//! or never was where it seemed; after it, it is weighed by the look (forward algorithm of a hidden Markov
//! model):
//!
//! `b'(y) ~ L(y) ((1 - j) sum_z N(y - z; m^2) b(z) + j / area)`  (2)
//!
//! A look that fits two places leaves both in the belief; the looks that follow decide. What looks the same in
//! two places is therefore no trouble as long as the ways there differ.
//!
//! # Complexity
//! `O(c (k + m))` a look, `c` cells of the belief, `k` landmarks near and `m` cells that a step spans. After many looks that
//! show nothing, `c` grows to the cells within two ranges of any landmark, 25 for every square range.

use std::sync::Arc;

use covimap_embed::Point;

use super::modes::{COARSE, Cell, Patch, QUALITIES, cells_around, modes, of_any_quality};
use super::{Localiser, Location, Look, distance};
use crate::PlanError;

/// Cells below this share of the best one are dropped.
const NEGLIGIBLE: f64 = 1e-7;
/// Width of the tiles in which looks are judged, in cells: a tile and its corners lie within [`PLACES`]
/// ranges of its middle.
const TILE: i64 = 6;
/// Places further than this from every landmark, in ranges, are off the map.
const ON_MAP: f64 = 2.0;
/// Steps longer than this many standard deviations are left to the jumps.
const FARTHEST: f64 = 3.0;

/// How a robot moves between two looks.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct TrackParams {
    /// Standard deviation of each coordinate of a step, as a share of the visibility range, in `(0, 3]`.
    /// Default 0.3.
    pub step: f64,
    /// Probability of being somewhere else altogether, in `(0, 1)`. Default 0.001.
    pub jump: f64,
}

impl Default for TrackParams {
    fn default() -> Self {
        Self { step: 0.3, jump: 1e-3 }
    }
}

/// A cell of a chart with the probability of being in it.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Belief {
    component: u32,
    at: [i64; 2],
    mass: f64,
}

/// Follows a robot from look to look.
#[derive(Debug, Clone)]
pub struct Tracker {
    localiser: Arc<Localiser>,
    params: TrackParams,
    /// By component and cell; sums to 1, or is empty before the first look.
    belief: Vec<Belief>,
}

impl Tracker {
    /// Knows nothing of where the robot is.
    ///
    /// # Errors
    /// [`PlanError::BadParameter`] for one out of its range.
    pub fn new(localiser: Arc<Localiser>, params: TrackParams) -> Result<Self, PlanError> {
        let bad = |name, value, wanted| Err(PlanError::BadParameter { name, value, wanted });
        if !(params.step > 0.0 && params.step <= 3.0) {
            return bad("track.step", params.step, "more than 0 and at most 3 ranges");
        }
        if !(params.jump > 0.0 && params.jump < 1.0) {
            return bad("track.jump", params.jump, "a probability between 0 and 1");
        }
        Ok(Self { localiser, params, belief: Vec::new() })
    }

    /// Takes in the next look and tells where the robot is, given this look and all before.
    pub fn update(&mut self, look: &Look) -> Location {
        let mut belief = self.spread();
        self.add_jumps(&mut belief, look);
        let logs = self.judge(&belief, look);
        let best = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let mut evidence = 0.0;
        for (cell, log) in belief.iter_mut().zip(&logs) {
            cell.mass = (log - best).exp();
            evidence += cell.mass;
        }
        belief.retain(|cell| cell.mass > NEGLIGIBLE);
        let kept: f64 = belief.iter().map(|cell| cell.mass).sum();
        for cell in &mut belief {
            cell.mass /= kept;
        }
        self.belief = belief;
        self.localiser.location(look, modes(&self.patches()), best + evidence.ln())
    }

    /// Forgets everything.
    pub fn reset(&mut self) {
        self.belief.clear();
    }

    fn side(&self, component: u32) -> f64 {
        COARSE * self.localiser.sensing().sensor(component).range
    }

    /// The belief after a step, without the jumps: along x, then along y.
    fn spread(&self) -> Vec<Belief> {
        let deviation = self.params.step / COARSE;
        let reach = (FARTHEST * deviation).ceil() as i32;
        let weight = |k: i32| (-0.5 * (f64::from(k) / deviation).powi(2)).exp();
        let total: f64 = (-reach..=reach).map(weight).sum();
        let mut belief = self.belief.clone();
        for axis in 0..2 {
            let step = |cell: &Belief| {
                let cell = *cell;
                (-reach..=reach).map(move |k| {
                    let mut moved = cell;
                    moved.at[axis] += i64::from(k);
                    moved.mass *= weight(k) / total;
                    moved
                })
            };
            belief = merged(belief.iter().flat_map(step).collect());
        }
        // The prior is over the charts: a robot does not leave the map.
        belief.retain(|cell| self.is_on_map(cell));
        let kept: f64 = belief.iter().map(|cell| cell.mass).sum();
        for cell in &mut belief {
            cell.mass *= (1.0 - self.params.jump) / kept;
        }
        belief
    }

    /// Whether a landmark is in reach of a cell.
    fn is_on_map(&self, cell: &Belief) -> bool {
        let side = self.side(cell.component);
        let (place, reach) = (cell.at.map(|c| c as f64 * side), ON_MAP / COARSE * side);
        let placed = self.localiser.index.map().landmarks();
        let near = self.localiser.surroundings.around(cell.component, place, reach);
        near.into_iter().any(|id| distance(placed[id.index()].position, place) <= reach)
    }

    /// Adds the places that the look speaks for, wherever they are, with the probability of a jump there.
    fn add_jumps(&self, belief: &mut Vec<Belief>, look: &Look) {
        let jump = if belief.is_empty() { 1.0 } else { self.params.jump };
        let mass = jump * COARSE * COARSE / self.localiser.area;
        let mut landed: Vec<Belief> = Vec::new();
        for (component, middle) in self.localiser.crowds(&look.candidates()) {
            let cells = cells_around(middle, self.side(component));
            landed.extend(cells.map(|at| Belief { component, at, mass }));
        }
        // Discs may overlap: a place is landed on once.
        landed.sort_unstable_by_key(|cell| (cell.component, cell.at));
        landed.dedup_by_key(|cell| (cell.component, cell.at));
        belief.extend(landed);
        *belief = merged(std::mem::take(belief));
    }

    /// `ln (L(y) b(y))` of every cell.
    fn judge(&self, belief: &[Belief], look: &Look) -> Vec<f64> {
        let tile = |cell: &Belief| (cell.component, cell.at.map(|c| c.div_euclid(TILE)));
        let mut order: Vec<usize> = (0..belief.len()).collect();
        order.sort_by_key(|&k| tile(&belief[k]));
        let mut logs = vec![f64::NEG_INFINITY; belief.len()];
        let qualities = QUALITIES.map(|(quality, _)| quality);
        for cells in order.chunk_by(|&a, &b| tile(&belief[a]) == tile(&belief[b])) {
            let (component, tile) = tile(&belief[cells[0]]);
            let side = self.side(component);
            let centre = tile.map(|c| ((c * TILE) as f64 + (TILE - 1) as f64 / 2.0) * side);
            let sight = self.localiser.sight(look, component, centre);
            for &k in cells {
                let place: Point = belief[k].at.map(|c| c as f64 * side);
                let seen_from_here = sight.log_likelihoods(place, qualities, side / 4.0);
                logs[k] = of_any_quality(seen_from_here) + belief[k].mass.ln();
            }
        }
        logs
    }

    /// The belief as patches, one a component.
    fn patches(&self) -> Vec<Patch> {
        let patch = |cells: &[Belief]| {
            let component = cells[0].component;
            let cells = cells.iter().map(|cell| Cell { at: cell.at, log: cell.mass.ln() }).collect();
            Patch::of_cells(component, self.side(component), cells)
        };
        self.belief.chunk_by(|a, b| a.component == b.component).map(patch).collect()
    }
}

/// The cells in order, equal ones added up.
fn merged(mut cells: Vec<Belief>) -> Vec<Belief> {
    cells.sort_by_key(|cell| (cell.component, cell.at));
    let mut sum: Vec<Belief> = Vec::with_capacity(cells.len());
    for cell in cells {
        match sum.last_mut() {
            Some(last) if (last.component, last.at) == (cell.component, cell.at) => last.mass += cell.mass,
            _ => sum.push(cell),
        }
    }
    sum
}

#[cfg(test)]
mod tests;
