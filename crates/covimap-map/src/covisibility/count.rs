//! Counting: from steps to `n_i` and `n_ij`.
//!
//! The log is transposed, so that each landmark knows its steps. The row of a landmark is then
//! counted in a dense array of N counters, which is the only place where N counters exist: one
//! array a worker, never N x N.
//!
//! Both `n_ij` and `n_ji` are counted. Counting one and mirroring it would save additions, but
//! additions are cheap: the mirror image of a large matrix is written to places all over the
//! memory, which takes longer than counting.

use std::ops::Range;

use rayon::prelude::*;

use super::CoVisibility;
use super::rows::{RowBlock, Rows};
use super::tally::Tally;
use crate::{MapError, Observer, SightingLog, Stage};

/// See [`CoVisibility::count`].
pub(super) fn count(log: &SightingLog, observer: &dyn Observer) -> Result<CoVisibility, MapError> {
    check_steps(log.steps())?;
    let landmarks = log.names().len();
    observer.started(Stage::Count, Some(landmarks as u64));
    let appearances = Appearances::new(log, pieces(log), observer)?;
    let sightings: Vec<u32> = (0..landmarks).into_par_iter().map(|i| appearances.count(i)).collect();
    let blocks = balanced_ranges(&sightings, TASKS)
        .into_par_iter()
        .map_init(
            || Tally::new(landmarks),
            |tally, rows| {
                check_interrupt(observer)?;
                let block = count_rows(log, &appearances, tally, rows.clone());
                observer.advanced(rows.len() as u64);
                Ok(block)
            },
        )
        .collect::<Result<Vec<_>, MapError>>()?;
    observer.finished(Stage::Count);
    Ok(CoVisibility { steps: log.steps() as u64, sightings, pairs: Rows::new(blocks) })
}

/// Steps are numbered and counted in 32 bits.
pub(super) fn check_steps(steps: usize) -> Result<(), MapError> {
    if u32::try_from(steps).is_err() { Err(MapError::TooManySteps { steps }) } else { Ok(()) }
}

fn check_interrupt(observer: &dyn Observer) -> Result<(), MapError> {
    if observer.interrupted() { Err(MapError::Interrupted) } else { Ok(()) }
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
/// and so many for each landmark, which keeps `starts` small beside `steps`.
const MIN_PIECE_PER_LANDMARK: usize = 8;

/// In how many pieces to transpose a log.
fn pieces(log: &SightingLog) -> usize {
    let smallest = MIN_PIECE.max(MIN_PIECE_PER_LANDMARK * log.names().len());
    (log.sightings() / smallest).clamp(1, 4 * rayon::current_num_threads())
}

impl Appearances {
    fn new(log: &SightingLog, pieces: usize, observer: &dyn Observer) -> Result<Self, MapError> {
        let cut = |piece: usize| log.steps() * piece / pieces;
        let transpose = |piece: usize| {
            check_interrupt(observer)?;
            Ok(Piece::new(log, cut(piece)..cut(piece + 1)))
        };
        let pieces = (0..pieces).into_par_iter().map(transpose).collect::<Result<_, MapError>>()?;
        Ok(Self { pieces })
    }

    /// `n_i`.
    fn count(&self, landmark: usize) -> u32 {
        let count: usize = self.pieces.iter().map(|piece| piece.steps(landmark).len()).sum();
        u32::try_from(count).expect("steps were checked (bug in covimap)")
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
            let number = u32::try_from(step).expect("steps were checked (bug in covimap)");
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

/// `n_ij` of all j, for a range of i.
fn count_rows(
    log: &SightingLog,
    appearances: &Appearances,
    tally: &mut Tally,
    rows: Range<usize>,
) -> RowBlock {
    let mut block = RowBlock::new(rows.start);
    for row in rows {
        for piece in &appearances.pieces {
            for group in piece.steps(row).chunks(GROUP) {
                add_steps(log, group, tally);
            }
        }
        tally.drain(|partner, count| {
            if partner as usize != row {
                block.push(partner, count);
            }
        });
        block.end_row();
    }
    block.finish()
}

/// Counts the landmarks of a group of steps.
///
/// The steps of a landmark are strewn over the log, so most of the time goes into waiting for
/// memory. Finding all steps first, and looking at the begin of each, lets these waits overlap.
fn add_steps(log: &SightingLog, group: &[u32], tally: &mut Tally) {
    let mut steps: [&[u32]; GROUP] = [&[]; GROUP];
    for (slot, &step) in steps.iter_mut().zip(group) {
        *slot = log.step(step as usize);
    }
    let touch = steps.iter().fold(0, |all, step| all ^ step.first().copied().unwrap_or(0));
    std::hint::black_box(touch);
    for &landmark in steps.into_iter().flatten() {
        tally.add(landmark);
    }
}

/// Steps visited at once.
const GROUP: usize = 32;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Silent;

    #[test]
    fn a_landmark_knows_its_steps_however_many_pieces_there_are() {
        let steps: Vec<Vec<String>> = (0..50)
            .map(|t| (0..7).filter(|id| t % (id + 1) == 0).map(|id| id.to_string()).collect())
            .collect();
        let log = SightingLog::from_steps(&steps);
        for pieces in [1, 2, 3, 50, 60] {
            let appearances = Appearances::new(&log, pieces, &Silent).unwrap();
            for landmark in 0..7 {
                let found: Vec<u32> =
                    appearances.pieces.iter().flat_map(|piece| piece.steps(landmark)).copied().collect();
                // Landmark i is seen at every (i + 1)-th step.
                let every: Vec<u32> = (0..50).step_by(landmark + 1).collect();
                assert_eq!(found, every);
                assert_eq!(appearances.count(landmark) as usize, every.len());
            }
        }
    }

    #[test]
    fn ranges_of_about_the_same_weight_cover_everything_once() {
        assert_eq!(balanced_ranges(&[], 4), []);
        assert_eq!(balanced_ranges(&[0, 0, 0], 4), vec![0..3; 1]);
        // 12 in all, so that a range ends when it has 12 / 3 + 1 = 5.
        assert_eq!(balanced_ranges(&[1, 1, 4, 3, 2, 1], 3), [0..3, 3..5, 5..6]);
        assert_eq!(balanced_ranges(&[9, 1, 1], 4), [0..1, 1..3]);
    }

    #[test]
    fn steps_are_counted_in_32_bits() {
        assert!(check_steps(u32::MAX as usize).is_ok());
        let error = check_steps(1 << 32).unwrap_err();
        assert!(matches!(error, MapError::TooManySteps { .. }));
        assert_eq!(
            error.to_string(),
            "the log has 4294967296 steps, at most 4294967295 can be counted; split it"
        );
    }
}
