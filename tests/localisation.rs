//! Whether places found on built maps are where the robot truly was, on steps the map was not built of.

use std::sync::Arc;

use covimap::embed::{Correspondence, Point, ProcrustesOptions, procrustes};
use covimap::plan::{Localiser, MapIndex};
use covimap::{Mapper, MapperParams, SightingLog, Silent};
use covimap_sim::{Floor, SimSpec, Simulation, World};

/// One step in so many is held out.
const HELD_OUT: usize = 20;

/// Steps a landmark: what is wrong by chance falls with them, what walls make wrong does not.
const STEPS: [u64; 3] = [20, 40, 100];

/// What held-out steps of a world give.
struct Found {
    /// Distances from the truth over the visibility range.
    errors: Vec<f64>,
    /// Steps whose truth lies in the 95 % region.
    inside: f64,
    lost: usize,
}

fn locate(floor: Floor, landmarks: usize, steps: u64, seed: u64) -> Found {
    let spec = SimSpec::large(floor, landmarks, steps);
    let world = World::new(&spec.world, seed).unwrap();
    let recording = Simulation::new(&world, &spec.run, seed).unwrap().record();
    let is_held_out = |number: &usize| number % HELD_OUT == HELD_OUT / 2;
    let id = |number: &u32| format!("L{number}");
    let ids = |number: usize| recording.step(number).seen.iter().map(id).collect::<Vec<_>>();
    let log = SightingLog::from_steps((0..recording.len()).filter(|n| !is_held_out(n)).map(ids));
    let map = Mapper::new(MapperParams::default()).unwrap().build(&log, &Silent).unwrap();

    let pair = |(number, name): (usize, &str)| Correspondence {
        source: map.landmarks()[number].position,
        target: world.landmarks()[name[1..].parse::<usize>().unwrap()],
        weight: 1.0,
    };
    let pairs: Vec<_> = map.names().iter().enumerate().map(pair).collect();
    let fit = procrustes(&pairs, ProcrustesOptions::default()).unwrap();
    let map_from_world = fit.target_from_source.inverse();
    let localiser = Localiser::new(Arc::new(MapIndex::new(Arc::new(map)))).unwrap();
    let range = localiser.index().map().sensing().unwrap().sensor(0).range;
    let mut found = Found { errors: Vec::new(), inside: 0.0, lost: 0 };
    for number in (0..recording.len()).filter(is_held_out).filter(|&n| !recording.step(n).seen.is_empty()) {
        let look = localiser.look(ids(number).iter().map(String::as_str));
        let location = localiser.locate(&look);
        let truth: Point = map_from_world.apply(recording.step(number).pose.at);
        let best = location.best().unwrap();
        let [dx, dy] = [truth[0] - best.position[0], truth[1] - best.position[1]];
        found.errors.push(dx.hypot(dy) / range);
        found.inside += f64::from(u8::from(best.squared_distance(truth) < 5.99));
        found.lost += usize::from(location.is_lost());
    }
    found
}

/// What is asked over several seeds of logs of so many steps a landmark: a median error below half of the range, and 90 to 98 % inside the
/// region. No more than one look in 200 may be lost.
fn check(floor: &Floor, steps: u64) {
    let (mut errors, mut inside) = (Vec::new(), 0.0);
    for (landmarks, seed) in [(300, 1), (400, 2), (500, 3)] {
        let found = locate(*floor, landmarks, steps, seed);
        assert!(found.lost * 200 <= found.errors.len(), "{} lost of {}", found.lost, found.errors.len());
        inside += found.inside;
        errors.extend(found.errors);
    }
    let count = errors.len();
    errors.sort_by(f64::total_cmp);
    let (median, inside) = (errors[count / 2], inside / count as f64);
    let found = format!("{}, {steps} steps: median {median:.3}, inside {inside:.3} of {count}", floor.name());
    println!("{found}");
    assert!(median < 0.5 && (0.9..=0.98).contains(&inside), "{found}");
}

#[test]
fn in_a_hall() {
    STEPS.iter().for_each(|&steps| check(&Floor::Hall {}, steps));
}

#[test]
fn among_street_blocks() {
    STEPS.iter().for_each(|&steps| check(&Floor::Blocks { street: 1.0, building: 2.0 }, steps));
}

#[test]
fn in_offices() {
    let office = Floor::Office { room: 3.0, door: 0.9, missing_doors: 0.1 };
    STEPS.iter().for_each(|&steps| check(&office, steps));
}
