use covimap_embed::Point;

use super::*;
use crate::fixtures::{log_of, looks, scattered};
use crate::{DistanceChoice, MapperParams, Silent};

const ROOM: Point = [3.0, 2.0];

/// Forty landmarks in a room, 1500 looks.
fn room() -> (Vec<Point>, SightingLog) {
    let points = scattered(40, ROOM, 1);
    let log = log_of(&looks(&points, ROOM, 0.7, 1500));
    (points, log)
}

/// The truth of the first landmarks.
fn truth(points: &[Point]) -> Truth {
    let lines = points.iter().enumerate().map(|(id, [x, y])| format!("{id},{x},{y}\n"));
    Truth::parse(format!("id,x,y\n{}", lines.collect::<String>()).as_bytes(), "truth.csv").unwrap()
}

fn built(log: &SightingLog, method: Method) -> GlobalMap {
    let params = MapperParams { method, ..MapperParams::default() };
    Mapper::new(params).unwrap().build(log, &Silent).unwrap()
}

fn limit_of(map: &GlobalMap, truth: &Truth, log: &SightingLog) -> Result<Limit, MapError> {
    limit(map, truth, log, &EvaluateParams::default(), &Silent)
}

#[test]
fn a_map_of_a_room_is_as_good_as_what_is_reached_from_the_truth() {
    let (points, log) = room();
    let truth = truth(&points);
    let map = built(&log, Method::Auto);
    let found = limit_of(&map, &truth, &log).unwrap();
    assert_eq!(found.map, against(&map, &truth, &EvaluateParams::default()).unwrap());
    // One room has one minimum: both starts lead there, up to where the refinement stops.
    let ratio = found.ratio.rmse.unwrap();
    assert!((0.8..1.25).contains(&ratio), "{found:?}");
    // Stresses can be compared under one law of distances.
    let mut params = MapperParams::default();
    params.auto.distance = DistanceChoice::FixedLog;
    let fixed = limit_of(&Mapper::new(params).unwrap().build(&log, &Silent).unwrap(), &truth, &log).unwrap();
    assert!((fixed.ratio.stress1.unwrap() - 1.0).abs() < 0.05, "{fixed:?}");
    // Known places bound the error from below; the map is not further from there than a few times.
    let bound = found.bound.unwrap();
    assert!(bound.rmse < found.from_truth.rmse && found.from_truth.rmse < 4.0 * bound.rmse, "{found:?}");
}

#[test]
fn a_map_gone_wrong_is_told_from_a_log_that_says_little() {
    let (points, log) = room();
    let mut map = built(&log, Method::Auto);
    // The right half turned over: what a wrong stitch does.
    for placed in &mut map.landmarks {
        placed.position[1] *= if placed.position[0] > 0.0 { -1.0 } else { 1.0 };
    }
    let found = limit_of(&map, &truth(&points), &log).unwrap();
    assert!(found.ratio.orientation_error.unwrap() > 5.0, "{found:?}");
    assert!(found.from_truth.orientation_error.unwrap() < 0.05, "{found:?}");
}

#[test]
fn a_classical_map_has_no_stress_to_compare() {
    let (points, log) = room();
    let found = limit_of(&built(&log, Method::Classical), &truth(&points), &log).unwrap();
    assert_eq!((found.map_stress1, found.ratio.stress1), (None, None));
    assert!(found.ratio.orientation_error.unwrap() > 1.0, "{found:?}");
}

#[test]
fn landmarks_that_nobody_surveyed_start_where_the_map_has_them() {
    let (points, log) = room();
    let map = built(&log, Method::Auto);
    let all = limit_of(&map, &truth(&points), &log).unwrap();
    let most = limit_of(&map, &truth(&points[..30]), &log).unwrap();
    assert_eq!((most.map.n, most.map.unknown), (30, 10));
    // The same minimum is reached.
    assert!((most.stress1 / all.stress1 - 1.0).abs() < 0.02, "{} {}", most.stress1, all.stress1);
}

#[test]
fn the_log_of_another_map_is_refused() {
    let (points, log) = room();
    let map = built(&log, Method::Auto);
    let more = SightingLog::from_steps([["0", "1"], ["1", "Z"]]);
    let refused = limit_of(&map, &truth(&points), &more).unwrap_err();
    assert!(matches!(&refused, MapError::OtherLog { map: 40, log: 3, .. }), "{refused}");
    let small =
        built(&SightingLog::from_steps([["0", "1"], ["1", "2"], ["2", "0"], ["2", "3"]]), Method::Auto);
    let refused = limit_of(&small, &truth(&points), &log).unwrap_err().to_string();
    assert_eq!(
        refused,
        "the map was not made of this log: \"4\" is in one of the two only, the map has 4 landmarks and the log \
         40; give the log that the map was made of"
    );
}
