use super::*;
use crate::fixtures::{index_of, map_of, map_seen, square_and_pair};

fn kinds(explanation: &Explanation) -> Vec<&str> {
    explanation.advice.iter().map(|advice| advice.kind).collect()
}

#[test]
fn what_holds_a_landmark_is_listed_by_frequency() {
    let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 2.0], [-1.0, -1.0]];
    let index = index_of(&points, &[(0, 1, 20), (0, 2, 60), (0, 3, 40), (1, 2, 10), (1, 3, 10)]);
    let found = explain(&index, "L0").unwrap();
    let holds: Vec<_> =
        found.holds.iter().map(|hold| (hold.id.as_str(), hold.steps, hold.distance)).collect();
    assert_eq!(holds, [("L2", 60, 2.0), ("L3", 40, 2f64.sqrt()), ("L1", 20, 1.0)]);
    // (60 + 1/2) / (100 + 100 - 60 + 1).
    assert!((found.holds[0].frequency - 60.5 / 141.0).abs() < 1e-12);
    assert!(found.holds.iter().all(|hold| !hold.seam));
    assert_eq!((found.component_landmarks, found.region_landmarks, found.partners), (4, 4, 3));
    assert!(
        found.axes[0] >= found.axes[1]
            && found.axes[0] >= found.deviation
            && found.deviation >= found.axes[1]
    );
    assert!(kinds(&found).is_empty(), "{:?}", found.advice);
}

#[test]
fn seams_are_told() {
    let mut map = map_of(&[([0.0; 2], 0), ([1.0, 0.0], 0), ([2.0, 0.0], 0)], &[(0, 1, 9), (1, 2, 9)]);
    let lines = map.sight_lines().clone();
    let mut landmarks = map.landmarks().to_vec();
    landmarks[2].region = 1;
    map = covimap_map::GlobalMap::from_parts(
        map.names().clone(),
        landmarks,
        map.params().clone(),
        map.report().clone(),
    )
    .unwrap()
    .with_sight_lines(lines)
    .unwrap();
    let found = explain(&MapIndex::new(std::sync::Arc::new(map)), "L1").unwrap();
    let seams: Vec<_> = found.holds.iter().map(|hold| (hold.id.as_str(), hold.seam)).collect();
    assert_eq!(seams, [("L0", false), ("L2", true)]);
    assert_eq!(found.region_landmarks, 2);
}

#[test]
fn advice_names_what_is_missing() {
    let lone = explain(&index_of(&[[0.0; 2], [1.0, 0.0]], &[]), "L0").unwrap();
    assert_eq!(kinds(&lone), ["never_together"]);
    let square = explain(&square_and_pair(), "L0").unwrap();
    // Two partners each; one of the diagonals is an edge that nobody looked along.
    assert_eq!(square.advice[0].kind, "few_partners");
    assert_eq!(
        square.advice[0].message,
        "seen with 2 other landmarks only, which leaves it two places or more; look when a third is in view"
    );
    let told: Vec<Explanation> =
        ["L0", "L1", "L2", "L3"].map(|id| explain(&square_and_pair(), id).unwrap()).into();
    let unseen = told.iter().filter(|found| kinds(found).contains(&"unseen_neighbours"));
    assert_eq!(unseen.count(), 2);
    assert!(matches!(explain(&square_and_pair(), "L9"), Err(PlanError::UnknownLandmark { .. })));
}

#[test]
fn a_landmark_seen_once_and_a_loose_one_are_told() {
    // A grid that is seen well, and one landmark on a single weak line.
    let points: Vec<[f64; 2]> =
        (0..9).map(|i| [f64::from(i % 3), f64::from(i / 3)]).chain([[5.0, 1.0]]).collect();
    let mut lines: Vec<_> =
        (0..9).flat_map(|i| [(i, i + 1, 90), (i, i + 3, 90)]).filter(|line| line.1 < 9).collect();
    lines.push((5, 9, 1));
    let found = explain(&index_of(&points, &lines), "L9").unwrap();
    assert!(kinds(&found).contains(&"loose"), "{found:?}");
    assert!(found.deviation > 2.0 * found.typical_deviation);
    let map = map_seen(&[([0.0; 2], 0), ([1.0, 0.0], 0)], &[(0, 1, 1)], 1);
    let once = explain(&MapIndex::new(std::sync::Arc::new(map)), "L0").unwrap();
    assert_eq!(kinds(&once), ["seen_once", "few_partners"]);
}
