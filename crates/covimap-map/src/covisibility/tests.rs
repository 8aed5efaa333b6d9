use std::collections::BTreeMap;

use proptest::prelude::*;

use super::*;
use crate::Silent;

/// The obvious count: every pair of every step.
fn obvious(log: &SightingLog) -> (Vec<u32>, BTreeMap<(u32, u32), u32>) {
    let mut sightings = vec![0; log.names().len()];
    let mut together = BTreeMap::new();
    for step in log.iter() {
        for &a in step {
            sightings[a as usize] += 1;
            for &b in step.iter().filter(|&&b| b != a) {
                *together.entry((a, b)).or_insert(0) += 1;
            }
        }
    }
    (sightings, together)
}

fn pairs(counts: &CoVisibility) -> BTreeMap<(u32, u32), u32> {
    let mut pairs = BTreeMap::new();
    for a in 0..counts.landmarks() as u32 {
        let (partners, together) = counts.row(LandmarkId(a));
        assert!(partners.is_sorted_by(|a, b| a < b));
        pairs.extend(partners.iter().zip(together).map(|(&b, &n)| ((a, b), n)));
    }
    pairs
}

proptest! {
    #[test]
    fn the_counts_are_those_of_all_pairs_of_all_steps(
        steps in prop::collection::vec(prop::collection::vec(0..30_u32, 0..12), 0..60),
    ) {
        let log = SightingLog::from_steps(steps.iter().map(|step| step.iter().map(u32::to_string)));
        let counts = CoVisibility::count(&log, &Silent).unwrap();
        let (sightings, together) = obvious(&log);
        prop_assert_eq!(counts.sightings(), &sightings[..]);
        prop_assert_eq!(pairs(&counts), together);
        prop_assert_eq!(counts.steps(), steps.len() as u64);
    }
}
