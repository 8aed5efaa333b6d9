use std::f64::consts::PI;

use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use rand_chacha::ChaCha8Rng;

use super::arcs::Arcs;
use super::*;
use crate::angle::wrap;
use crate::geometry::{Point, Segment};
use crate::landmarks::FreeSpace;
use crate::spec::{Floor, SimSpec, WorldSpec};

fn world(floor: Floor, landmarks: usize) -> World {
    World::new(&WorldSpec { floor, landmarks, ..WorldSpec::default() }, 3).unwrap()
}

fn random_poses(world: &World, count: usize) -> Vec<Pose> {
    let mut rng: ChaCha8Rng = stream(9, Stream::Motion);
    let space = FreeSpace::new(world.plan());
    (0..count).map(|_| Pose { at: space.draw(&mut rng), heading: rng.random_range(0.0..2.0 * PI) }).collect()
}

/// All that an observer sees from the poses.
fn observe(world: &World, spec: &SensorSpec, errors: ErrorSpec, poses: &[Pose], seed: u64) -> Vec<Vec<u32>> {
    let mut observer = Observer::new(world, spec, errors, seed).unwrap();
    let mut seen = Vec::new();
    poses
        .iter()
        .map(|&pose| {
            observer.observe(pose, &mut seen);
            seen.clone()
        })
        .collect()
}

fn offset(pose: Pose, place: Point) -> Point {
    [place[0] - pose.at[0], place[1] - pose.at[1]]
}

// Arcs.

/// Share of the arc that is not covered, by looking at many bearings.
fn uncovered_by_sampling(covered: &[(f64, f64)], middle: f64, half: f64) -> f64 {
    let samples = 4000;
    let bearings =
        (0..samples).map(|i| middle - half + 2.0 * half * (f64::from(i) + 0.5) / f64::from(samples));
    let free = bearings.filter(|b| !covered.iter().any(|&(m, h)| wrap(b - m).abs() < h)).count();
    2.0 * half * free as f64 / f64::from(samples)
}

proptest! {
    #![proptest_config(ProptestConfig { rng_seed: RngSeed::Fixed(7), ..ProptestConfig::default() })]

    #[test]
    fn what_arcs_leave_uncovered_is_what_sampling_finds(
        covered in prop::collection::vec((-10.0..10.0_f64, 0.0..1.5_f64), 0..8),
        (middle, half) in (-10.0..10.0_f64, 0.001..1.57_f64),
    ) {
        let mut arcs = Arcs::default();
        for &(middle, half) in &covered {
            arcs.cover(middle, half);
        }
        // Each end of a covered arc is off by less than one sample.
        let tolerance = 2.0 * half * (2 * covered.len() + 1) as f64 / 4000.0;
        let expected = uncovered_by_sampling(&covered, middle, half);
        prop_assert!((arcs.uncovered(middle, half) - expected).abs() <= tolerance);
        arcs.cover(middle, half);
        prop_assert!(arcs.uncovered(middle, half) == 0.0);
    }
}

#[test]
fn a_field_of_view_covers_everything_behind() {
    let mut arcs = Arcs::default();
    arcs.reset_outside(0.5);
    assert!((arcs.uncovered(0.0, 0.2) - 0.4).abs() < 1e-12);
    assert!((arcs.uncovered(0.5, 0.2) - 0.2).abs() < 1e-12, "half of it is outside");
    assert!(arcs.uncovered(PI, 0.2) == 0.0);
    arcs.reset_outside(PI);
    assert!((arcs.uncovered(PI, 0.2) - 0.4).abs() < 1e-12);
}

// Visual angle.

/// The angle of each cylinder that is met first by one of many evenly spread rays.
fn cast_rays(world: &World, pose: Pose, half_view: f64, rays: u32) -> Vec<f64> {
    let radius = world.diameter() / 2.0;
    let mut shows = vec![0.0; world.landmarks().len()];
    for ray in 0..rays {
        let turn = -PI + 2.0 * PI * (f64::from(ray) + 0.5) / f64::from(rays);
        let (sin, cos) = (pose.heading + turn).sin_cos();
        let met = |place: Point| {
            let [x, y] = offset(pose, place);
            let (along, beside) = (x * cos + y * sin, x * sin - y * cos);
            (along > 0.0 && beside.abs() < radius).then(|| along - (radius * radius - beside * beside).sqrt())
        };
        let met = (0..).zip(world.landmarks()).filter_map(|(number, &place)| Some((met(place)?, number)));
        let first: Option<(f64, usize)> = met.min_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((_, number)) = first.filter(|_| turn.abs() < half_view) {
            shows[number] += 2.0 * PI / f64::from(rays);
        }
    }
    shows
}

#[test]
fn what_shows_of_each_cylinder_is_what_rays_find() {
    // Crowded, so that many cylinders hide others: 3 cm between surfaces.
    let mut spec = SimSpec::paper_room(60, 1.2, 1).world;
    spec.min_gap = 0.03;
    let world = World::new(&spec, 1).unwrap();
    let free = |pose: &Pose| {
        world.landmarks().iter().all(|&at| offset(*pose, at)[0].hypot(offset(*pose, at)[1]) > 0.03)
    };
    let poses: Vec<Pose> = random_poses(&world, 60).into_iter().filter(free).collect();
    let mut partly = 0;
    for half_view in [PI, PI / 3.0, PI / 4.0] {
        let mut camera = Camera::new(&world, half_view, 0.0);
        for &pose in &poses {
            let rays = 20_000;
            let mut shows = cast_rays(&world, pose, half_view, rays);
            for (number, angle) in camera.look(pose) {
                // Hardly a cylinder shows in more than three pieces; each end is off by less than a ray.
                let tolerance = 6.0 * 2.0 * PI / f64::from(rays);
                let by_rays = std::mem::replace(&mut shows[number as usize], 0.0);
                assert!((angle - by_rays).abs() < tolerance, "{angle} {by_rays} from {pose:?}");
                partly += usize::from(angle > 0.0 && angle < 0.8 * full_angle(&world, pose, number));
            }
            assert!(shows.iter().all(|&left| left == 0.0), "every cylinder was looked at");
        }
    }
    assert!(partly > 500, "{partly} cylinders were partly hidden");
}

fn full_angle(world: &World, pose: Pose, number: u32) -> f64 {
    let [x, y] = offset(pose, world.landmarks()[number as usize]);
    2.0 * (world.diameter() / 2.0 / x.hypot(y)).asin()
}

#[test]
fn a_sharp_threshold_recognises_a_lone_cylinder_up_to_the_distance_of_the_paper() {
    // 0.024 / sin(2.5 degrees) = 0.5502 m.
    let world = World::new(&SimSpec::paper_room(1, 1.5, 1).world, 1).unwrap();
    let [x, y] = world.landmarks()[0];
    let spec = SensorSpec { recognition: Recognition::paper(), ..SensorSpec::default() };
    let towards = if x > 0.75 { -1.0 } else { 1.0 };
    for (distance, expected) in [(0.05, 1), (0.549, 1), (0.551, 0), (0.7, 0)] {
        let pose = Pose { at: [x + towards * distance, y], heading: 0.0 };
        let seen = observe(&world, &spec, ErrorSpec::default(), &[pose], 1);
        assert_eq!(seen[0].len(), expected, "{distance} m");
    }
}

#[test]
fn leaving_out_what_is_too_far_changes_nothing() {
    let world = World::new(&SimSpec::paper_room(30, 1.5, 1).world, 2).unwrap();
    let least = 5_f64.to_radians();
    let mut near = Camera::new(&world, PI, least);
    let mut all = Camera::new(&world, PI, 0.0);
    for pose in random_poses(&world, 200) {
        let enough = |&(_, angle): &(u32, f64)| angle > least;
        let expected: Vec<_> = all.look(pose).filter(enough).collect();
        assert_eq!(near.look(pose).filter(enough).collect::<Vec<_>>(), expected);
    }
}

#[test]
fn the_logistic_curve_is_that_of_the_paper() {
    // K = 100 per radian, 1 degree = 0.01745 rad above the threshold: 1 / (1 + e^-1.745) = 0.8514.
    let threshold = 5_f64.to_radians();
    let at = |degrees: f64| visual_angle::chance(degrees.to_radians(), threshold, Some(100.0));
    assert!((at(6.0) - 0.8514).abs() < 1e-4);
    assert!((at(5.0) - 0.5).abs() < 1e-12);
    assert!((at(4.0) - 0.1486).abs() < 1e-4);
    assert!(at(0.0) == 0.0, "what is hidden is never recognised");
}

#[test]
fn logistic_recognition_happens_as_often_as_the_curve_says() {
    let world = World::new(&SimSpec::paper_room(1, 1.5, 1).world, 1).unwrap();
    let [x, y] = world.landmarks()[0];
    let recognition =
        Recognition::VisualAngle { threshold: [Angle::from_deg(5.0); 2], steepness: Some(100.0) };
    let spec = SensorSpec { recognition, ..SensorSpec::default() };
    for degrees in [4.0, 5.0, 6.0, 7.0_f64] {
        let distance = 0.024 / (degrees.to_radians() / 2.0).sin();
        let pose = Pose { at: [if x > 0.75 { x - distance } else { x + distance }, y], heading: 0.0 };
        let seen = observe(&world, &spec, ErrorSpec::default(), &vec![pose; 10_000], 1);
        let share = seen.iter().filter(|seen| !seen.is_empty()).count() as f64 / 10_000.0;
        let expected = 1.0 / (1.0 + (-100.0 * (degrees - 5.0).to_radians()).exp());
        // Standard deviation at most 0.005.
        assert!((share - expected).abs() < 0.02, "{degrees} degrees: {share}, not {expected}");
    }
}

#[test]
fn each_landmark_has_its_own_threshold_between_the_two() {
    let world = World::new(&SimSpec::paper_room(30, 1.5, 1).world, 1).unwrap();
    let spec = |threshold: [f64; 2]| {
        let threshold = threshold.map(Angle::from_deg);
        let recognition = Recognition::VisualAngle { threshold, steepness: None };
        SensorSpec { recognition, ..SensorSpec::default() }
    };
    let poses = random_poses(&world, 400);
    let seen = |threshold| observe(&world, &spec(threshold), ErrorSpec::default(), &poses, 1);
    let (low, own, high) = (seen([4.0, 4.0]), seen([4.0, 8.0]), seen([8.0, 8.0]));
    for ((low, own), high) in low.iter().zip(&own).zip(&high) {
        assert!(own.iter().all(|number| low.contains(number)));
        assert!(high.iter().all(|number| own.contains(number)));
    }
    let total = |lists: &[Vec<u32>]| lists.iter().map(Vec::len).sum::<usize>();
    assert!(total(&low) > total(&own) && total(&own) > total(&high));
}

#[test]
fn points_have_no_visual_angle() {
    let world = world(Floor::Hall {}, 10);
    let spec = SensorSpec { recognition: Recognition::paper(), ..SensorSpec::default() };
    let error = Observer::new(&world, &spec, ErrorSpec::default(), 1).err().unwrap();
    assert!(matches!(error, SimError::SolidNeeded), "{error}");
}

// Range.

/// A sensor that recognises whatever is within 0.5 m and in sight.
fn sharp() -> SensorSpec {
    let recognition = Recognition::Range { range: 0.5, edge: 1e-9, detection: 1.0 };
    SensorSpec { recognition, ..SensorSpec::default() }
}

#[test]
fn lines_of_sight_are_those_of_looking_at_every_wall() {
    for floor in Floor::ALL {
        let world = world(floor, 400);
        let poses = random_poses(&world, 300);
        let mut hidden = 0;
        for (pose, seen) in poses.iter().zip(observe(&world, &sharp(), ErrorSpec::default(), &poses, 1)) {
            for (number, &place) in (0_u32..).zip(world.landmarks()) {
                let sight = Segment { a: pose.at, b: place };
                let is_hidden = world.plan().walls().iter().any(|wall| wall.crosses(&sight));
                let is_near = sight.length() < 0.5;
                assert_eq!(seen.contains(&number), is_near && !is_hidden, "{} {number}", floor.name());
                hidden += usize::from(is_near && is_hidden);
            }
        }
        assert!(hidden > 0 || matches!(floor, Floor::Hall {}), "{}: walls hid nothing", floor.name());
    }
}

#[test]
fn recognition_by_range_happens_as_often_as_the_curve_says() {
    // One landmark in the middle of a wide hall, looked at from everywhere around.
    let world = World::new(&WorldSpec { landmarks: 1, density: 0.01, ..WorldSpec::default() }, 4).unwrap();
    let [x, y] = world.landmarks()[0];
    for detection in [0.5, 0.95] {
        let recognition = Recognition::Range { range: 0.55, edge: 0.04, detection };
        let spec = SensorSpec { recognition, ..SensorSpec::default() };
        for distance in [0.1, 0.47, 0.53, 0.55, 0.6, 0.65, 0.9] {
            let pose = Pose { at: [x + distance, y], heading: 0.0 };
            let seen = observe(&world, &spec, ErrorSpec::default(), &vec![pose; 10_000], 1);
            let share = seen.iter().filter(|seen| !seen.is_empty()).count() as f64 / 10_000.0;
            let expected = detection / (1.0 + ((distance - 0.55) / 0.04_f64).exp());
            assert!((share - expected).abs() < 0.02, "{distance} m: {share}, not {expected}");
        }
    }
}

#[test]
fn only_what_is_in_the_field_of_view_is_seen() {
    let world = world(Floor::Hall {}, 400);
    let poses = random_poses(&world, 300);
    let narrow = SensorSpec { view: Angle::from_deg(90.0), ..sharp() };
    let all = observe(&world, &sharp(), ErrorSpec::default(), &poses, 1);
    let seen = observe(&world, &narrow, ErrorSpec::default(), &poses, 1);
    for ((pose, all), seen) in poses.iter().zip(all).zip(seen) {
        let in_view = |&&number: &&u32| {
            let [x, y] = offset(*pose, world.landmarks()[number as usize]);
            x * pose.heading.cos() + y * pose.heading.sin() >= x.hypot(y) * 0.5_f64.sqrt()
        };
        assert_eq!(seen.iter().collect::<Vec<_>>(), all.iter().filter(in_view).collect::<Vec<_>>());
    }
}

#[test]
fn detectability_differs_between_landmarks_and_belongs_to_the_world() {
    let world = world(Floor::Hall {}, 200);
    let poses = random_poses(&world, 20_000);
    let spec = SensorSpec { detectability: [0.2, 0.8], ..sharp() };
    let mut rates = [vec![0.0; 200], vec![0.0; 200]];
    for (rates, seed) in rates.iter_mut().zip([1, 2]) {
        let [all, seen] = [sharp(), spec].map(|spec| {
            let mut counts = vec![0.0; 200];
            for number in observe(&world, &spec, ErrorSpec::default(), &poses, seed).concat() {
                counts[number as usize] += 1.0;
            }
            counts
        });
        *rates = seen.iter().zip(all).map(|(seen, all): (&f64, f64)| seen / all).collect();
    }
    // About 200 to 800 chances each: standard deviation at most 0.035.
    assert!(rates[0].iter().all(|rate| (0.1..0.9).contains(rate)));
    assert!(rates[0].iter().any(|&rate| rate < 0.35) && rates[0].iter().any(|&rate| rate > 0.65));
    assert!(rates[0].iter().zip(&rates[1]).all(|(first, second)| (first - second).abs() < 0.2));
}

// Errors.

#[test]
fn errors_happen_as_often_as_set_and_leave_lists_in_order() {
    let world = world(Floor::Hall {}, 1000);
    let poses = random_poses(&world, 3000);
    let clean = observe(&world, &sharp(), ErrorSpec::default(), &poses, 1);
    let errors = ErrorSpec { missed: 0.1, mistaken: 0.2 };
    let spoilt = observe(&world, &sharp(), errors, &poses, 1);
    let (mut right, mut wrong, mut total) = (0.0, 0.0, 0.0);
    for (clean, spoilt) in clean.iter().zip(&spoilt) {
        assert!(spoilt.windows(2).all(|pair| pair[0] < pair[1]));
        total += clean.len() as f64;
        right += spoilt.iter().filter(|number| clean.contains(number)).count() as f64;
        wrong += spoilt.iter().filter(|number| !clean.contains(number)).count() as f64;
    }
    // Right: 0.9 * 0.8, and a few mistakes that hit another landmark in sight (7 of 1000). About 20 000
    // sightings: standard deviations 0.003.
    assert!(total > 15_000.0);
    assert!((right / total - 0.72).abs() < 0.015, "{}", right / total);
    assert!((wrong / total - 0.18).abs() < 0.015, "{}", wrong / total);
}

#[test]
fn a_higher_rate_loses_the_same_sightings_and_more() {
    let world = world(Floor::Hall {}, 300);
    let poses = random_poses(&world, 500);
    let seen = |missed| observe(&world, &sharp(), ErrorSpec { missed, mistaken: 0.0 }, &poses, 1);
    for (few, many) in seen(0.03).iter().zip(seen(0.2)) {
        assert!(many.iter().all(|number| few.contains(number)));
    }
}

#[test]
fn everything_can_be_lost_and_everything_mistaken() {
    let world = world(Floor::Hall {}, 50);
    let poses = random_poses(&world, 100);
    let lost = observe(&world, &sharp(), ErrorSpec { missed: 1.0, mistaken: 0.0 }, &poses, 1);
    assert!(lost.concat().is_empty());
    let one = self::world(Floor::Hall {}, 1);
    let mistaken = ErrorSpec { missed: 0.0, mistaken: 1.0 };
    let seen = observe(&one, &sharp(), mistaken, &random_poses(&one, 10), 1);
    assert!(seen.concat().iter().all(|&number| number == 0), "there is nothing else to mistake it for");
}
