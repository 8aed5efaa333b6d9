//! Branches and hinges: what of a map's handedness the log decides, and what is a guess.
//!
//! Regions that seams of sure handedness tie together, directly or through others, make a *branch*: within
//! one, left and right are known. Where two branches meet, the evidence of every seam is weak: a *hinge*, and
//! each side of it may be the mirror image of what the map shows. Evidence of several seams over one hinge
//! is not added up: they rest on the same few landmarks.
//!
//! # Complexity
//! `O(s log s)` for `s` seams.

use std::cmp::Reverse;

use covimap_embed::{EdgeReport, Estimate};
use petgraph::unionfind::UnionFind;

use super::seams::Seam;
use crate::{Hinge, RegionCover, SeamReport, SeamsReport};

/// Log-likelihood ratio from which on a side is sure. Local maps that are folded give false evidence, up to
/// about 20 in corridors as narrow as the sensor sees far; elsewhere that of right sides is several times this.
pub(crate) const SURE: f64 = 30.0;
/// Trust below which a seam counts as dropped.
const DROPPED: f64 = 0.01;

/// The branch of every region, and the report on all seams, of which the fits `used` were taken.
pub(super) fn find(
    cover: &RegionCover,
    seams: &[Seam],
    used: &[usize],
    edges: &[EdgeReport],
) -> (Vec<u32>, SeamsReport) {
    let reports = seams.iter().zip(used).zip(edges).map(|((seam, &used), edge)| report(seam, used, edge));
    let reports: Vec<SeamReport> = reports.collect();
    let (dropped, mut used): (Vec<SeamReport>, Vec<SeamReport>) =
        reports.into_iter().partition(|seam| seam.trust < DROPPED);
    used.sort_by(|a, b| b.evidence.total_cmp(&a.evidence).then(a.regions.cmp(&b.regions)));
    let mut parts = UnionFind::<u32>::new(cover.regions().len());
    let mut landmarks: Vec<u32> = cover.regions().iter().map(|region| region.core.len() as u32).collect();
    let mut branch_of = None;
    let mut hinges = Vec::new();
    for seam in used {
        let ends = seam.regions.map(|region| parts.find(region));
        if ends[0] == ends[1] {
            continue;
        }
        if seam.evidence < SURE {
            branch_of.get_or_insert_with(|| by_size(&parts, &landmarks));
            let [a, b] = ends.map(|end| landmarks[end as usize]);
            hinges.push(Hinge { seam, landmarks: a.min(b) });
        }
        parts.union(ends[0], ends[1]);
        landmarks[parts.find(ends[0]) as usize] = ends.iter().map(|&end| landmarks[end as usize]).sum();
    }
    let branch_of = branch_of.unwrap_or_else(|| by_size(&parts, &landmarks));
    (branch_of, SeamsReport { count: seams.len() as u64, dropped, hinges })
}

fn report(seam: &Seam, used: usize, edge: &EdgeReport) -> SeamReport {
    let sign = if used == seam.fit_of(Estimate::Given) { 1.0 } else { -1.0 };
    SeamReport {
        regions: [seam.a, seam.b],
        shared: seam.shared as u32,
        residual: seam.misfit[used],
        condition: seam.condition,
        evidence: sign * seam.evidence.abs(),
        trust: edge.trust,
    }
}

/// Numbers the parts, that with most landmarks first, equal ones by their first region.
fn by_size(parts: &UnionFind<u32>, landmarks: &[u32]) -> Vec<u32> {
    let part_of: Vec<u32> = (0..landmarks.len() as u32).map(|region| parts.find(region)).collect();
    let mut order: Vec<u32> = Vec::new();
    let mut known = vec![false; landmarks.len()];
    for &part in &part_of {
        if !std::mem::replace(&mut known[part as usize], true) {
            order.push(part);
        }
    }
    order.sort_by_key(|&part| Reverse(landmarks[part as usize]));
    let mut number = vec![0; landmarks.len()];
    for (rank, &part) in order.iter().enumerate() {
        number[part as usize] = rank as u32;
    }
    part_of.iter().map(|&part| number[part as usize]).collect()
}

#[cfg(test)]
mod tests;
