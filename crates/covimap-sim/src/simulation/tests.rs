use super::*;
use crate::angle::Angle;
use crate::spec::{ErrorSpec, Floor, Motion, SensorSpec, SimSpec, WorldSpec};

/// One specification of every kind.
fn specs() -> Vec<SimSpec> {
    let mut specs = vec![SimSpec::paper_room(15, 1.5, 500)];
    for (number, floor) in Floor::ALL.into_iter().enumerate() {
        let mut spec = SimSpec::large(floor, 200, 3);
        spec.run.motion = Motion::ALL[number % Motion::ALL.len()];
        spec.run.errors = ErrorSpec { missed: 0.1, mistaken: 0.1 };
        spec.run.sensor.detectability = [0.5, 1.0];
        specs.push(spec);
    }
    specs
}

fn record(spec: &SimSpec, world_seed: u64, seed: u64) -> Recording {
    let world = World::new(&spec.world, world_seed).unwrap();
    Simulation::new(&world, &spec.run, seed).unwrap().record()
}

#[test]
fn the_same_specification_and_seeds_give_the_same_run() {
    for spec in specs() {
        let first = record(&spec, 1, 2);
        assert_eq!(first, record(&spec, 1, 2));
        assert_ne!(first, record(&spec, 1, 3));
        assert_ne!(first, record(&spec, 4, 2));
    }
}

#[test]
fn streaming_gives_what_a_recording_keeps() {
    for spec in specs() {
        let recording = record(&spec, 1, 1);
        assert_eq!(recording.len() as u64, spec.run.steps);
        let world = World::new(&spec.world, 1).unwrap();
        let mut simulation = Simulation::new(&world, &spec.run, 1).unwrap();
        for kept in recording.steps() {
            assert_eq!(simulation.next_step().unwrap(), kept);
        }
        assert!(simulation.next_step().is_none());
        assert!(simulation.next_step().is_none(), "and it stays at its end");
    }
}

#[test]
fn a_shorter_run_is_the_beginning_of_a_longer_one() {
    let mut spec = SimSpec::paper_room(15, 1.5, 300);
    let long = record(&spec, 1, 1);
    spec.run.steps = 100;
    let short = record(&spec, 1, 1);
    assert!(short.steps().eq(long.steps().take(100)));
}

#[test]
fn another_sensor_or_other_errors_leave_the_way_as_it_was() {
    let spec = SimSpec::large(Floor::Hall {}, 200, 5);
    let poses = |spec: &SimSpec| record(spec, 1, 1).steps().map(|step| step.pose).collect::<Vec<_>>();
    let mut changed = spec.clone();
    changed.run.sensor = SensorSpec { view: Angle::from_deg(90.0), ..SensorSpec::default() };
    changed.run.errors = ErrorSpec { missed: 0.5, mistaken: 0.5 };
    assert_eq!(poses(&spec), poses(&changed));
    assert_ne!(record(&spec, 1, 1), record(&changed, 1, 1));
}

#[test]
fn other_doors_leave_the_landmarks_where_they_were() {
    let places = |missing_doors| {
        let floor = Floor::Office { room: 3.0, door: 0.9, missing_doors };
        let world = World::new(&WorldSpec { floor, ..WorldSpec::default() }, 1).unwrap();
        world.landmarks().to_vec()
    };
    assert_eq!(places(0.0), places(0.3));
}

#[test]
fn the_summary_counts_what_the_steps_show() {
    let spec = SimSpec::large(Floor::Office { room: 3.0, door: 0.9, missing_doors: 0.1 }, 400, 1);
    let world = World::new(&spec.world, 1).unwrap();
    let mut simulation = Simulation::new(&world, &spec.run, 1).unwrap();
    assert_eq!(simulation.summary().steps, 0);
    assert!(simulation.summary().mean_set_size == 0.0);
    let mut counts = vec![0; 400];
    let mut empty = 0;
    while let Some(step) = simulation.next_step() {
        empty += u64::from(step.seen.is_empty());
        step.seen.iter().for_each(|&number| counts[number as usize] += 1);
    }
    let summary = simulation.summary();
    let never = counts.iter().filter(|&&count| count == 0).count();
    assert!(never > 0, "400 steps are too few to see everything");
    counts.sort_unstable();
    let sightings: u64 = counts.iter().sum();
    let expected = Summary {
        landmarks: 400,
        never_seen: never,
        steps: 400,
        empty_steps: empty,
        sightings,
        mean_set_size: sightings as f64 / 400.0,
        least_sightings: counts[0],
        median_sightings: counts[199],
    };
    assert_eq!(summary, expected);
}

#[test]
fn no_steps_are_a_run_too() {
    let mut spec = SimSpec::paper_room(5, 1.5, 0);
    assert!(record(&spec, 1, 1).is_empty());
    spec.run.robots = 3;
    assert!(record(&spec, 1, 1).is_empty());
}

#[test]
fn large_worlds_are_seen_as_densely_as_intended() {
    // 40 steps a landmark, each within 0.55 m of 0.95 * 10 * pi * 0.55^2 = 9.0 landmarks in the open.
    for floor in Floor::ALL {
        let spec = SimSpec::large(floor, 800, 40);
        let world = World::new(&spec.world, 1).unwrap();
        let mut simulation = Simulation::new(&world, &spec.run, 1).unwrap();
        while simulation.next_step().is_some() {}
        let summary = simulation.summary();
        assert_eq!(summary.never_seen, 0, "{}", floor.name());
        assert!((7.0..9.5).contains(&summary.mean_set_size), "{} {summary:?}", floor.name());
        assert!(summary.median_sightings >= 250, "{} {summary:?}", floor.name());
    }
}

#[test]
fn ranges_are_distances_with_the_noise_asked_for() {
    let mut spec = SimSpec::large(Floor::Hall {}, 100, 40);
    let without = record(&spec, 1, 1);
    assert!(without.steps().all(|step| step.ranges.is_empty()));
    let world = World::new(&spec.world, 1).unwrap();
    for noise in [0.0, 0.1] {
        spec.run.sensor.range_noise = Some(noise);
        let recording = record(&spec, 1, 1);
        let (mut sum, mut square, mut count) = (0.0, 0.0, 0.0);
        for (step, bare) in recording.steps().zip(without.steps()) {
            // The same sightings, each with a range.
            assert_eq!((step.seen, step.pose, step.ranges.len()), (bare.seen, bare.pose, bare.seen.len()));
            for (&number, range) in step.seen.iter().zip(step.ranges) {
                let [x, y] = world.landmarks()[number as usize];
                let off = (range / (x - step.pose.at[0]).hypot(y - step.pose.at[1])).ln();
                (sum, square, count) = (sum + off, square + off * off, count + 1.0);
            }
        }
        // Some 34 000 ranges: standard errors of .1 / sqrt(34000) = .0005 and .7 of that.
        assert!(count > 30_000.0 && (sum / count).abs() < 0.002, "{count} {}", sum / count);
        assert!(((square / count).sqrt() - noise).abs() < 0.002, "{}", square / count);
    }
}

#[test]
fn a_landmark_taken_for_another_has_the_range_of_what_is_there() {
    let mut spec = SimSpec::large(Floor::Hall {}, 100, 5);
    spec.run.sensor.range_noise = Some(0.0);
    spec.run.errors.mistaken = 0.2;
    // Whatever it is called, it stands within reach: 0.55 m and eight times 0.04 m.
    let recording = record(&spec, 1, 1);
    assert!(recording.steps().all(|step| step.ranges.len() == step.seen.len()));
    assert!(recording.steps().all(|step| step.ranges.iter().all(|&range| range > 0.0 && range < 0.87)));
}
