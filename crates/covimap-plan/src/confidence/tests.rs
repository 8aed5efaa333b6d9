use std::sync::Arc;

use super::*;
use crate::MapIndex;
use crate::fixtures::{SIGHTINGS, empty, index_of, lines_among, map_seen, scattered};

fn covariance_of(index: &MapIndex, id: &str) -> Covariance {
    index.covariance(id).unwrap()
}

#[test]
fn the_variance_of_a_lone_landmark_is_that_of_the_range() {
    let lone = covariance_of(&index_of(&[[3.0, 4.0]], &[]), "L0");
    let deviation = INFLATION.sqrt() * 0.5 / 1.7;
    assert!((lone.deviation() - deviation).abs() < 1e-12);
    assert_eq!((lone.xy, lone.xx), (0.0, lone.yy));
    assert_eq!(empty().map().len(), 0);
}

#[test]
fn a_line_of_sight_holds_along_itself_alone() {
    // f = 50.5 / 151, d = sqrt(-0.3 ln f) = 0.57323; the map has the two 1 apart, so u = 1 / d.
    let index = index_of(&[[0.0, 0.0], [0.0, 1.0]], &[(0, 1, 50)]);
    let found = covariance_of(&index, "L0");
    let f: f64 = 50.5 / 151.0;
    let d = (-0.3 * f.ln()).sqrt();
    assert!((d - 0.57323).abs() < 1e-5);
    // v = u^2 (alpha / 2 d)^2 (1 - f) / n.
    let v = (0.15 / d / d).powi(2) * (1.0 - f) / 50.0;
    let range = (0.5 / 1.7 / d).powi(2);
    assert!((found.yy / INFLATION - 1.0 / (1.0 / v + 1.0 / range)).abs() < 1e-12);
    assert!((found.xx / INFLATION - range).abs() < 1e-12);
    assert!(found.xy.abs() < 1e-12);
}

#[test]
fn a_landmark_on_another_has_no_direction_to_it() {
    let index = index_of(&[[0.0; 2], [0.0; 2], [1.0, 0.0]], &[(0, 1, 50), (0, 2, 50)]);
    let [a, b] = ["L0", "L1"].map(|id| covariance_of(&index, id));
    assert!(a.xx < b.xx && a.xx > 0.0);
    assert_eq!(b.xx, b.yy);
    // All at one place: no line has a length to take the unit from.
    let index = index_of(&[[1.0; 2]; 3], &[(0, 1, 50), (1, 2, 9)]);
    assert!((covariance_of(&index, "L1").deviation() - INFLATION.sqrt() * 0.5 / 1.7).abs() < 1e-12);
}

#[test]
fn more_evidence_is_more_certain() {
    let points = scattered(30, 5);
    let placed: Vec<_> = points.iter().map(|&point| (point, 0)).collect();
    // Everything seen so many times as often: the same frequencies from more counts.
    let index = |times: u32| {
        let lines: Vec<_> =
            lines_among(&points, 2).iter().map(|&(a, b, steps)| (a, b, times * steps)).collect();
        MapIndex::new(Arc::new(map_seen(&placed, &lines, times * SIGHTINGS)))
    };
    let [once, often] = [1, 16].map(index);
    for id in (0..30).map(LandmarkId) {
        let [once, often] = [&once, &often].map(|index| index.covariance(id).unwrap().deviation());
        assert!(often < once, "{id:?}: {often} {once}");
    }
}

#[test]
fn the_unit_of_the_map_does_not_matter() {
    let points = scattered(30, 5);
    let lines = lines_among(&points, 2);
    let larger: Vec<Point> = points.iter().map(|point| point.map(|v| 8.0 * v)).collect();
    let [one, eight] = [points, larger].map(|points| index_of(&points, &lines));
    for id in (0..30).map(LandmarkId) {
        let ratio = eight.covariance(id).unwrap().deviation() / one.covariance(id).unwrap().deviation();
        assert!((ratio - 8.0).abs() < 1e-9, "{ratio}");
    }
}

#[test]
fn variances_grow_with_the_distance_in_map_units() {
    // As in the second test: u = 1 / 0.57323. Over four map units they double.
    let index = index_of(&[[0.0, 0.0], [0.0, 1.0]], &[(0, 1, 50)]);
    let unit = 1.0 / (-0.3 * (50.5f64 / 151.0).ln()).sqrt();
    assert_eq!(index.growth(0, 0.0), 1.0);
    assert!((index.growth(0, 4.0 * unit) - 2.0).abs() < 1e-12);
}

#[test]
fn axes_turn_with_the_covariance() {
    // Variances 4 and 1, the first along 30 degrees: xx = 4 cos^2 + sin^2 = 3.25, yy = 1.75, xy = 3 sin cos.
    let turned = Covariance { xx: 3.25, xy: 3.0 * 0.5 * 0.75f64.sqrt(), yy: 1.75 };
    let (major, minor, direction) = turned.axes();
    assert!((major - 2.0).abs() < 1e-12 && (minor - 1.0).abs() < 1e-12);
    assert!((direction.to_degrees() - 30.0).abs() < 1e-9);
    let (sin, cos) = 30f64.to_radians().sin_cos();
    assert!((turned.along([cos, sin]) - 4.0).abs() < 1e-12);
    assert!((turned.along([-sin, cos]) - 1.0).abs() < 1e-12);
    // sqrt((4 + 1) / 2).
    assert!((turned.deviation() - 2.5f64.sqrt()).abs() < 1e-12);
}
