//! Whether places found on built maps are where the robot truly was, on steps the map was not built of.

use std::sync::Arc;

use covimap::embed::{Correspondence, Point, ProcrustesOptions, procrustes};
use covimap::plan::{Localiser, MapIndex};
use covimap::{Mapper, MapperParams, SightingLog, Silent};
use covimap_sim::{Floor, SimSpec, Simulation, World};

/// One step in so many is held out.
const HELD_OUT: usize = 20;

/// What held-out steps of a world give.
struct Found {
    /// Distances from the truth over the visibility range.
    errors: Vec<f64>,
    /// Share of the steps whose truth lies in the 95 % region.
    inside: f64,
    lost: usize,
}

fn locate(floor: Floor, landmarks: usize, seed: u64) -> Found {
    let spec = SimSpec::large(floor, landmarks, 40);
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
    found.inside /= found.errors.len() as f64;
    found.errors.sort_by(f64::total_cmp);
    println!(
        "{} {seed}: {} steps, range {range:.3} rmse/range {:.3}, median {:.3} p95 {:.3}, inside {:.3}, lost {}",
        floor.name(),
        found.errors.len(),
        fit.rmse / 0.55,
        found.errors[found.errors.len() / 2],
        found.errors[found.errors.len() * 95 / 100],
        found.inside,
        found.lost,
    );
    found
}

#[test]
fn measure() {
    for floor in [
        Floor::Hall {},
        Floor::Blocks { street: 1.0, building: 2.0 },
        Floor::Office { room: 3.0, door: 0.9, missing_doors: 0.1 },
    ] {
        for seed in 1..=3 {
            locate(floor, 800, seed);
        }
    }
}
