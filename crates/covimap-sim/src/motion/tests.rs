use std::f64::consts::{FRAC_PI_4, PI};

use super::*;
use crate::angle::{Angle, wrap};
use crate::floor_plan::FloorPlan;
use crate::geometry::{Rect, Segment};
use crate::spec::{Floor, SimSpec, StepSpec, WorldSpec};

fn world(floor: Floor, landmarks: usize) -> World {
    World::new(&WorldSpec { floor, landmarks, ..WorldSpec::default() }, 3).unwrap()
}

fn poses(world: &World, spec: &RunSpec, seed: u64) -> Vec<Pose> {
    let mut journey = Journey::new(world, spec, seed).unwrap();
    (0..spec.steps).map(|_| journey.next()).collect()
}

fn run(motion: Motion, steps: u64) -> RunSpec {
    RunSpec { motion, steps, ..RunSpec::default() }
}

fn is_on_floor(world: &World, at: Point) -> bool {
    world.plan().tiles().iter().any(|tile| tile.contains(at))
}

#[test]
fn no_motion_leaves_the_floor_or_comes_near_a_wall() {
    for floor in Floor::ALL {
        let world = world(floor, 300);
        for motion in Motion::ALL {
            let poses = poses(&world, &run(motion, 3000), 5);
            for pair in poses.windows(2) {
                let way = Segment { a: pair[0].at, b: pair[1].at };
                assert!(is_on_floor(&world, way.b), "{} {}", floor.name(), motion.name());
                let is_way = !matches!(motion, Motion::Scatter {});
                let clear = |wall: &Segment| {
                    !is_way && wall.distance_to_point(way.b) > 0.05 || wall.distance_to(&way) > 0.05
                };
                assert!(world.plan().walls().iter().all(clear), "{} {}", floor.name(), motion.name());
            }
        }
    }
}

#[test]
fn a_robot_without_extent_does_not_pass_walls_either() {
    let world = world(Floor::Office { room: 1.5, door: 0.5, missing_doors: 0.5 }, 300);
    let step = StepSpec { clearance: 0.0, ..StepSpec::default() };
    let poses = poses(&world, &RunSpec { step, ..run(Motion::Wander {}, 5000) }, 1);
    for pair in poses.windows(2) {
        let way = Segment { a: pair[0].at, b: pair[1].at };
        assert!(!world.plan().walls().iter().any(|wall| wall.crosses(&way)));
    }
}

#[test]
fn solid_landmarks_are_gone_round() {
    let spec = SimSpec::paper_room(30, 1.5, 3000);
    for motion in Motion::ALL {
        let world = World::new(&spec.world, 1).unwrap();
        let poses = poses(&world, &RunSpec { motion, ..spec.run.clone() }, 1);
        for pair in poses.windows(2) {
            let start = if matches!(motion, Motion::Scatter {}) { pair[1].at } else { pair[0].at };
            let way = Segment { a: start, b: pair[1].at };
            // Radius 0.024 and clearance 0.04.
            assert!(world.landmarks().iter().all(|&at| way.distance_to_point(at) > 0.064 - 1e-12));
        }
    }
}

#[test]
fn steps_in_the_open_turn_and_reach_as_far_as_set() {
    // In a hall of 100 m hardly any step meets a wall.
    let world =
        World::new(&WorldSpec { landmarks: 10_000, density: 1.0, ..WorldSpec::default() }, 1).unwrap();
    let poses = poses(&world, &run(Motion::Wander {}, 4000), 2);
    let hall = Rect { min: [1.0; 2], max: [99.0; 2] };
    let open: Vec<_> = poses.windows(2).filter(|pair| hall.contains(pair[0].at)).collect();
    let lengths = open.iter().map(|p| (p[1].at[0] - p[0].at[0]).hypot(p[1].at[1] - p[0].at[1]));
    let turns = open.iter().map(|p| wrap(p[1].heading - p[0].heading));
    assert!(lengths.clone().all(|length| (0.1 - 1e-9..0.2 + 1e-9).contains(&length)));
    assert!(turns.clone().all(|turn| turn.abs() <= FRAC_PI_4 + 1e-9));
    // Uniform: mean length 0.15 and mean turn 0; standard errors 0.0005 and 0.007 of 4000 steps.
    let count = open.len() as f64;
    assert!(count > 2000.0);
    assert!((lengths.sum::<f64>() / count - 0.15).abs() < 0.003);
    assert!((turns.clone().sum::<f64>() / count).abs() < 0.05);
    // Mean square of a uniform turn: (pi / 4)^2 / 3 = 0.2056.
    assert!((turns.map(|turn| turn * turn).sum::<f64>() / count - 0.2056).abs() < 0.02);
}

#[test]
fn headings_point_along_the_steps() {
    let world = world(Floor::Hall {}, 300);
    for pair in poses(&world, &run(Motion::Wander {}, 500), 1).windows(2) {
        let away = wrap(bearing(pair[0].at, pair[1].at) - pair[1].heading);
        assert!(pair[0].at == pair[1].at || away.abs() < 1e-9);
        assert!((0.0..2.0 * PI).contains(&pair[1].heading));
    }
}

#[test]
fn without_turns_the_robot_goes_straight_until_something_is_in_its_way() {
    let world = world(Floor::Hall {}, 800);
    let step = StepSpec { turn: Angle::from_deg(0.0), ..StepSpec::default() };
    let poses = poses(&world, &RunSpec { step, ..run(Motion::Wander {}, 2000) }, 1);
    let bounds = world.plan().bounds();
    let inside = Rect { min: [0.3; 2], max: bounds.max.map(|far| far - 0.3) };
    let in_the_open: Vec<_> = poses.windows(2).filter(|pair| inside.contains(pair[0].at)).collect();
    assert!(in_the_open.len() > 1000);
    assert!(in_the_open.iter().all(|pair| wrap(pair[1].heading - pair[0].heading).abs() < 1e-9));
}

#[test]
fn all_motions_but_way_points_come_past_every_part_of_a_corridor() {
    // 2000 landmarks: 125 and 200 m of corridor. A random walk needs far more than 40 steps a landmark.
    for floor in
        [Floor::Spiral { corridor: 1.6, wall: 0.2 }, Floor::CorridorTree { corridor: 1.0, pitch: 3.0 }]
    {
        let world = world(floor, 2000);
        for motion in [Motion::Patrol {}, Motion::Sweep { lane: 0.5 }, Motion::Scatter {}] {
            let poses = poses(&world, &run(motion, 80_000), 1);
            let patches = Patches::new(world.plan(), 0.05).unwrap();
            let mut calls = vec![0; patches.len()];
            for pose in poses {
                calls[patches.at(pose.at)] += 1;
            }
            let least = *calls.iter().min().unwrap();
            assert!(least >= 100, "{} {}: {least} of 600 on average", floor.name(), motion.name());
        }
    }
}

#[test]
fn an_opening_as_wide_as_the_robot_is_no_doorway() {
    // 1.1 - 1.0 is more than 0.1 by rounding: a passage of no length.
    let left = Rect { min: [0.0, 0.0], max: [1.0, 1.1] };
    let reached = |bottom: f64| {
        let right = Rect { min: [1.0, bottom], max: [2.0, 2.0] };
        Patches::new(&FloorPlan::new(vec![left, right], Vec::new()), 0.05)
    };
    assert!(matches!(reached(1.0), Err(SimError::OutOfReach { cut_off: 1, patches: 2, .. })));
    let passage = reached(0.9).unwrap().doorways(0)[0].passage;
    assert!((passage.length() - 0.1).abs() < 1e-12, "{passage:?}");
}

#[test]
fn way_points_are_reached_through_doors() {
    let world = world(Floor::Office { room: 2.0, door: 0.9, missing_doors: 0.3 }, 800);
    let poses = poses(&world, &run(Motion::Waypoints {}, 20_000), 1);
    for (room, tile) in world.plan().tiles().iter().enumerate() {
        let calls = poses.iter().filter(|pose| tile.contains(pose.at)).count();
        assert!(calls > 200, "room {room}: {calls} of 1250 on average");
    }
}

#[test]
fn a_sweep_goes_to_and_fro_in_lanes() {
    let tile = Rect { min: [0.0; 2], max: [3.0, 1.0] };
    let plan = FloorPlan::new(vec![tile], Vec::new());
    let goals = sweep::goals(&plan, 0.5);
    assert_eq!(goals, [[0.25, 0.25], [2.75, 0.25], [2.75, 0.75], [0.25, 0.75]]);
}

#[test]
fn a_sweep_visits_every_tile_once_a_round() {
    let world = world(Floor::Blocks { street: 1.0, building: 2.0 }, 800);
    let goals = sweep::goals(world.plan(), 0.5);
    for tile in world.plan().tiles() {
        assert!(goals.iter().filter(|&&goal| tile.contains(goal)).count() >= 2);
    }
}

#[test]
fn several_robots_start_one_after_another() {
    let world = world(Floor::Hall {}, 800);
    let poses = poses(&world, &RunSpec { robots: 4, ..run(Motion::Wander {}, 1001) }, 1);
    // 1001 steps among 4: 251 each but for the last one.
    for (number, pair) in poses.windows(2).enumerate() {
        let jump = (pair[1].at[0] - pair[0].at[0]).hypot(pair[1].at[1] - pair[0].at[1]) > 0.201;
        assert_eq!(jump, (number + 1) % 251 == 0, "step {number}");
    }
}

#[test]
fn a_robot_that_fits_nowhere_is_an_error() {
    let world = world(Floor::Hall {}, 10);
    let step = StepSpec { clearance: 0.6, ..StepSpec::default() };
    let error = Journey::new(&world, &RunSpec { step, ..RunSpec::default() }, 1).err().unwrap();
    assert!(matches!(error, SimError::NoFreePlace { .. }), "{error}");
}

#[test]
fn a_robot_that_passes_no_door_wanders_but_cannot_plan_its_way() {
    let world = world(Floor::TwoRooms { door: 0.3 }, 800);
    let step = StepSpec { clearance: 0.2, ..StepSpec::default() };
    assert!(Journey::new(&world, &RunSpec { step, ..run(Motion::Wander {}, 10) }, 1).is_ok());
    for motion in [Motion::Patrol {}, Motion::Waypoints {}, Motion::Sweep { lane: 0.5 }] {
        match Journey::new(&world, &RunSpec { step, ..run(motion, 10) }, 1).err().unwrap() {
            SimError::OutOfReach { cut_off, patches, .. } => assert_eq!(2 * cut_off, patches),
            other => panic!("{other}"),
        }
    }
}
