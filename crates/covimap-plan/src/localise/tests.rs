use covimap_map::{BuildReport, GlobalMap, LandmarkNames, MapperParams, PlacedLandmark, Sensed, SensorModel};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::*;

pub(super) const SENSOR: SensorModel =
    SensorModel { range: 0.5, edge: 0.04, detectability: 0.9, outliers: 1e-3 };

/// A map of landmarks at these places of these charts, called by their numbers.
pub(super) fn map_of(landmarks: &[(u32, Point)], deviation: f64, occluded: &[[u32; 2]]) -> GlobalMap {
    let ids: Vec<String> = (0..landmarks.len()).map(|i| i.to_string()).collect();
    let names: LandmarkNames = ids.iter().map(String::as_str).collect();
    let placed = |&(component, position): &(u32, Point)| PlacedLandmark {
        position,
        component,
        region: component,
        sightings: 300,
        partners: 10,
        ..Default::default()
    };
    // Eight landmarks a look.
    let report = BuildReport { steps: 1000, sightings: 8000, ..BuildReport::default() };
    let sensors = landmarks.iter().map(|placed| placed.0 as usize + 1).max().unwrap_or(1);
    let n = landmarks.len();
    let sensed = Sensed { detectability: 0.9, deviation, warp: 0.0 };
    let sensing = Sensing::from_parts(vec![SENSOR; sensors], vec![sensed; n], occluded).unwrap();
    let placed = landmarks.iter().map(placed).collect();
    GlobalMap::from_parts(names, placed, MapperParams::default(), report)
        .unwrap()
        .with_sensing(sensing)
        .unwrap()
}

/// Settings of a map whose aliases were split.
fn split() -> MapperParams {
    let mut params = MapperParams::default();
    params.auto.split_aliases = true;
    params
}

pub(super) fn localiser(map: GlobalMap) -> Localiser {
    Localiser::new(Arc::new(MapIndex::new(Arc::new(map)))).unwrap()
}

/// `n` landmarks at ten to a square unit in a chart of its own.
pub(super) fn hall(n: usize, component: u32) -> Vec<(u32, Point)> {
    let side = (n as f64 / 10.0).sqrt();
    let mut rng = ChaCha8Rng::seed_from_u64(u64::from(component) + 1);
    (0..n).map(|_| (component, [rng.random_range(0.0..side), rng.random_range(0.0..side)])).collect()
}

/// What a robot at a place sees of landmarks that stand there.
pub(super) fn seen_from(
    place: Point,
    points: impl Iterator<Item = Point>,
    rng: &mut ChaCha8Rng,
) -> Vec<LandmarkId> {
    let chance = |point| 0.9 * SENSOR.visibility(distance(point, place));
    (0..)
        .zip(points)
        .filter(|(_, point)| rng.random_bool(chance(*point)))
        .map(|(i, _)| LandmarkId(i))
        .collect()
}

pub(super) fn look(known: &[u32]) -> Look {
    Look { known: known.iter().copied().map(LandmarkId).collect(), ..Look::default() }
}

/// Mean and covariance of the posterior over a fine grid of the whole chart, by eq. (1) and nothing else.
fn brute_force(landmarks: &[(u32, Point)], known: &[LandmarkId]) -> (Point, [f64; 3]) {
    let falsely = FALSE_SHARE * known.len() as f64 / landmarks.len() as f64;
    let likelihood = |place: Point| {
        let factor = |(i, landmark): (usize, &(u32, Point))| {
            let chance = 0.9 * SENSOR.visibility(distance(landmark.1, place));
            let seen = known.contains(&LandmarkId(i as u32));
            // For each quality of the look.
            [1.0, 0.5, 0.25, 0.1].map(|quality| {
                if seen { falsely + (1.0 - falsely) * quality * chance } else { 1.0 - quality * chance }
            })
        };
        let product = |a: [f64; 4], b: [f64; 4]| std::array::from_fn(|k| a[k] * b[k]);
        let of_quality = landmarks.iter().enumerate().map(factor).fold([0.94, 0.03, 0.02, 0.01], product);
        of_quality.iter().sum::<f64>()
    };
    let cells: Vec<(Point, f64)> = (-50..250)
        .flat_map(|x| (-50..250).map(move |y| [f64::from(x) * 0.02, f64::from(y) * 0.02]))
        .map(|place| (place, likelihood(place)))
        .collect();
    let total: f64 = cells.iter().map(|cell| cell.1).sum();
    let mean = [0, 1].map(|a| cells.iter().map(|(at, w)| w * at[a]).sum::<f64>() / total);
    let moment = |a: usize, b: usize| {
        cells.iter().map(|(at, w)| w * (at[a] - mean[a]) * (at[b] - mean[b])).sum::<f64>() / total
    };
    (mean, [moment(0, 0), moment(0, 1), moment(1, 1)])
}

#[test]
fn the_posterior_is_that_of_the_obvious_computation() {
    let landmarks = hall(120, 0);
    let localiser = localiser(map_of(&landmarks, 1e-6, &[]));
    let mut rng = ChaCha8Rng::seed_from_u64(2);
    for _ in 0..12 {
        let place = [rng.random_range(0.3..3.2), rng.random_range(0.3..3.2)];
        let known = seen_from(place, landmarks.iter().map(|landmark| landmark.1), &mut rng);
        let (mean, covariance) = brute_force(&landmarks, &known);
        let location = localiser.locate(&Look { known, ..Look::default() });
        // All modes together: the obvious computation knows of none.
        let got = location
            .modes
            .iter()
            .fold([0.0; 2], |sum, mode| [0, 1].map(|a| sum[a] + mode.probability * mode.position[a]));
        assert!(distance(got, mean) < 0.012, "{got:?} {mean:?}");
        if location.modes.len() == 1 {
            for (got, wanted) in location.modes[0].covariance.iter().zip(covariance) {
                assert!((got - wanted).abs() < 0.1 * (covariance[0] + covariance[2]), "{got} {wanted}");
            }
        }
    }
}

#[test]
fn the_truth_is_where_the_region_says() {
    let truth = hall(400, 0);
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    // The map is off by what it says.
    let mut normal = || (0..12).map(|_| rng.random_range(-0.5..0.5)).sum::<f64>();
    let mapped: Vec<_> = truth.iter().map(|(c, at)| (*c, at.map(|x| x + 0.03 * normal()))).collect();
    let localiser = localiser(map_of(&mapped, 0.03, &[]));
    let (mut inside, mut errors) = (0, Vec::new());
    for _ in 0..600 {
        let place = [rng.random_range(0.0..6.3), rng.random_range(0.0..6.3)];
        let known = seen_from(place, truth.iter().map(|landmark| landmark.1), &mut rng);
        let location = localiser.locate(&Look { known, ..Look::default() });
        let Some(best) = location.best() else { continue };
        inside += usize::from(best.squared_distance(place) < 5.99);
        errors.push(distance(best.position, place));
        assert!(!location.is_lost());
    }
    let share = inside as f64 / errors.len() as f64;
    assert!(errors.len() > 590 && (0.92..0.98).contains(&share), "{share} of {}", errors.len());
    assert!(median(errors.iter().copied()) < 0.25 * SENSOR.range);
}

#[test]
fn the_bend_of_the_chart_at_a_place_is_in_the_region() {
    let landmarks = hall(160, 0);
    // Bent by .1 where x < 1.2, by .3 where x > 2.8, and by .2 in between.
    let warp = |x: f64| {
        if x < 1.2 {
            0.1
        } else if x > 2.8 {
            0.3
        } else {
            0.2
        }
    };
    let straight = map_of(&landmarks, 0.02, &[]);
    let sensed =
        |placed: &(u32, Point)| Sensed { detectability: 0.9, deviation: 0.02, warp: warp(placed.1[0]) };
    let sensing = Sensing::from_parts(vec![SENSOR], landmarks.iter().map(sensed).collect(), &[]).unwrap();
    let bent = localiser(straight.clone().with_sensing(sensing).unwrap());
    let straight = localiser(straight);
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    // Far enough from where the warp changes, all landmarks in range have the same.
    for (x, wanted) in [(0.5, 0.1), (2.0, 0.2), (3.5, 0.3)] {
        let known = seen_from([x, 2.0], landmarks.iter().map(|landmark| landmark.1), &mut rng);
        let look = Look { known, ..Look::default() };
        let mut tracker = Tracker::new(Arc::new(bent.clone()), TrackParams::default()).unwrap();
        let [a, b, tracked] = [straight.locate(&look), bent.locate(&look), tracker.update(&look)];
        let [a, b, tracked] = [&a, &b, &tracked].map(|location| location.best().unwrap());
        assert_eq!(a.position, b.position);
        for (k, wanted) in [(0, wanted * wanted), (1, 0.0), (2, wanted * wanted)] {
            assert!((b.covariance[k] - a.covariance[k] - wanted).abs() < 1e-12, "{x}: {b:?} {a:?}");
        }
        assert!(tracked.covariance[0] > wanted * wanted && tracked.covariance[2] > wanted * wanted);
    }
}

#[test]
fn the_chart_is_the_one_whose_landmarks_are_seen() {
    let landmarks: Vec<_> = hall(200, 0).into_iter().chain(hall(100, 1)).collect();
    let localiser = localiser(map_of(&landmarks, 0.01, &[]));
    let mut rng = ChaCha8Rng::seed_from_u64(4);
    let elsewhere = |landmark: &(u32, Point)| if landmark.0 == 1 { landmark.1 } else { [99.0; 2] };
    let known = seen_from([1.5, 1.5], landmarks.iter().map(elsewhere), &mut rng);
    let location = localiser.locate(&Look { known: known.clone(), ..Look::default() });
    let best = location.best().unwrap();
    assert_eq!(best.component, 1);
    assert!(best.probability > 0.99 && !location.is_lost());
    // One ID of the other chart changes nothing, and is the one that does not fit.
    let with_one = Look { known: [vec![LandmarkId(7)], known].concat(), ..Look::default() };
    let location = localiser.locate(&with_one);
    assert_eq!(location.best().unwrap().component, 1);
    assert_eq!(location.misfits, [LandmarkId(7)]);
    assert_eq!(location.fits, with_one.known.len() - 1);
}

#[test]
fn two_halls_alike_are_ambiguous() {
    // Half of what is seen stands in the one, half in the other.
    let mut landmarks = hall(100, 0);
    landmarks.extend(hall(100, 0).iter().map(|&(_, at)| (1, at)));
    let localiser = localiser(map_of(&landmarks, 0.01, &[]));
    let near: Vec<u32> = (0..100).filter(|&i| distance(landmarks[i as usize].1, [1.5, 1.5]) < 0.45).collect();
    let half = near.len() / 2;
    let both: Vec<u32> = near[..half].iter().copied().chain(near[..half].iter().map(|i| i + 100)).collect();
    let location = localiser.locate(&look(&both));
    assert!(location.is_ambiguous(), "{location:?}");
    assert!((location.modes[0].probability / location.modes[1].probability - 1.0).abs() < 1e-6);
}

#[test]
fn ids_that_do_not_go_together_are_lost() {
    let landmarks = hall(800, 0);
    let localiser = localiser(map_of(&landmarks, 0.01, &[]));
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    let mut scattered: Vec<u32> = (0..6).map(|_| rng.random_range(0..800)).collect();
    scattered.sort_unstable();
    assert!(localiser.locate(&look(&scattered)).is_lost());
    // Two far ends of the hall.
    let far = |corner: Point| {
        (0..800).min_by(|&a, &b| {
            let away = |i: u32| distance(landmarks[i as usize].1, corner);
            away(a).total_cmp(&away(b))
        })
    };
    let mut ends = [far([0.0; 2]).unwrap(), far([9.0; 2]).unwrap()];
    ends.sort_unstable();
    assert!(localiser.locate(&look(&ends)).is_lost());
    // One by itself, and a true look with three false ones.
    assert!(!localiser.locate(&look(&[17])).is_lost());
    let mut known = seen_from([4.0, 4.0], landmarks.iter().map(|landmark| landmark.1), &mut rng);
    known.extend([LandmarkId(3), LandmarkId(400), LandmarkId(790)]);
    known.sort_unstable();
    known.dedup();
    let location = localiser.locate(&Look { known, ..Look::default() });
    assert!(!location.is_lost(), "{location:?}");
    assert!(distance(location.best().unwrap().position, [4.0, 4.0]) < 0.2);
}

#[test]
fn unknown_ids_are_named_and_weigh_for_being_lost() {
    let localiser = localiser(map_of(&hall(200, 0), 0.01, &[]));
    let read = localiser.look(["7", "new", "7", "new", "other"]);
    assert_eq!((read.known.as_slice(), read.unknown.len()), ([LandmarkId(7)].as_slice(), 2));
    let one = localiser.locate(&look(&[7])).lost;
    let with_new = localiser.locate(&read).lost;
    assert!(with_new > one, "{one} {with_new}");
    // Nothing known at all.
    let nothing = localiser.locate(&localiser.look(["new"]));
    assert!(nothing.is_lost() && nothing.best().is_none() && !nothing.is_ambiguous());
    assert!(localiser.locate(&Look::default()).is_lost());
}

#[test]
fn an_id_that_two_landmarks_bear_is_the_one_with_company() {
    let landmarks = hall(800, 0);
    let plain = map_of(&landmarks, 0.01, &[]);
    // The landmarks nearest to two far places are both called A.
    let nearest = |place: Point| {
        let away = |i: &usize| distance(landmarks[*i].1, place);
        (0..800).min_by(|a, b| away(a).total_cmp(&away(b))).unwrap()
    };
    let (here, there) = (nearest([2.0, 2.0]), nearest([7.0, 7.0]));
    let name = |i: usize| match i {
        i if i == here => "A#1".to_owned(),
        i if i == there => "A#2".to_owned(),
        i => i.to_string(),
    };
    let ids: Vec<String> = (0..800).map(name).collect();
    let map = GlobalMap::from_parts(
        ids.iter().map(String::as_str).collect(),
        plain.landmarks().to_vec(),
        split(),
        plain.report().clone(),
    );
    let aliased = localiser(map.unwrap().with_sensing(plain.sensing().unwrap().clone()).unwrap());
    let mut rng = ChaCha8Rng::seed_from_u64(6);
    let points = landmarks.iter().map(|landmark| landmark.1);
    let mut known = seen_from([2.1, 2.0], points, &mut rng);
    known.push(LandmarkId(here as u32));
    known.sort_unstable();
    known.dedup();
    let seen: Vec<String> = known.iter().map(|id| name(id.index()).replace("A#1", "A")).collect();
    let read = aliased.look(seen.iter().map(String::as_str));
    assert_eq!(read.copies, [[LandmarkId(here as u32), LandmarkId(there as u32)]]);
    let location = aliased.locate(&read);
    let wanted = localiser(plain).locate(&Look { known, ..Look::default() });
    assert!(distance(location.best().unwrap().position, wanted.best().unwrap().position) < 1e-9);
    assert!(location.misfits.is_empty() && !location.is_lost());
}

#[test]
fn copies_are_looked_for_where_ids_were_split_only() {
    // The log had an A#1 of its own, so that the copies of A have two hashes.
    let plain = map_of(&hall(5, 0), 0.01, &[]);
    let names = ["A##1", "A##2", "A#1", "B#1", "B#2"];
    let with = |params| {
        let map = GlobalMap::from_parts(
            names.into_iter().collect(),
            plain.landmarks().to_vec(),
            params,
            plain.report().clone(),
        );
        localiser(map.unwrap().with_sensing(plain.sensing().unwrap().clone()).unwrap())
    };
    let read = with(split()).look(["A", "A#1"]);
    assert_eq!(read.copies, [[LandmarkId(0), LandmarkId(1)]]);
    assert_eq!(read.known, [LandmarkId(2)]);
    let read = with(MapperParams::default()).look(["A", "B", "A#1"]);
    assert_eq!((read.unknown, read.copies.len(), read.known.len()), (vec!["A".into(), "B".into()], 0, 1));
}

#[test]
fn one_place_between_two_crowds_is_one_mode() {
    // Two landmarks that are just more than two ranges apart are two crowds; the robot sees both from the middle.
    for gap in [1.99, 2.01] {
        let mut landmarks = vec![(0, [0.0, 0.0]), (0, [gap * SENSOR.range, 0.0])];
        landmarks.extend((0..40).map(|k| (0, [20.0 + f64::from(k), 0.0])));
        let location = localiser(map_of(&landmarks, 0.01, &[])).locate(&look(&[0, 1]));
        let best = location.best().unwrap();
        assert!(!location.is_ambiguous(), "{location:?}");
        let middle = 0.5 * gap * SENSOR.range;
        assert!(distance(best.position, [middle, 0.0]) < 0.02 * SENSOR.range, "{gap}: {best:?}");
    }
}

#[test]
fn a_map_and_its_mirror_image_give_mirrored_places() {
    let landmarks = hall(300, 0);
    let mirrored: Vec<(u32, Point)> = landmarks.iter().map(|&(c, at)| (c, at.map(|x| -x))).collect();
    let [one, other] = [landmarks, mirrored].map(|landmarks| localiser(map_of(&landmarks, 0.01, &[])));
    // Two crowds whose discs overlap.
    for seen in [[3_u32, 7], [20, 150], [11, 12]] {
        let [a, b] = [&one, &other].map(|localiser| localiser.locate(&look(&seen)));
        assert_eq!(a.modes.len(), b.modes.len());
        for (a, b) in a.modes.iter().zip(&b.modes) {
            assert!((a.probability - b.probability).abs() < 1e-3, "{a:?} {b:?}");
            assert!(distance(a.position, b.position.map(|x| -x)) < 1e-2, "{a:?} {b:?}");
        }
    }
}

#[test]
fn what_a_wall_hides_says_nothing() {
    // 0 to 2 in a row, 3 next to them behind a wall: its not being seen would push the place away.
    let landmarks = [[0.0, 0.0], [0.3, 0.0], [0.6, 0.0], [0.3, 0.2]].map(|at| (0, at));
    let at = |occluded: &[[u32; 2]]| {
        let location = localiser(map_of(&landmarks, 0.01, occluded)).locate(&look(&[0, 1, 2]));
        location.modes.iter().fold(0.0, |sum, mode| sum + mode.probability * mode.position[1])
    };
    let (open, walled) = (at(&[]), at(&[[0, 3], [1, 3], [2, 3]]));
    assert!(open < -0.05, "{open}");
    // Without it nothing tells above from below.
    assert!(walled.abs() < 1e-3, "{walled}");
}

#[test]
fn a_whole_map_seen_at_once_is_no_trouble() {
    let localiser = localiser(map_of(&hall(3000, 0), 0.01, &[]));
    let all: Vec<u32> = (0..3000).collect();
    let location = localiser.locate(&look(&all));
    assert!(location.best().is_some_and(|mode| mode.position.iter().all(|c| c.is_finite())));
    // A map of one landmark, and of three in one place.
    let one = super::tests::localiser(map_of(&[(0, [0.0; 2])], 0.5, &[]));
    assert!(one.locate(&look(&[0])).best().unwrap().squared_distance([0.0; 2]) < 1e-9);
    let pile = super::tests::localiser(map_of(&[(0, [1.0; 2]); 3], 0.01, &[]));
    assert!(pile.locate(&look(&[0, 1, 2])).best().unwrap().squared_distance([1.0; 2]) < 1e-3);
}

#[test]
fn a_map_without_a_sensor_is_refused() {
    let map = GlobalMap::from_parts(
        LandmarkNames::default(),
        Vec::new(),
        MapperParams::default(),
        BuildReport::default(),
    );
    let refused = Localiser::new(Arc::new(MapIndex::new(Arc::new(map.unwrap()))));
    assert!(matches!(refused, Err(PlanError::NoSensor { landmarks: 0 })));
}
