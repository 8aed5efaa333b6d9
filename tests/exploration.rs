//! A robot that explores by the maps it makes, and what its maps say of themselves.

use std::sync::Arc;

use covimap::evaluate::{self, EvaluateParams};
use covimap::plan::{ExploreParams, MapIndex, forecast};
use covimap::{MapperParams, Truth};
use covimap_sim::{Floor, SimSpec, Simulation, World};

#[path = "../examples/05_explore/closed_loop.rs"]
mod closed_loop;

use closed_loop::{explored, map_of};

const STEPS: usize = 500;

#[test]
fn an_explorer_starts_as_a_wanderer_and_then_goes_its_own_way() {
    let spec = SimSpec::paper_room(15, 1.5, STEPS as u64);
    let world = World::new(&spec.world, 1).unwrap();
    let walk = Simulation::new(&world, &spec.run, 1).unwrap().record();
    let walk: Vec<Vec<u32>> = walk.steps().map(|step| step.seen.to_vec()).collect();
    let tour = explored(&world, &spec.run, STEPS, 1).unwrap();
    assert_eq!(tour.len(), STEPS);
    assert_eq!(tour[..20], walk[..20]);
    assert_ne!(tour, walk);
    assert_eq!(tour, explored(&world, &spec.run, STEPS, 1).unwrap());
}

/// Measured over ten seeds: 1.1 to 1.2 times the error found, after 1000 steps.
#[test]
fn the_error_that_a_map_tells_of_itself_is_about_the_error_found() {
    let (mut told, mut found) = (0.0, 0.0);
    for (floor, seed) in [(Floor::Hall {}, 1), (Floor::Hall {}, 2), ("office".parse().unwrap(), 3)] {
        let spec = SimSpec::large(floor, 150, 10);
        let world = World::new(&spec.world, seed).unwrap();
        let names = world.names();
        let ids: Vec<&str> = names.iter().collect();
        let walk = Simulation::new(&world, &spec.run, seed).unwrap().record();
        let walk: Vec<Vec<u32>> = walk.steps().map(|step| step.seen.to_vec()).collect();
        let map = map_of(&walk, &ids, MapperParams::default()).unwrap();
        let mut truth = Vec::new();
        covimap_sim::write_truth(&world, &mut truth).unwrap();
        let truth = Truth::parse(&truth, "truth").unwrap();
        let errors = evaluate::against(&map, &truth, &EvaluateParams::default()).unwrap();
        found += errors.local_orientation_error.unwrap();
        told += forecast(&MapIndex::new(Arc::new(map)), ExploreParams::default()).unwrap().error;
    }
    assert!((0.7..1.6).contains(&(told / found)), "{told} {found}");
}
