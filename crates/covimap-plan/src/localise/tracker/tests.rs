use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

use super::*;
use crate::localise::tests::{SENSOR, hall, localiser, look, map_of, seen_from};

fn tracker(localiser: Localiser) -> Tracker {
    Tracker::new(Arc::new(localiser), TrackParams::default()).unwrap()
}

/// Looks along a way.
fn looks_along(way: &[Point], points: &[Point], rng: &mut ChaCha8Rng) -> Vec<Look> {
    let look =
        |place: &Point| Look { known: seen_from(*place, points.iter().copied(), rng), ..Look::default() };
    way.iter().map(look).collect()
}

/// A circle of radius 1 around (1.6, 1.6), a step of 0.125 a time.
fn circle() -> Vec<Point> {
    (0..50).map(|k| f64::from(k) / 8.0).map(|a| [1.6 + a.cos(), 1.6 + a.sin()]).collect()
}

#[test]
fn the_belief_is_that_of_the_forward_algorithm() {
    let landmarks = hall(120, 0);
    let points: Vec<Point> = landmarks.iter().map(|landmark| landmark.1).collect();
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let looks = looks_along(&circle()[..6], &points, &mut rng);
    let mut tracker = tracker(localiser(map_of(&landmarks, 1e-6, &[])));
    let falsely = |look: &Look| super::super::FALSE_SHARE * look.known.len() as f64 / 120.0;
    // All cells of the chart, a tenth of a unit wide; the edges softened by a quarter of that.
    let places: Vec<Point> =
        (-10..45).flat_map(|x| (-10..45).map(move |y| [f64::from(x) * 0.1, f64::from(y) * 0.1])).collect();
    let edge = SENSOR.edge.hypot(0.025);
    let likelihood = |place: Point, look: &Look| {
        let factor = |(i, &point): (u32, &Point)| {
            let chance = 0.9 / (1.0 + ((distance(point, place) - SENSOR.range) / edge).exp());
            let e = falsely(look);
            if look.known.contains(&covimap_map::LandmarkId(i)) {
                e + (1.0 - e) * chance
            } else {
                1.0 - chance
            }
        };
        (0..).zip(&points).map(factor).product::<f64>()
    };
    let mut belief = vec![1.0; places.len()];
    for look in &looks {
        if belief.iter().any(|mass| *mass != 1.0) {
            // A step of 0.3 ranges in each coordinate, at most three times that, and jumps.
            let from = belief.clone();
            let total: f64 = from.iter().sum();
            let weight = |d: f64| if d.abs() < 0.501 { (-0.5 * (d / 0.15).powi(2)).exp() } else { 0.0 };
            let norm: f64 = (-5..=5).map(|k| weight(f64::from(k) * 0.1)).sum();
            let jump = 1e-3 * 0.2 * 0.2 / tracker.localiser.area;
            for (mass, to) in belief.iter_mut().zip(&places) {
                let moved =
                    places.iter().zip(&from).map(|(z, m)| m * weight(to[0] - z[0]) * weight(to[1] - z[1]));
                *mass = (1.0 - 1e-3) * moved.sum::<f64>() / (norm * norm * total) + jump;
            }
        }
        for (mass, place) in belief.iter_mut().zip(&places) {
            *mass *= likelihood(*place, look);
        }
        let total: f64 = belief.iter().sum();
        let mean = [0, 1].map(|a| places.iter().zip(&belief).map(|(at, m)| m * at[a]).sum::<f64>() / total);
        let found = tracker.update(look);
        let got = found
            .modes
            .iter()
            .fold([0.0; 2], |sum, mode| [0, 1].map(|a| sum[a] + mode.probability * mode.position[a]));
        assert!(distance(got, mean) < 0.005, "{got:?} {mean:?}");
    }
}

#[test]
fn a_moving_robot_is_followed_better_than_from_single_looks() {
    let landmarks = hall(100, 0);
    let points: Vec<Point> = landmarks.iter().map(|landmark| landmark.1).collect();
    let mut rng = ChaCha8Rng::seed_from_u64(2);
    let mut tracker = tracker(localiser(map_of(&landmarks, 0.01, &[])));
    let (mut followed, mut single) = (0.0, 0.0);
    let way = circle();
    for (place, look) in way.iter().zip(looks_along(&way, &points, &mut rng)) {
        single += distance(tracker.localiser.locate(&look).best().unwrap().position, *place);
        followed += distance(tracker.update(&look).best().unwrap().position, *place);
    }
    assert!(followed < 0.9 * single, "{followed} {single}");
}

#[test]
fn places_that_look_alike_are_told_apart_by_the_way() {
    // Two halls of one chart, the same but for the landmarks of a corner; seen IDs are those of both.
    let one = hall(100, 0);
    let far = |at: Point| [at[0] + 20.0, at[1]];
    let landmarks: Vec<_> = one.iter().copied().chain(one.iter().map(|&(c, at)| (c, far(at)))).collect();
    let mut tracker = tracker(localiser(map_of(&landmarks, 0.01, &[])));
    let in_corner = |at: Point| at[0] < 1.2;
    let ids_near = |place: Point| -> Vec<u32> {
        let near = (0..100u32).filter(|&i| distance(one[i as usize].1, place) < 0.45);
        // Outside the corner each look shows both copies of half the landmarks.
        let both = near.enumerate().flat_map(|(k, i)| {
            if in_corner(one[i as usize].1) {
                vec![i]
            } else if k % 2 == 0 {
                vec![i, i + 100]
            } else {
                vec![]
            }
        });
        let mut both: Vec<u32> = both.collect();
        both.sort_unstable();
        both
    };
    let way: Vec<Point> = (0..20).map(|k| [2.6 - 0.1 * f64::from(k), 1.5]).collect();
    let first = tracker.update(&look(&ids_near(way[0])));
    assert!(first.is_ambiguous(), "{first:?}");
    for place in &way[1..] {
        tracker.update(&look(&ids_near(*place)));
    }
    // Back among what looks alike it still knows in which hall it is.
    let mut last = None;
    for place in way.iter().rev() {
        last = tracker.update(&look(&ids_near(*place))).best().cloned();
    }
    let last = last.unwrap();
    assert!(last.position[0] < 10.0 && last.probability > 0.99, "{last:?}");
}

#[test]
fn a_robot_that_is_carried_away_is_found_again() {
    let landmarks = hall(300, 0);
    let points: Vec<Point> = landmarks.iter().map(|landmark| landmark.1).collect();
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    let mut tracker = tracker(localiser(map_of(&landmarks, 0.01, &[])));
    for look in looks_along(&[[1.0, 1.0], [1.1, 1.0], [1.2, 1.0]], &points, &mut rng) {
        tracker.update(&look);
    }
    let elsewhere = [4.0, 4.2];
    let mut found = tracker.update(&Look::default());
    assert!(found.best().is_some_and(|best| distance(best.position, [1.3, 1.0]) < 1.0));
    for look in looks_along(&[elsewhere; 3], &points, &mut rng) {
        found = tracker.update(&look);
    }
    assert!(distance(found.best().unwrap().position, elsewhere) < 0.25, "{found:?}");
    tracker.reset();
    assert!(tracker.update(&Look::default()).is_lost());
}

#[test]
fn looks_that_show_nothing_do_not_carry_the_robot_off_the_map() {
    let landmarks: Vec<(u32, Point)> = (0..4).map(|k| (0, [0.3 * f64::from(k), 0.0])).collect();
    let mut tracker = tracker(localiser(map_of(&landmarks, 0.01, &[])));
    tracker.update(&look(&[0, 1, 2]));
    let mut most = 0;
    for _ in 0..300 {
        let location = tracker.update(&Look::default());
        most = most.max(tracker.belief.len());
        for mode in &location.modes {
            let near = landmarks.iter().map(|landmark| distance(landmark.1, mode.position));
            assert!(near.fold(f64::INFINITY, f64::min) < 2.5 * SENSOR.range, "{mode:?}");
        }
    }
    // Two ranges around a line of two: 4 pi + 4 * 2 square ranges of 25 cells and some.
    assert!((100..800).contains(&most), "{most}");
    assert!(tracker.update(&look(&[1, 2, 3])).best().is_some());
}

#[test]
fn settings_out_of_their_range_are_refused() {
    let localiser = Arc::new(localiser(map_of(&hall(10, 0), 0.01, &[])));
    for (step, jump) in [(0.0, 0.1), (4.0, 0.1), (f64::NAN, 0.1), (0.3, 0.0), (0.3, 1.0)] {
        let refused = Tracker::new(Arc::clone(&localiser), TrackParams { step, jump });
        assert!(matches!(refused, Err(PlanError::BadParameter { .. })), "{step} {jump}");
    }
}
