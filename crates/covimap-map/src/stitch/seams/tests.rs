use covimap_embed::Point;

use super::*;
use crate::LinkGraph;
use crate::fixtures::{distance, links_where};

/// Two regions of a graph, with their exact maps; the second one is mirrored where asked.
fn pair(
    truth: &[Point],
    regions: [&[u32]; 2],
    linked: impl Fn(usize, usize) -> bool,
    mirrored: bool,
) -> (LinkGraph, RegionCover, Vec<LocalMap>) {
    let graph = links_where(truth.len(), |i, j| linked(i, j).then(|| distance(truth[i], truth[j])));
    let cover = RegionCover::of_members(truth.len(), &regions);
    let sides = [1.0, if mirrored { -1.0 } else { 1.0 }];
    let maps = regions.iter().zip(sides).map(|(members, side)| LocalMap {
        points: members.iter().map(|&i| [truth[i as usize][0], side * truth[i as usize][1]]).collect(),
        stress1: 0.0,
    });
    (graph, cover, maps.collect())
}

#[test]
fn evidence_computed_by_hand() {
    // Landmarks 0 and 1 are shared and alike under both fits; 2 is in the first region, 3 in the second.
    let truth = [[0.0, 0.0], [1.0, 0.0], [0.5, 0.6], [0.5, 1.0]];
    let linked = |i: usize, j: usize| (i, j) != (0, 1);
    let (graph, cover, maps) = pair(&truth, [&[0, 1, 2], &[0, 1, 3]], linked, false);
    let seams = find(&graph, &cover, &maps, &crate::Silent);
    assert_eq!(seams.len(), 1);
    let seam = &seams[0];
    assert_eq!((seam.a, seam.b, seam.shared), (0, 1, 2));
    // Equal handedness leaves no misfit. Mirrored, 3 lies at (0.5, -1), 1.6 from 2 instead of 0.4: over
    // two shared landmarks and one link the mean square is 1.2^2 / 3 = 0.48.
    assert!(seam.misfit[0] < 1e-12 && (seam.misfit[1] - 0.48_f64.sqrt()).abs() < 1e-12, "{seam:?}");
    // 3/2 [ln(0.48 + 0.0004) - ln(0.0004)] = 1.5 * 7.0909098 = 10.636365.
    assert!((seam.evidence - 10.636_365).abs() < 1e-6, "{}", seam.evidence);
}

#[test]
fn a_mirrored_map_is_told_by_the_sign_of_the_evidence() {
    let truth = [[0.0, 0.0], [1.0, 0.0], [0.5, 0.6], [0.5, 1.0]];
    let members: [&[u32]; 2] = [&[0, 1, 2], &[0, 1, 3]];
    let evidence = |mirrored, linked: fn(usize, usize) -> bool| {
        let (graph, cover, maps) = pair(&truth, members, linked, mirrored);
        find(&graph, &cover, &maps, &crate::Silent)[0].evidence
    };
    assert_eq!(evidence(true, |i, j| (i, j) != (0, 1)), -evidence(false, |i, j| (i, j) != (0, 1)));
    // Two shared landmarks alone tell nothing.
    assert!(evidence(false, |i, j| (i, j) != (0, 1) && (i, j) != (2, 3)).abs() < 1e-9);
    // Three shared ones do, without any link across.
    let (graph, cover, maps) = pair(&truth, [&[0, 1, 2], &[0, 1, 2, 3]], |_, j| j == 3, true);
    assert!(find(&graph, &cover, &maps, &crate::Silent)[0].evidence < -5.0);
}

#[test]
fn regions_that_share_fewer_than_two_landmarks_have_no_seam() {
    let truth = [[0.0, 0.0], [1.0, 0.0], [0.5, 0.6], [0.5, 1.0]];
    for members in [[&[0, 1][..], &[2, 3][..]], [&[0, 1], &[1, 2, 3]]] {
        let (graph, cover, maps) = pair(&truth, members, |_, _| true, false);
        assert!(find(&graph, &cover, &maps, &crate::Silent).is_empty());
    }
}

#[test]
fn shared_landmarks_in_one_place_fix_no_turn() {
    let truth = [[1.0, 1.0], [1.0, 1.0], [0.5, 0.6], [0.5, 1.0]];
    let (graph, cover, maps) = pair(&truth, [&[0, 1, 2], &[0, 1, 3]], |i, _| i == 0, false);
    assert!(find(&graph, &cover, &maps, &crate::Silent).is_empty());
}

#[test]
fn flatness_computed_by_hand() {
    // A rectangle of 4 by 3 has spreads of 2 and 1.5, whichever way it lies.
    let (sin, cos) = 0.4_f64.sin_cos();
    let corners = [[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 3.0]];
    let turned = corners.map(|[x, y]| [cos * x - sin * y + 7.0, sin * x + cos * y]);
    assert!((flatness(turned.into_iter()) - 0.75).abs() < 1e-12);
    let line = [[0.0, 1.0], [1.0, 2.0], [5.0, 6.0]];
    assert!(flatness(line.into_iter()) < 1e-7, "{}", flatness(line.into_iter()));
    assert_eq!(flatness([[2.0, 3.0]; 4].into_iter()), 0.0);
    assert_eq!(flatness([[2.0, 3.0]].into_iter()), 0.0);
    assert_eq!(flatness(std::iter::empty::<Point>()), 0.0);
}
