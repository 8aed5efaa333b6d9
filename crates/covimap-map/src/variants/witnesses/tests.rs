use super::*;
use crate::fixtures::scattered;

/// The true places of some landmarks, mirrored or not.
fn map(truth: &[Point], members: &[u32], mirrored: bool) -> LocalMap {
    let side = if mirrored { -1.0 } else { 1.0 };
    let place = |&member: &u32| [side * truth[member as usize][0], truth[member as usize][1]];
    LocalMap { points: members.iter().map(place).collect(), stress1: 0.0 }
}

#[test]
fn pieces_are_witnesses_of_the_regions_they_hold() {
    let truth = scattered(30, [2.0, 2.0], 1);
    let range = |from: u32, to: u32| (from..to).collect::<Vec<u32>>();
    // Regions with cores 0..14, 14..24 and 24..30, the second one mirrored; pieces 0..24 and, mirrored, 10..30.
    let cover = RegionCover::of_members(30, &[&range(0, 14), &range(10, 24), &range(20, 30)]);
    let maps: Vec<LocalMap> = cover
        .regions()
        .iter()
        .zip([false, true, false])
        .map(|(region, mirrored)| map(&truth, &region.members, mirrored))
        .collect();
    let pieces = RegionCover::of_members(30, &[&range(0, 24), &range(10, 30)]);
    let best = [map(&truth, &range(0, 24), false), map(&truth, &range(10, 30), true)];
    let witnesses = Witnesses::new(&cover, &maps, &pieces, &best);
    assert_eq!(witnesses.0[0], [(0, false)]);
    assert_eq!(witnesses.0[1], [(0, true), (1, false)]);
    assert_eq!(witnesses.0[2], [(1, true)]);
    assert_eq!([witnesses.votes(0, 1), witnesses.votes(1, 2), witnesses.votes(2, 1)], [-1.0; 3]);
    // No piece holds both.
    assert_eq!(witnesses.votes(0, 2), 0.0);
    // If the second region is the one that lies mirrored, so does the second piece.
    assert_eq!(witnesses.pieces_by(&cover, &[false, true, false], 2), [false, true]);
    assert_eq!(witnesses.pieces_by(&cover, &[true, false, true], 2), [true, false]);
    // The first piece holds two regions, the second the other two.
    assert_eq!(witnesses.divided_by(&[1], 2), [0, 1]);
    assert_eq!(witnesses.divided_by(&[1, 2], 2), [0]);
    assert_eq!(witnesses.divided_by(&[0, 1, 2], 2), [0; 0]);
}
