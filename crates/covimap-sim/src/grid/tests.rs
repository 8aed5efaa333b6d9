use rand::RngExt;

use super::*;
use crate::seed::{Stream, stream};

const BOUNDS: Rect = Rect { min: [-2.0, 1.0], max: [5.0, 4.0] };

fn random_points(count: usize) -> Vec<Point> {
    let mut rng = stream(1, Stream::Landmarks);
    (0..count).map(|_| [rng.random_range(-2.0..5.0), rng.random_range(1.0..4.0)]).collect()
}

#[test]
fn a_search_finds_the_points_that_looking_at_all_of_them_finds() {
    let points = random_points(300);
    for reach in [0.01, 0.3, 1.0, 20.0, f64::INFINITY] {
        let grid = PointGrid::new(&points, BOUNDS, reach);
        for at in random_points(40).into_iter().chain([[-3.0, 0.0], [6.0, 5.0]]) {
            let radius = reach.min(10.0);
            let mut found = Vec::new();
            grid.for_each_within(at, radius, |one| found.push(one.number));
            found.sort_unstable();
            let all = (0_u32..).zip(&points);
            let near = all.filter(|(_, p)| (p[0] - at[0]).hypot(p[1] - at[1]) < radius);
            assert_eq!(found, near.map(|(number, _)| number).collect::<Vec<_>>(), "reach {reach}");
        }
    }
}

#[test]
fn found_offsets_lead_from_the_place_to_the_point() {
    let grid = PointGrid::new(&[[1.0, 2.0]], BOUNDS, 1.0);
    let mut count = 0;
    grid.for_each_within([0.7, 1.6], 1.0, |found| {
        count += 1;
        assert!((found.offset[0] - 0.3).abs() < 1e-12 && (found.offset[1] - 0.4).abs() < 1e-12);
        assert!((found.distance2 - 0.25).abs() < 1e-12);
    });
    assert_eq!(count, 1);
}

#[test]
fn no_points_are_no_trouble() {
    let grid = PointGrid::new(&[], BOUNDS, 0.5);
    grid.for_each_within([0.0, 2.0], 0.5, |found| panic!("{found:?}"));
}

#[test]
fn every_wall_within_reach_is_listed_exactly_once() {
    let ends = random_points(60);
    let walls: Vec<Segment> = ends.chunks(2).map(|pair| Segment { a: pair[0], b: pair[1] }).collect();
    for reach in [0.1, 0.5, 3.0] {
        let grid = wall_grid(&walls, BOUNDS, reach);
        for at in random_points(100) {
            for wall in walls.iter().filter(|wall| wall.distance_to_point(at) <= reach) {
                let listed = grid.near(at).iter().filter(|&other| other == wall).count();
                assert_eq!(listed, 1, "reach {reach}, {at:?}, {wall:?}");
            }
        }
    }
}

#[test]
fn a_world_that_is_mostly_empty_gets_coarse_cells() {
    let wide = Rect { min: [0.0; 2], max: [1e6; 2] };
    let cells = Cells::new(wide, 0.4, 1000);
    assert!(cells.len() < 20_000, "{}", cells.len());
}
