//! Counting: from steps to `n_i` and `n_ij`.
//!
//! The log is transposed, so that each landmark knows its steps. The row of a landmark is then
//! counted in a dense array of N counters, which is the only place where N counters exist: one
//! array a worker, never N x N. Steps are ascending, so the partners below a landmark are the
//! begin of each of its steps; the partners above follow by symmetry.

use std::ops::Range;

use rayon::prelude::*;

use super::CoVisibility;
use super::symmetric::{LowerRows, symmetric};
use crate::{MapError, Observer, SightingLog, Stage};

/// See [`CoVisibility::count`].
pub(super) fn count(log: &SightingLog, observer: &dyn Observer) -> Result<CoVisibility, MapError> {
    let landmarks = log.names().len();
    observer.started(Stage::Count, Some(landmarks as u64));
    let appearances = Appearances::new(log);
    let sightings: Vec<u32> = (0..landmarks).into_par_iter().map(|i| appearances.count(i)).collect();
    let rows = balanced_ranges(&sightings, TASKS);
    let lower = rows
        .into_par_iter()
        .map_init(
            || RowCounter::new(landmarks),
            |counter, rows| {
                if observer.interrupted() {
                    return Err(MapError::Interrupted);
                }
                let lower = counter.rows(log, &appearances, rows.clone());
                observer.advanced(rows.len() as u64);
                Ok(lower)
            },
        )
        .collect::<Result<Vec<_>, _>>()?;
    drop(appearances);
    let (starts, partners, together) = symmetric(landmarks, &lower);
    observer.finished(Stage::Count);
    Ok(CoVisibility { steps: log.steps() as u64, sightings, starts, partners, together })
}

/// Rows are counted in about so many tasks, each of them short enough to be interrupted.
const TASKS: usize = 256;

/// Cuts `0..weights.len()` into at most `count` ranges of about the same weight.
fn balanced_ranges(weights: &[u32], count: usize) -> Vec<Range<usize>> {
    let total: u64 = weights.iter().map(|&weight| u64::from(weight)).sum();
    let share = total / count as u64 + 1;
    let (mut ranges, mut start, mut weight) = (Vec::new(), 0, 0);
    for (index, &more) in weights.iter().enumerate() {
        weight += u64::from(more);
        if weight >= share || index + 1 == weights.len() {
            ranges.push(start..index + 1);
            (start, weight) = (index + 1, 0);
        }
    }
    ranges
}

/// The transposed log: the steps of each landmark, ascending.
///
/// It is made in pieces, each of a stretch of the log, so that the pieces can be made in parallel.
struct Appearances {
    pieces: Vec<Piece>,
}

struct Piece {
    /// Landmark i: `starts[i]..starts[i + 1]` of `steps`.
    starts: Vec<usize>,
    steps: Vec<u32>,
}

/// A piece has at least so many sightings,
const MIN_PIECE: usize = 1 << 20;
/// and so many a landmark, which keeps `starts` small beside `steps`.
const MIN_PIECE_PER_LANDMARK: usize = 8;

impl Appearances {
    fn new(log: &SightingLog) -> Self {
        let smallest = MIN_PIECE.max(MIN_PIECE_PER_LANDMARK * log.names().len());
        let count = (log.sightings() / smallest).clamp(1, 4 * rayon::current_num_threads());
        let cut = |piece: usize| log.steps() * piece / count;
        let pieces = (0..count).into_par_iter().map(|piece| Piece::new(log, cut(piece)..cut(piece + 1)));
        Self { pieces: pieces.collect() }
    }

    /// `n_i`.
    fn count(&self, landmark: usize) -> u32 {
        let count: usize = self.pieces.iter().map(|piece| piece.steps(landmark).len()).sum();
        u32::try_from(count).expect("a log has fewer than 2^32 steps (bug in covimap)")
    }
}

impl Piece {
    fn new(log: &SightingLog, stretch: Range<usize>) -> Self {
        let mut starts = vec![0; log.names().len() + 1];
        for step in stretch.clone() {
            for &landmark in log.step(step) {
                starts[landmark as usize + 1] += 1;
            }
        }
        for landmark in 1..starts.len() {
            starts[landmark] += starts[landmark - 1];
        }
        let mut steps = vec![0; starts[starts.len() - 1]];
        let mut next = starts.clone();
        for step in stretch {
            let number = u32::try_from(step).expect("a log has fewer than 2^32 steps (bug in covimap)");
            for &landmark in log.step(step) {
                let place = &mut next[landmark as usize];
                steps[*place] = number;
                *place += 1;
            }
        }
        Self { starts, steps }
    }

    fn steps(&self, landmark: usize) -> &[u32] {
        &self.steps[self.starts[landmark]..self.starts[landmark + 1]]
    }
}

/// Counts rows; all counters are 0 between two rows.
struct RowCounter {
    counters: Vec<u32>,
    /// Landmarks whose counter is not 0.
    touched: Vec<u32>,
}

impl RowCounter {
    fn new(landmarks: usize) -> Self {
        Self { counters: vec![0; landmarks], touched: Vec::new() }
    }

    /// `n_ij` of all j < i, for a range of i.
    fn rows(&mut self, log: &SightingLog, appearances: &Appearances, rows: Range<usize>) -> LowerRows {
        let mut lower = LowerRows::new(rows.start);
        for row in rows {
            let steps = appearances.pieces.iter().flat_map(|piece| piece.steps(row));
            for &step in steps {
                self.add(log.step(step as usize), row);
            }
            self.touched.sort_unstable();
            for &partner in &self.touched {
                lower.push(partner, std::mem::take(&mut self.counters[partner as usize]));
            }
            self.touched.clear();
            lower.end_row();
        }
        lower
    }

    /// Counts the landmarks of a step below `row`.
    fn add(&mut self, step: &[u32], row: usize) {
        for &partner in step.iter().take_while(|&&partner| (partner as usize) < row) {
            let counter = &mut self.counters[partner as usize];
            if *counter == 0 {
                self.touched.push(partner);
            }
            *counter += 1;
        }
    }
}
