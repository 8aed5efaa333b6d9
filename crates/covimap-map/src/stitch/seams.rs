//! Seams: how two overlapping local maps lie to each other, and how sure that is.
//!
//! The landmarks that two regions share fix the turn and the shift between their maps for either
//! handedness (Procrustes). Which handedness is right is the one decision that a later fit cannot
//! mend, and at a door the shared landmarks nearly lie on a line, where both fit alike. Links
//! that run from one region to the other without being shared help then: under the wrong
//! handedness their ends lie at the wrong distance. Both kinds of misfit are put together as the
//! log-likelihood ratio of two Gaussian models whose variance is estimated,
//!
//! `evidence = m/2 [ln(E_mirrored + s0^2) - ln(E_direct + s0^2)]`,
//!
//! `E` the mean squared misfit over the `m` shared landmarks and cross links, `s0` the least error
//! that local maps are believed to have.

use covimap_embed::{Correspondence, Estimate, Point, ProcrustesOptions, Reflection, Similarity, procrustes};
use rayon::prelude::*;

use crate::{LinkGraph, LocalMap, Observer, RegionCover};

/// Least error of a position in a local map, in map units: misfits below it say nothing.
const LEAST_ERROR: f64 = 0.02;
/// A turn is fixed by two shared landmarks at the least.
const LEAST_SHARED: usize = 2;

/// Where local map `b` lies in the frame of local map `a`.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Seam {
    pub a: u32,
    pub b: u32,
    /// The fit of equal handedness and the fit with `b` mirrored.
    pub a_from_b: [Similarity; 2],
    /// Root mean square misfit of either over shared landmarks and cross links, in map units.
    pub misfit: [f64; 2],
    /// Log-likelihood of equal over opposite handedness.
    pub evidence: f64,
    /// Landmarks in both regions.
    pub shared: usize,
    /// Least over greatest spread of the shared landmarks: 0 on a line.
    pub condition: f64,
}

impl Seam {
    /// Index into `a_from_b` of an estimate: the likelier fit is the given one.
    pub fn fit_of(&self, estimate: Estimate) -> usize {
        let likelier = usize::from(self.evidence < 0.0);
        if estimate == Estimate::Alternative { 1 - likelier } else { likelier }
    }
}

/// Place of a landmark in a region: `(region, index into its members)`.
type Places = Vec<Vec<(u32, u32)>>;

/// The seams of all pairs of regions that share enough landmarks, ascending.
pub(super) fn find(
    graph: &LinkGraph,
    cover: &RegionCover,
    maps: &[LocalMap],
    observer: &dyn Observer,
) -> Vec<Seam> {
    let places = places(graph.landmarks(), cover);
    (0..maps.len() as u32)
        .into_par_iter()
        .flat_map_iter(|a| {
            let shared = shared_with_later(cover, &places, a);
            let seams: Vec<Seam> = shared
                .chunk_by(|x, y| x.0 == y.0)
                .filter(|shared| shared.len() >= LEAST_SHARED)
                .filter_map(|shared| seam(graph, cover, maps, a, shared))
                .collect();
            observer.advanced(1);
            seams
        })
        .collect()
}

fn places(landmarks: usize, cover: &RegionCover) -> Places {
    let mut places = vec![Vec::new(); landmarks];
    for (region, members) in cover.regions().iter().map(|region| &region.members).enumerate() {
        for (index, &landmark) in members.iter().enumerate() {
            places[landmark as usize].push((region as u32, index as u32));
        }
    }
    places
}

/// `(b, place in a, place in b)` of every landmark that `a` shares with a later region, ascending.
fn shared_with_later(cover: &RegionCover, places: &Places, a: u32) -> Vec<(u32, u32, u32)> {
    let mut shared: Vec<(u32, u32, u32)> = cover.regions()[a as usize]
        .members
        .iter()
        .enumerate()
        .flat_map(|(in_a, &landmark)| {
            let later = places[landmark as usize].iter().filter(move |place| place.0 > a);
            later.map(move |&(b, in_b)| (b, in_a as u32, in_b))
        })
        .collect();
    shared.sort_unstable();
    shared
}

fn seam(
    graph: &LinkGraph,
    cover: &RegionCover,
    maps: &[LocalMap],
    a: u32,
    shared: &[(u32, u32, u32)],
) -> Option<Seam> {
    let b = shared[0].0;
    let pairs: Vec<Correspondence> = shared
        .iter()
        .map(|&(_, in_a, in_b)| Correspondence {
            source: maps[b as usize].points[in_b as usize],
            target: maps[a as usize].points[in_a as usize],
            weight: 1.0,
        })
        .collect();
    let fit = |reflection| procrustes(&pairs, ProcrustesOptions { scale: false, reflection }).ok();
    let (direct, mirrored) = (fit(Reflection::Forbid)?, fit(Reflection::Require)?);
    let a_from_b = [direct.target_from_source, mirrored.target_from_source];
    let (cross, links) = cross_misfit(graph, cover, maps, (a, b), &a_from_b);
    let count = (shared.len() + links) as f64;
    let mean = |rmse: f64, cross: f64| (rmse * rmse * shared.len() as f64 + cross) / count;
    let squares = [mean(direct.rmse, cross[0]), mean(mirrored.rmse, cross[1])];
    let floor = LEAST_ERROR * LEAST_ERROR;
    Some(Seam {
        a,
        b,
        a_from_b,
        misfit: squares.map(f64::sqrt),
        evidence: count / 2.0 * ((squares[1] + floor).ln() - (squares[0] + floor).ln()),
        shared: shared.len(),
        condition: flatness(pairs.iter().map(|pair| pair.target)),
    })
}

/// Least over greatest standard deviation of points along any direction, in `[0, 1]`; 0 for points on a line.
pub(crate) fn flatness(points: impl Iterator<Item = Point> + Clone) -> f64 {
    let count = points.clone().count() as f64;
    let mean = [0, 1].map(|axis| points.clone().map(|point| point[axis]).sum::<f64>() / count);
    let [mut xx, mut xy, mut yy] = [0.0; 3];
    for [x, y] in points.map(|point| [point[0] - mean[0], point[1] - mean[1]]) {
        xx += x * x;
        xy += x * y;
        yy += y * y;
    }
    // Eigenvalues of the scatter: half the trace, plus and minus the root.
    let (half, root) = (0.5 * (xx + yy), (0.5 * (xx - yy)).hypot(xy));
    if half > 0.0 { ((half - root).max(0.0) / (half + root)).sqrt() } else { 0.0 }
}

/// Summed squared misfit, under either fit, of the links from members of `a` alone to members of
/// `b` alone, and the number of these links.
fn cross_misfit(
    graph: &LinkGraph,
    cover: &RegionCover,
    maps: &[LocalMap],
    (a, b): (u32, u32),
    a_from_b: &[Similarity; 2],
) -> ([f64; 2], usize) {
    let (in_a, in_b) = (&cover.regions()[a as usize].members, &cover.regions()[b as usize].members);
    let mut squares = [0.0; 2];
    let mut links = 0;
    for (index, landmark) in
        in_a.iter().enumerate().filter(|(_, landmark)| in_b.binary_search(landmark).is_err())
    {
        let here = maps[a as usize].points[index];
        for link in graph.of(*landmark).iter().filter(|link| in_a.binary_search(&link.to).is_err()) {
            let Ok(place) = in_b.binary_search(&link.to) else { continue };
            links += 1;
            for (sum, fit) in squares.iter_mut().zip(a_from_b) {
                let there = fit.apply(maps[b as usize].points[place]);
                let length = (there[0] - here[0]).hypot(there[1] - here[1]);
                *sum += (length - link.distance).powi(2);
            }
        }
    }
    (squares, links)
}

#[cfg(test)]
mod tests;
