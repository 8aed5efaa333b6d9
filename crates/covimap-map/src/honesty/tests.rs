use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::*;
use crate::fixtures::{counts_of, distance, log_of, looks, on_threads, scattered};
use crate::{LinkGraph, SightingLog};

const EXTENT: [f64; 2] = [5.0, 6.0];
const RANGE: f64 = 0.6;
/// Landmarks further apart than this are never truly seen together: two ranges and the soft edges.
const FAR: f64 = 1.9;

/// What is seen in a hall of 300 landmarks, and where they are.
fn hall(steps: usize) -> (Vec<[f64; 2]>, Vec<Vec<usize>>) {
    let points = scattered(300, EXTENT, 1);
    let looks = looks(&points, EXTENT, RANGE, steps);
    (points, looks)
}

/// Turns a share of the sightings into `as_whom`, drawn anew for each.
fn misread(looks: &mut [Vec<usize>], share: f64, as_whom: impl Fn(&mut ChaCha8Rng) -> usize) {
    let mut rng = ChaCha8Rng::seed_from_u64(7);
    for look in looks {
        for seen in look.iter_mut() {
            if rng.random_bool(share) {
                *seen = as_whom(&mut rng);
            }
        }
        look.sort_unstable();
        look.dedup();
    }
}

/// Linked pairs `i < j` with their counts, and whether the link is kept.
fn verdicts(counts: &CoVisibility, honest: &HonestLinks) -> Vec<(usize, usize, u32, bool)> {
    let row = |i: u32| {
        let id = LandmarkId(i);
        let (partners, together) = counts.row(id);
        let verdict = move |(place, (&j, &both)): (usize, (&u32, &u32))| {
            (i as usize, j as usize, both, honest.keeps(id, place))
        };
        partners.iter().zip(together).enumerate().map(verdict)
    };
    (0..counts.landmarks() as u32).flat_map(row).filter(|verdict| verdict.0 < verdict.1).collect()
}

#[test]
fn a_clean_log_loses_nothing() {
    let counts = counts_of(&log_of(&hall(9000).1));
    let honest = HonestLinks::judge(&counts);
    assert_eq!(honest.report(), HonestyReport { set_aside: 0, misrecognition: Some(0.0) });
    assert_eq!(LinkGraph::from_honest(&counts, &honest), LinkGraph::from_counts(&counts));
}

#[test]
fn chance_links_are_set_aside_and_the_error_rate_is_told() {
    for share in [0.005, 0.02, 0.05] {
        let (points, mut looks) = hall(9000);
        misread(&mut looks, share, |rng| rng.random_range(0..300));
        let counts = counts_of(&log_of(&looks));
        let honest = HonestLinks::judge(&counts);
        let told = honest.report().misrecognition.unwrap();
        assert!((told / share - 1.0).abs() < 0.15, "{told} for {share}");
        let verdicts = verdicts(&counts, &honest);
        let aside = verdicts.iter().filter(|verdict| !verdict.3).count() as u64;
        assert_eq!(honest.report().set_aside, aside);
        // Of some thousand chance links of far landmarks next to none is left;
        let far = |&&(i, j, ..): &&(usize, usize, u32, bool)| distance(points[i], points[j]) > FAR;
        let kept = verdicts.iter().filter(far).filter(|verdict| verdict.3).count();
        let all = verdicts.iter().filter(far).count();
        assert!(all > 2000 && kept <= 3, "{kept} of {all} at {share}");
        // of the co-sightings of near ones, which are true but for a few, nearly all are.
        let near = || verdicts.iter().filter(|verdict| !far(verdict));
        let together: u32 = near().map(|verdict| verdict.2).sum();
        let lost: u32 = near().filter(|verdict| !verdict.3).map(|verdict| verdict.2).sum();
        assert!(f64::from(lost) < 0.02 * f64::from(together), "{lost} of {together} at {share}");
    }
}

#[test]
fn a_door_of_weak_links_stays_open() {
    // Two rooms of 200 that share a wall at x = 4; six landmarks on either side of a door are seen together
    // from the threshold, in few steps.
    let mut points = scattered(200, [4.0, 5.0], 1);
    points.extend(scattered(200, [4.0, 5.0], 2).iter().map(|[x, y]| [x + 4.0, *y]));
    let mut looks: Vec<Vec<usize>> = Vec::new();
    for (room, shift) in [(0, 0.0), (200, 4.0)] {
        let inside: Vec<_> = points[room..room + 200].iter().map(|[x, y]| [x - shift, *y]).collect();
        let seen = crate::fixtures::looks(&inside, [4.0, 5.0], RANGE, 8000);
        looks.extend(seen.iter().map(|look| look.iter().map(|i| i + room).collect::<Vec<_>>()));
    }
    let nearest = |room: usize| {
        let mut sides: Vec<usize> = (room..room + 200).collect();
        sides.sort_by(|&a, &b| distance(points[a], [4.0, 2.5]).total_cmp(&distance(points[b], [4.0, 2.5])));
        sides.truncate(6);
        sides
    };
    let (left, right) = (nearest(0), nearest(200));
    looks.extend((0..8).map(|_| left.iter().chain(&right).copied().collect()));
    for share in [0.0, 0.02] {
        let mut looks = looks.clone();
        misread(&mut looks, share, |rng| rng.random_range(0..400));
        let counts = counts_of(&log_of(&looks));
        let honest = HonestLinks::judge(&counts);
        let across: Vec<_> = verdicts(&counts, &honest)
            .into_iter()
            .filter(|&(i, j, _, kept)| i < 200 && j >= 200 && kept)
            .collect();
        let through_door = across.iter().filter(|(i, j, ..)| left.contains(i) && right.contains(j)).count();
        // Each of the 36 pairs counts about 8, where chance would have it at 0.1 to 0.2.
        assert!(through_door >= 30, "{through_door} at {share}");
        let through_wall = across.iter().filter(|&&(i, j, ..)| distance(points[i], points[j]) > FAR).count();
        assert!(through_wall <= 2, "{across:?} at {share}");
    }
}

#[test]
fn a_landmark_that_is_nowhere_loses_all_its_links() {
    let (_, mut looks) = hall(9000);
    // Nothing has the ID 300, but landmarks are misread for it as for any other.
    misread(&mut looks, 0.02, |rng| rng.random_range(0..301));
    let counts = counts_of(&log_of(&looks));
    let honest = HonestLinks::judge(&counts);
    let graph = LinkGraph::from_honest(&counts, &honest);
    assert!(counts.row(LandmarkId(300)).0.len() > 20);
    assert_eq!(graph.of(300), []);
    let sizes: Vec<usize> = graph.components().iter().map(Vec::len).collect();
    assert_eq!(sizes, [300, 1]);
}

#[test]
fn the_verdict_does_not_depend_on_threads_and_is_symmetric() {
    let (_, mut looks) = hall(4000);
    misread(&mut looks, 0.03, |rng| rng.random_range(0..300));
    let counts = counts_of(&log_of(&looks));
    let honest = on_threads(1, || HonestLinks::judge(&counts));
    assert_eq!(honest, on_threads(3, || HonestLinks::judge(&counts)));
    for i in 0..300 {
        for (place, &j) in counts.row(LandmarkId(i)).0.iter().enumerate() {
            let back = counts.row(LandmarkId(j)).0.binary_search(&i).unwrap();
            assert_eq!(honest.keeps(LandmarkId(i), place), honest.keeps(LandmarkId(j), back), "{i}, {j}");
        }
    }
}

#[test]
fn logs_that_cannot_tell_keep_everything() {
    let ring: Vec<Vec<String>> = (0..40).map(|i| vec![i.to_string(), ((i + 1) % 40).to_string()]).collect();
    let crowd: Vec<Vec<String>> = vec![(0..30).map(|i: u32| i.to_string()).collect(); 50];
    let logs = [
        SightingLog::from_steps([] as [Vec<&str>; 0]),
        SightingLog::from_steps([vec!["A"]]),
        SightingLog::from_steps([vec!["A", "B"]]),
        SightingLog::from_steps([vec!["A", "B"], vec!["B", "C"], vec!["C", "A"], vec!["A"]]),
        // Every pair once: nothing is too strong for chance.
        SightingLog::from_steps(ring),
        // Everything always together: nothing is far.
        SightingLog::from_steps(crowd),
    ];
    for log in logs {
        let counts = counts_of(&log);
        let honest = HonestLinks::judge(&counts);
        assert_eq!(honest.report(), HonestyReport::default());
        assert!(verdicts(&counts, &honest).iter().all(|verdict| verdict.3));
    }
    // A room in which errors reach everything is one of them.
    let points = scattered(15, [1.5, 1.5], 3);
    let mut looks = looks(&points, [1.5, 1.5], 0.55, 1000);
    misread(&mut looks, 0.1, |rng| rng.random_range(0..15));
    assert_eq!(HonestLinks::judge(&counts_of(&log_of(&looks))).report(), HonestyReport::default());
}
