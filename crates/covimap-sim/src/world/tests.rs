use super::*;
use crate::geometry::{Rect, Segment};

fn world(floor: Floor, landmarks: usize, seed: u64) -> World {
    World::new(&WorldSpec { floor, landmarks, ..WorldSpec::default() }, seed).unwrap()
}

/// Tiles that can be reached from tile 0 through openings of at least the given width.
fn reachable(plan: &FloorPlan, width: f64) -> usize {
    let mut reached = vec![false; plan.tiles().len()];
    reached[0] = true;
    for _ in plan.tiles() {
        for portal in plan.portals().iter().filter(|portal| portal.opening.length() >= width) {
            let [a, b] = portal.tiles;
            let either = reached[a] || reached[b];
            (reached[a], reached[b]) = (either, either);
        }
    }
    reached.iter().filter(|&&reached| reached).count()
}

fn overlap(a: &Rect, b: &Rect) -> bool {
    (0..2).all(|axis| a.min[axis] < b.max[axis] - 1e-9 && b.min[axis] < a.max[axis] - 1e-9)
}

#[test]
fn every_floor_has_the_wanted_area_in_tiles_that_do_not_overlap() {
    for floor in Floor::ALL {
        for landmarks in [20, 100, 800, 3000] {
            let world = world(floor, landmarks, 5);
            let (tiles, wanted) = (world.plan().tiles(), landmarks as f64 / 10.0);
            let area = world.plan().area();
            assert!((area - wanted).abs() < 1e-9 * wanted, "{} {landmarks}: {area}", floor.name());
            for (number, tile) in tiles.iter().enumerate() {
                assert!(tile.area() > 0.0, "{} {landmarks}: {tile:?}", floor.name());
                assert!(!tiles[..number].iter().any(|other| overlap(tile, other)), "{}", floor.name());
            }
        }
    }
}

#[test]
fn every_part_of_every_floor_can_be_reached() {
    for floor in Floor::ALL {
        for (landmarks, seed) in [(20, 1), (100, 2), (800, 3), (800, 4), (3000, 5)] {
            let world = world(floor, landmarks, seed);
            let tiles = world.plan().tiles().len();
            assert_eq!(reachable(world.plan(), 0.25), tiles, "{} {landmarks} {seed}", floor.name());
        }
    }
}

#[test]
fn one_landmark_is_enough_for_a_world() {
    for floor in Floor::ALL {
        let spec = WorldSpec { floor, landmarks: 1, density: 0.1, ..WorldSpec::default() };
        assert_eq!(World::new(&spec, 1).unwrap().landmarks().len(), 1, "{}", floor.name());
    }
}

#[test]
fn landmarks_stand_on_the_floor_and_depend_on_the_seed_alone() {
    for floor in Floor::ALL {
        let first = world(floor, 300, 1);
        assert_eq!(first.landmarks().len(), 300);
        for &place in first.landmarks() {
            assert!(first.plan().tiles().iter().any(|tile| tile.contains(place)), "{place:?}");
        }
        assert_eq!(first, world(floor, 300, 1));
        assert_ne!(first.landmarks(), world(floor, 300, 2).landmarks());
    }
}

#[test]
fn ring_and_horseshoe_have_the_proportions_of_their_formulas() {
    // Ring: 64 m^2 = 16 s^2 / 25 gives s = 10, w = 2. Horseshoe: 52 m^2 = 13 s^2 / 25 gives the same.
    let close = |a: f64, b: f64| (a - b).abs() < 1e-12;
    for (floor, landmarks, tiles) in [(Floor::Ring {}, 640, 4), (Floor::Horseshoe {}, 520, 3)] {
        let world = world(floor, landmarks, 1);
        let bounds = world.plan().bounds();
        assert!(close(bounds.max[0], 10.0) && close(bounds.max[1], 10.0), "{bounds:?}");
        assert!(close(world.plan().tiles()[0].max[1], 2.0));
        assert_eq!(world.plan().tiles().len(), tiles);
        assert_eq!(world.plan().portals().len(), tiles - usize::from(tiles == 3));
    }
}

#[test]
fn walls_between_the_turns_of_a_spiral_are_as_thick_as_set() {
    let world = world(Floor::Spiral { corridor: 1.0, wall: 0.2 }, 800, 1);
    // Legs 1 and 5 run the same way, one turn apart: legs 2 to 4 carry the corner 2 - 1 = 1 pitch down and
    // leg 5 starts there, so the corridor of leg 5 ends 0.2 m below that of leg 1.
    let [first, fifth] = [0, 4].map(|leg| world.plan().tiles()[leg]);
    assert!((first.min[1] - fifth.max[1] - 0.2).abs() < 1e-12, "{first:?} {fifth:?}");
    assert_eq!(world.plan().portals().len(), world.plan().tiles().len() - 1);
}

#[test]
fn a_corridor_tree_has_no_loops() {
    for seed in 0..5 {
        let world = world(Floor::CorridorTree { corridor: 1.0, pitch: 3.0 }, 800, seed);
        let plan = world.plan();
        // 80 m^2 = 3 m - 2 for m nodes: 27 squares and 26 corridors.
        assert_eq!(plan.tiles().len(), 53);
        assert_eq!(plan.portals().len(), plan.tiles().len() - 1);
    }
}

fn office(missing_doors: f64, seed: u64) -> World {
    world(Floor::Office { room: 3.0, door: 0.9, missing_doors }, 1440, seed)
}

#[test]
fn an_office_lacks_the_doors_it_is_told_to_lack_but_none_that_is_needed() {
    // 144 m^2 are 4 x 4 rooms of 3 m with 2 * 4 * 3 = 24 shared walls; 15 doors join 16 rooms.
    for (missing, doors) in [(0.0, 24), (0.1, 22), (0.25, 18), (1.0, 15)] {
        for seed in 0..5 {
            let world = office(missing, seed);
            assert_eq!(world.plan().tiles().len(), 16);
            assert_eq!(world.plan().portals().len(), doors, "share {missing}");
            assert_eq!(reachable(world.plan(), 0.89), 16);
            for portal in world.plan().portals() {
                assert!((portal.opening.length() - 0.9).abs() < 1e-9);
            }
        }
    }
}

#[test]
fn doors_wider_than_their_walls_are_refused() {
    for floor in [Floor::TwoRooms { door: 2.0 }, Floor::Office { room: 1.0, door: 1.5, missing_doors: 0.0 }] {
        let spec = WorldSpec { floor, landmarks: 60, ..WorldSpec::default() };
        let error = World::new(&spec, 1).unwrap_err();
        assert!(matches!(error, SimError::DoorTooWide { .. }), "{error}");
    }
}

#[test]
fn solid_landmarks_keep_their_gap_from_each_other_and_from_walls() {
    let spec = WorldSpec {
        landmarks: 30,
        density: 30.0 / 2.25,
        diameter: 0.048,
        min_gap: 0.1,
        ..WorldSpec::default()
    };
    for seed in 0..10 {
        let world = World::new(&spec, seed).unwrap();
        for (number, a) in world.landmarks().iter().enumerate() {
            for b in &world.landmarks()[..number] {
                assert!((a[0] - b[0]).hypot(a[1] - b[1]) >= 0.148);
            }
            assert!(world.plan().walls().iter().all(|wall| wall.distance_to_point(*a) >= 0.124));
        }
    }
}

#[test]
fn landmarks_that_do_not_fit_are_an_error_with_their_number() {
    let spec = WorldSpec { landmarks: 200, diameter: 0.048, min_gap: 0.4, ..WorldSpec::default() };
    match World::new(&spec, 1).unwrap_err() {
        SimError::Crowded { placed, wanted: 200, gap } => {
            assert!((20..110).contains(&placed), "{placed} discs of 0.448 m on 20 m^2");
            assert!((gap - 0.4).abs() < 1e-12);
        }
        other => panic!("{other}"),
    }
}

#[test]
fn density_rises_to_the_right_by_the_contrast() {
    let spec = WorldSpec { landmarks: 20_000, contrast: 9.0, ..WorldSpec::default() };
    let world = World::new(&spec, 1).unwrap();
    let bounds = world.plan().bounds();
    // Density 9^s: the share left of s is (9^s - 1) / 8. Left half (3 - 1) / 8 = 0.25, first tenth
    // (9^0.1 - 1) / 8 = 0.0307. Standard deviation of the first is 0.003, of the second 0.0012.
    let share = |limit: f64| {
        let count = world.landmarks().iter().filter(|at| at[0] < limit * bounds.max[0]).count();
        count as f64 / 20_000.0
    };
    assert!((share(0.5) - 0.25).abs() < 0.015, "{}", share(0.5));
    assert!((share(0.1) - 0.0307).abs() < 0.006, "{}", share(0.1));
}

#[test]
fn walls_close_the_floor() {
    // A way from any landmark out of the world meets a wall, an odd number of times if it meets no partition.
    for floor in [Floor::Ring {}, Floor::Horseshoe {}, Floor::Blocks { street: 1.0, building: 2.0 }] {
        let world = world(floor, 200, 3);
        let far = world.plan().bounds().max[0] + 1.0;
        for &place in world.landmarks() {
            let out = Segment { a: place, b: [far, place[1] + 0.123] };
            let met = world.plan().walls().iter().filter(|wall| wall.crosses(&out)).count();
            assert_eq!(met % 2, 1, "{} {place:?}", floor.name());
        }
    }
}
