use std::collections::BTreeMap;
use std::sync::atomic::{AtomicU64, Ordering};

use proptest::prelude::*;

use super::*;
use crate::fixtures::{cases, counts_of};
use crate::{Silent, Stage};

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

/// All stored pairs, both ways.
fn pairs(counts: &CoVisibility) -> BTreeMap<(u32, u32), u32> {
    let mut pairs = BTreeMap::new();
    for a in 0..u32::try_from(counts.landmarks()).unwrap() {
        let (partners, together) = counts.row(LandmarkId(a));
        assert!(partners.is_sorted_by(|a, b| a < b));
        pairs.extend(partners.iter().zip(together).map(|(&b, &n)| ((a, b), n)));
    }
    pairs
}

fn log(steps: &[Vec<u32>]) -> SightingLog {
    SightingLog::from_steps(steps.iter().map(|step| step.iter().map(u32::to_string)))
}

fn count(log: &SightingLog) -> CoVisibility {
    CoVisibility::count(log, &Silent).unwrap()
}

fn on_threads<T: Send>(threads: usize, run: impl FnOnce() -> T + Send) -> T {
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(run)
}

#[test]
fn three_steps_counted_by_hand() {
    let counts = count(&SightingLog::from_steps([vec!["A", "B", "C"], vec!["B", "A"], vec![], vec!["B"]]));
    let [a, b, c] = [0, 1, 2].map(LandmarkId);
    assert_eq!((counts.steps(), counts.landmarks(), counts.pair_count()), (4, 3, 3));
    assert_eq!(counts.sightings(), [2, 3, 1]);
    assert_eq!(counts.row(b), (&[0, 2][..], &[2, 1][..]));
    assert_eq!([counts.together(a, c), counts.together(c, a), counts.together(b, b)], [1, 1, 3]);
    // f = n_ij / (n_i + n_j - n_ij): 2 / (2 + 3 - 2) and 1 / (3 + 1 - 1).
    assert_eq!(counts.frequency(a, b).to_bits(), (2.0_f64 / 3.0).to_bits());
    assert_eq!(counts.frequency(c, b).to_bits(), (1.0_f64 / 3.0).to_bits());
}

#[test]
fn logs_without_pairs() {
    for steps in [vec![], vec![vec![]], vec![vec![1]], vec![vec![1], vec![2], vec![1]]] {
        let counts = count(&log(&steps));
        assert_eq!((counts.pair_count(), counts.steps()), (0, steps.len() as u64));
        assert!(pairs(&counts).is_empty());
    }
}

proptest! {
    #[test]
    fn the_counts_are_those_of_all_pairs_of_all_steps(
        steps in prop::collection::vec(prop::collection::vec(0..30_u32, 0..12), 0..60),
        threads in 1..5_usize,
    ) {
        let log = log(&steps);
        let counts = on_threads(threads, || count(&log));
        let (sightings, together) = obvious(&log);
        prop_assert_eq!(counts.sightings(), &sightings[..]);
        prop_assert_eq!(pairs(&counts), together);
        prop_assert_eq!(counts.steps(), steps.len() as u64);
    }

    #[test]
    fn counts_are_made_again_from_their_parts(
        steps in prop::collection::vec(prop::collection::vec(0..20_u32, 0..6), 0..20),
    ) {
        let counts = count(&log(&steps));
        let parts = pairs(&counts).into_iter().filter(|((a, b), _)| a < b);
        // Last pair first, smaller landmark first: neither is the order of the rows.
        let parts: Vec<_> = parts.rev().map(|((a, b), n)| (LandmarkId(a), LandmarkId(b), n)).collect();
        let again = CoVisibility::from_counts(counts.steps(), counts.sightings().to_vec(), parts).unwrap();
        prop_assert_eq!(again, counts);
    }
}

#[test]
fn a_log_of_several_pieces_and_long_rows() {
    // 120 000 steps of 20 out of 40 landmarks are 2.4 million sightings, enough for two pieces.
    let steps = (0..120_000_u32).map(|t| (0..20).map(move |k| (t * 7 + k * 3) % 40));
    let log = SightingLog::from_steps(steps.map(|step| step.map(|id| id.to_string())));
    assert_eq!(log.sightings(), 2_400_000);
    let one = on_threads(1, || count(&log));
    let (sightings, together) = obvious(&log);
    assert_eq!(one.sightings(), sightings);
    assert_eq!(pairs(&one), together);
    assert_eq!(on_threads(3, || count(&log)), one);
}

#[test]
fn counts_that_contradict_each_other() {
    let id = LandmarkId;
    let bad = [
        (vec![6, 1], vec![], "landmark 0 is seen 6 times in 5 steps"),
        (vec![2, 1], vec![(id(0), id(1), 2)], "pair (0, 1) is seen together 2 times, it can be 1 to 1"),
        (vec![2, 1], vec![(id(1), id(0), 0)], "pair (1, 0) is seen together 0 times, it can be 1 to 1"),
        (vec![2, 1], vec![(id(1), id(1), 1)], "pair (1, 1) names one landmark twice"),
        (
            vec![2, 1],
            vec![(id(0), id(1), 1), (id(1), id(0), 1)],
            "pair (0, 1) occurs twice; give every pair once",
        ),
        (vec![2, 1], vec![(id(0), id(2), 1)], "pair (0, 2) names a landmark beyond the 2 there are"),
    ];
    for (sightings, pairs, what) in bad {
        let error = CoVisibility::from_counts(5, sightings, pairs).unwrap_err();
        assert!(matches!(error, MapError::BadCounts { .. }));
        assert_eq!(error.to_string(), what);
    }
}

/// Adds up what it hears, and asks to stop from some landmark on.
struct Watch {
    enough: u64,
    landmarks: AtomicU64,
}

impl Observer for Watch {
    fn started(&self, stage: Stage, total: Option<u64>) {
        assert_eq!((stage, total), (Stage::Count, Some(300)));
    }
    fn advanced(&self, amount: u64) {
        self.landmarks.fetch_add(amount, Ordering::Relaxed);
    }
    fn interrupted(&self) -> bool {
        self.landmarks.load(Ordering::Relaxed) >= self.enough
    }
}

#[test]
fn the_observer_hears_of_every_landmark_and_may_stop_the_count() {
    let log = log(&(0..300).map(|i| vec![i, (i + 1) % 300]).collect::<Vec<_>>());
    for (enough, stops) in [(u64::MAX, false), (0, true), (150, true)] {
        let watch = Watch { enough, landmarks: AtomicU64::new(0) };
        let result = CoVisibility::count(&log, &watch);
        assert_eq!(matches!(result, Err(MapError::Interrupted)), stops);
        assert_eq!(watch.landmarks.into_inner() == 300, !stops);
    }
}

proptest! {
    #![proptest_config(cases(64))]

    /// Counting the joined log is the oracle.
    #[test]
    fn counts_joined_are_the_counts_of_the_joined_log(
        steps in prop::collection::vec(prop::collection::vec(0_u32..12, 0..6), 0..30),
        cut in 0_usize..30,
    ) {
        let named: Vec<Vec<String>> =
            steps.iter().map(|step| step.iter().map(u32::to_string).collect()).collect();
        let cut = cut.min(named.len());
        let [first, second] = [&named[..cut], &named[cut..]].map(SightingLog::from_steps);
        let later = first.renumber(&second);
        let joined = counts_of(&first).joined(&counts_of(&later)).unwrap();
        prop_assert_eq!(joined, counts_of(&SightingLog::from_steps(&named)));
    }
}
