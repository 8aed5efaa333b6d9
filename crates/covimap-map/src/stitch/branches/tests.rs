use covimap_embed::Similarity;

use super::*;

/// A seam of this evidence for the regions `a` and `b`, and what became of it.
fn seam(a: u32, b: u32, evidence: f64) -> (Seam, EdgeReport) {
    let a_from_b = [Similarity::IDENTITY; 2];
    let seam = Seam { a, b, a_from_b, misfit: [0.1, 0.2], evidence, shared: 7, condition: 0.5 };
    (seam, edge(Estimate::Given, 1.0))
}

fn edge(used: Estimate, trust: f64) -> EdgeReport {
    EdgeReport { used, trust, bridge: false, rotation: 0.0, log_scale: 0.0, shift: 0.0 }
}

/// Regions of so many core landmarks each.
fn cover(sizes: &[usize]) -> RegionCover {
    let mut next = 0;
    let members: Vec<Vec<u32>> = sizes
        .iter()
        .map(|&size| {
            next += size as u32;
            (next - size as u32..next).collect()
        })
        .collect();
    let members: Vec<&[u32]> = members.iter().map(Vec::as_slice).collect();
    RegionCover::of_members(next as usize, &members)
}

fn found(sizes: &[usize], seams: Vec<(Seam, EdgeReport)>) -> (Vec<u32>, SeamsReport) {
    let (seams, edges): (Vec<_>, Vec<_>) = seams.into_iter().unzip();
    let used: Vec<usize> = seams.iter().zip(&edges).map(|(seam, edge)| seam.fit_of(edge.used)).collect();
    find(&cover(sizes), &seams, &used, &edges)
}

#[test]
fn sure_seams_make_one_branch() {
    // The weak seam 0-2 is no hinge: 2 is tied to 0 by way of 1.
    let (branches, report) =
        found(&[3, 4, 5], vec![seam(0, 1, SURE), seam(0, 2, 1.0), seam(1, 2, -2.0 * SURE)]);
    assert_eq!(branches, [0, 0, 0]);
    assert_eq!((report.count, report.dropped.len(), report.hinges.len()), (3, 0, 0));
}

#[test]
fn a_chain_with_two_weak_seams_has_three_branches() {
    // Regions of 3, 9, 2 and 4 landmarks; 1 and 3 hang together. The likelier hinge comes first and joins
    // the part {0} of 3 to {1, 3} of 13; the next one joins {2} of 2 to the rest.
    let seams = vec![seam(0, 1, 20.0), seam(1, 3, 99.0), seam(2, 3, -5.0), seam(0, 2, 4.0)];
    let (branches, report) = found(&[3, 9, 2, 4], seams);
    assert_eq!(branches, [1, 0, 2, 0]);
    let hinges: Vec<_> = report
        .hinges
        .iter()
        .map(|h| (h.seam.regions, h.seam.evidence, h.seam.residual, h.landmarks))
        .collect();
    // The evidence of 2-3 is for the mirrored fit, whose misfit is 0.2.
    assert_eq!(hinges, [([0, 1], 20.0, 0.1, 3), ([2, 3], 5.0, 0.2, 2)]);
}

#[test]
fn evidence_against_the_side_that_the_map_took_makes_no_branch() {
    let (seam, _) = seam(0, 1, 50.0);
    let (branches, report) = found(&[3, 3], vec![(seam, edge(Estimate::Alternative, 1.0))]);
    assert_eq!(branches, [0, 1]);
    assert_eq!((report.hinges[0].seam.evidence, report.hinges[0].seam.residual), (-50.0, 0.2));
}

#[test]
fn seams_left_out_are_listed_and_tie_nothing() {
    let mut out = seam(0, 1, 90.0);
    out.1 = edge(Estimate::Neither, 0.0);
    let (branches, report) = found(&[3, 3, 3], vec![out, seam(0, 2, 40.0), seam(1, 2, 10.0)]);
    assert_eq!(branches, [0, 1, 0]);
    assert_eq!((report.dropped.len(), report.dropped[0].regions), (1, [0, 1]));
    assert_eq!(report.hinges.len(), 1);
}

#[test]
fn one_region_and_regions_without_seams() {
    assert_eq!(found(&[5], vec![]), (vec![0], SeamsReport::default()));
    assert_eq!(found(&[2, 7], vec![]).0, [1, 0]);
}
