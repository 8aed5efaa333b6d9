//! The posterior on a grid, coarse first and fine where it matters, and its modes.

use covimap_embed::Point;

use super::sight::{PLACES, Sight};

/// Side of a coarse cell, as a share of the range.
pub(super) const COARSE: f64 = 0.2;
/// Qualities of a look and their priors.
pub(super) const QUALITIES: [(f64, f64); 4] = [(1.0, 0.94), (0.5, 0.03), (0.25, 0.02), (0.1, 0.01)];
/// Logarithm below the best that a coarse cell may be and still be cut.
const WORTH_CUTTING: f64 = 10.0;
/// Fine cells that are taken at most, about.
const FINE_CELLS: usize = 1000;
/// Most pieces on a side into which a coarse cell is cut.
const MOST_PIECES: i64 = 4;
/// Share of the posterior that may be left out.
const LEFT_OUT: f64 = 1e-3;

/// One place where a robot may be.
#[derive(Debug, Clone, PartialEq)]
pub struct Mode {
    /// Probability of this mode among all.
    pub probability: f64,
    /// Mean of the place, units of the map, in the chart of the component.
    pub position: Point,
    /// Covariance of the place, `xx`, `xy`, `yy`, in squares of units of the map.
    pub covariance: [f64; 3],
    /// Component in whose chart it lies.
    pub component: u32,
}

impl Mode {
    /// Squared Mahalanobis distance of a point of the same chart: below 5.99 within the 95 % region.
    #[must_use]
    pub fn squared_distance(&self, point: Point) -> f64 {
        let [dx, dy] = [point[0] - self.position[0], point[1] - self.position[1]];
        let [xx, xy, yy] = self.covariance;
        (yy * dx * dx - 2.0 * xy * dx * dy + xx * dy * dy) / (xx * yy - xy * xy)
    }
}

/// A fine cell: column, row, and the logarithm of likelihood times area in squares of the range.
pub(super) struct Cell {
    pub at: [i64; 2],
    pub log: f64,
}

/// The cells of a grid over a chart, `side` wide, whose middles lie within [`PLACES`] ranges of a place.
pub(super) fn cells_around(middle: Point, side: f64) -> impl Iterator<Item = [i64; 2]> {
    let half = (PLACES / COARSE).ceil() as i64;
    let centre = middle.map(|c| (c / side).round() as i64);
    let all = (-half..=half).flat_map(move |x| (-half..=half).map(move |y| [centre[0] + x, centre[1] + y]));
    all.filter(move |at| super::distance(at.map(|c| c as f64 * side), middle) <= PLACES / COARSE * side)
}

/// Logarithm of the likelihood of a look of unknown quality, by those of looks of each of [`QUALITIES`].
pub(super) fn of_any_quality(logs: [f64; QUALITIES.len()]) -> f64 {
    let mut with_prior = logs;
    with_prior.iter_mut().zip(QUALITIES).for_each(|(log, (_, prior))| *log += f64::ln(prior));
    log_sum(&with_prior)
}

/// The posterior over places of one chart.
pub(super) struct Patch {
    component: u32,
    /// Place of cell (0, 0).
    origin: Point,
    /// Side of a fine cell.
    side: f64,
    /// By column, then row.
    cells: Vec<Cell>,
}

impl Patch {
    /// Takes the posterior around the middles of crowds of one component. A place that is near several of them is judged by the
    /// sight of the first.
    pub fn around(component: u32, crowds: &[(Sight, Point)]) -> Self {
        let range = crowds[0].0.range;
        let side = COARSE * range;
        let mut coarse: Vec<([i64; 2], usize)> = Vec::new();
        for (crowd, &(_, middle)) in crowds.iter().enumerate() {
            coarse.extend(cells_around(middle, side).map(|at| (at, crowd)));
        }
        coarse.sort_unstable();
        coarse.dedup_by_key(|cell| cell.0);
        let log = |crowd: usize, place: Point, blur: f64| {
            let qualities = QUALITIES.map(|(quality, _)| quality);
            of_any_quality(crowds[crowd].0.log_likelihoods(place, qualities, blur))
        };
        let logs: Vec<f64> =
            coarse.iter().map(|&(at, crowd)| log(crowd, at.map(|c| c as f64 * side), side / 4.0)).collect();
        let best = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let cut: Vec<([i64; 2], usize)> = coarse
            .into_iter()
            .zip(logs)
            .filter(|(_, log)| *log > best - WORTH_CUTTING)
            .map(|(cell, _)| cell)
            .collect();
        let pieces = ((FINE_CELLS as f64 / cut.len().max(1) as f64).sqrt() as i64).clamp(1, MOST_PIECES);
        let fine = side / pieces as f64;
        let log_area = 2.0 * (fine / range).ln();
        // Piece (0, 0) of cell (0, 0) has its middle half a cell, less half a piece, below the cell's.
        let origin = [0.5 * (fine - side); 2];
        let mut patch = Self { component, origin, side: fine, cells: Vec::new() };
        patch.cells.reserve(cut.len() * (pieces * pieces) as usize);
        for (at, crowd) in cut {
            for [dx, dy] in (0..pieces).flat_map(|x| (0..pieces).map(move |y| [x, y])) {
                let at = [at[0] * pieces + dx, at[1] * pieces + dy];
                let log = log(crowd, patch.place(at), 0.0) + log_area;
                patch.cells.push(Cell { at, log });
            }
        }
        patch.cells.sort_unstable_by_key(|cell| cell.at);
        patch
    }

    /// A posterior that is known already, by cells of a grid over the whole chart.
    pub fn of_cells(component: u32, side: f64, cells: Vec<Cell>) -> Self {
        Self { component, origin: [0.0; 2], side, cells }
    }

    /// Logarithm of the integral of the likelihood over the patch, in squares of the range.
    pub fn log_evidence(&self) -> f64 {
        let logs: Vec<f64> = self.cells.iter().map(|cell| cell.log).collect();
        log_sum(&logs)
    }

    fn place(&self, at: [i64; 2]) -> Point {
        [0, 1].map(|axis| self.origin[axis] + at[axis] as f64 * self.side)
    }

    /// Number of the piece of every cell above the floor; cells that touch, corners included, belong together.
    fn pieces_above(&self, floor: f64) -> Vec<Option<usize>> {
        let mut piece: Vec<Option<usize>> = vec![None; self.cells.len()];
        let mut pieces = 0;
        for first in 0..self.cells.len() {
            if piece[first].is_some() || self.cells[first].log <= floor {
                continue;
            }
            let mut open = vec![first];
            piece[first] = Some(pieces);
            while let Some(cell) = open.pop() {
                let [x, y] = self.cells[cell].at;
                for at in (x - 1..=x + 1).flat_map(|x| (y - 1..=y + 1).map(move |y| [x, y])) {
                    let Ok(next) = self.cells.binary_search_by_key(&at, |cell| cell.at) else { continue };
                    if piece[next].is_none() && self.cells[next].log > floor {
                        piece[next] = Some(pieces);
                        open.push(next);
                    }
                }
            }
            pieces += 1;
        }
        piece
    }
}

/// The modes of the posterior over all patches, the most likely first. What bends the chart is not in their covariances.
pub(super) fn modes(patches: &[Patch]) -> Vec<Mode> {
    let mut logs: Vec<f64> =
        patches.iter().flat_map(|patch| patch.cells.iter().map(|cell| cell.log)).collect();
    logs.sort_unstable_by(f64::total_cmp);
    let Some(&best) = logs.last() else { return Vec::new() };
    let total: f64 = logs.iter().map(|log| (log - best).exp()).sum();
    // The largest floor that leaves out no more than it may.
    let mut left_out = 0.0;
    let floor = logs.iter().copied().take_while(|log| {
        left_out += (log - best).exp();
        left_out <= LEFT_OUT * total
    });
    let floor = floor.last().unwrap_or(f64::NEG_INFINITY);
    let mut modes: Vec<Mode> = patches.iter().flat_map(|patch| modes_of(patch, floor, best)).collect();
    let kept: f64 = modes.iter().map(|mode| mode.probability).sum();
    for mode in &mut modes {
        mode.probability /= kept;
    }
    modes.sort_by(|a, b| b.probability.total_cmp(&a.probability));
    modes
}

/// The modes of a patch; probabilities are still masses over the density `exp(best)`.
fn modes_of(patch: &Patch, floor: f64, best: f64) -> Vec<Mode> {
    let piece = patch.pieces_above(floor);
    let count = piece.iter().flatten().max().map_or(0, |last| last + 1);
    let of = |number: usize| {
        let weighted = || {
            let cells = patch.cells.iter().zip(&piece).filter(move |(_, own)| **own == Some(number));
            cells.map(|(cell, _)| (patch.place(cell.at), (cell.log - best).exp()))
        };
        let mass: f64 = weighted().map(|(_, weight)| weight).sum();
        let mean = [0, 1].map(|axis| weighted().map(|(at, w)| w * at[axis]).sum::<f64>() / mass);
        let moment = |a: usize, b: usize| {
            weighted().map(|(at, w)| w * (at[a] - mean[a]) * (at[b] - mean[b])).sum::<f64>() / mass
        };
        // A cell is no point: it has a spread of its own.
        let own = patch.side * patch.side / 12.0;
        Mode {
            probability: mass,
            position: mean,
            covariance: [moment(0, 0) + own, moment(0, 1), moment(1, 1) + own],
            component: patch.component,
        }
    };
    (0..count).map(of).collect()
}

/// `ln sum exp`, minus infinity for nothing.
pub(super) fn log_sum(logs: &[f64]) -> f64 {
    let most = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if most == f64::NEG_INFINITY {
        most
    } else {
        most + logs.iter().map(|log| (log - most).exp()).sum::<f64>().ln()
    }
}
