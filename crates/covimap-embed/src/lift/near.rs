//! Pairs that no list names, and that are nearer to each other than they seem to be.

use rayon::prelude::*;

use super::springs::{Spring, Springs};
use super::{Apart, BELIEVED, Lifted, length};

/// Pairs count as near up to so many times their bound: steps bring them nearer before they are looked for again.
pub(super) const AHEAD: f64 = 1.3;

/// The bounds of the pairs that are near and not among the links.
///
/// Objects are sorted into square cells, as wide as the longest bound reaches, by the plane of the map.
pub(super) fn too_near(x: &[Lifted], links: &Springs, apart: &impl Apart) -> Springs {
    let wide = AHEAD * apart.longest();
    if !(wide > 0.0 && wide.is_finite()) {
        return Springs::none(x.len());
    }
    let cell = |point: &Lifted| [0, 1].map(|axis| (point[axis] / wide).floor() as i64);
    let mut sorted: Vec<([i64; 2], u32)> = (0..).zip(x).map(|(own, point)| (cell(point), own)).collect();
    sorted.par_sort_unstable();
    let row = |own: usize| {
        let here = x[own];
        let [column, line] = cell(&here);
        let mut row: Vec<Spring> = Vec::new();
        for column in column - 1..=column + 1 {
            let from = sorted.partition_point(|&(cell, _)| cell < [column, line - 1]);
            let around = sorted[from..].iter().take_while(|&&(cell, _)| cell <= [column, line + 1]);
            for &(_, to) in around.filter(|&&(_, to)| to as usize != own) {
                let r = length(here, x[to as usize]);
                if r >= wide || links.of(own).binary_search_by_key(&to, |link| link.to).is_ok() {
                    continue;
                }
                let bound = apart.bound(own as u32, to);
                if r < AHEAD * bound.distance {
                    let (length, weight) = (bound.distance as f32, (BELIEVED * bound.weight) as f32);
                    row.push(Spring { to, length, weight });
                }
            }
        }
        row.sort_unstable_by_key(|spring| spring.to);
        row
    };
    let rows: Vec<Vec<Spring>> = (0..x.len()).into_par_iter().map(row).collect();
    Springs::of_rows(rows.iter().map(Vec::len).sum(), rows.into_iter())
}
