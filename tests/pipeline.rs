//! Logs in, maps out, through the library.

use std::path::{Path, PathBuf};

use covimap::evaluate::{self, EvaluateParams, Evaluation};
use covimap::{
    GlobalMap, MapError, Mapper, MapperParams, Method, Observer, PlacedLandmark, SightingLog, Silent, Stage,
    Truth,
};

fn data(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("crates/covimap-cli/data").join(name)
}

fn robot_log() -> SightingLog {
    SightingLog::read(&[data("mrclam-1.jsonl")], None, &Silent).unwrap()
}

fn mapper(method: Method) -> Mapper {
    let mut params = MapperParams::default();
    params.method = method;
    Mapper::new(params).unwrap()
}

fn map(log: &SightingLog, method: Method) -> GlobalMap {
    mapper(method).build(log, &Silent).unwrap()
}

/// A board of squares; at every square those around it are seen.
fn board(side: i32, name: &str) -> Vec<Vec<String>> {
    let squares = (0..side).flat_map(|row| (0..side).map(move |column| (row, column)));
    let around = |(row, column): (i32, i32)| {
        let near = (-1..=1).flat_map(|down| (-1..=1).map(move |right| (row + down, column + right)));
        let on_board = near.filter(|(r, c)| (0..side).contains(r) && (0..side).contains(c));
        on_board.map(|(r, c)| format!("{name} {r}-{c}")).collect()
    };
    squares.map(around).collect()
}

fn robot_errors(method: Method) -> Evaluation {
    let truth = Truth::read(&data("mrclam-1.truth.csv")).unwrap();
    evaluate::against(&map(&robot_log(), method), &truth, &EvaluateParams::default()).unwrap()
}

#[test]
fn a_real_robot_log_gives_a_map_that_can_be_used() {
    let found = robot_errors(Method::Auto);
    assert_eq!((found.n, found.missing, found.unknown), (15, 0, 0));
    // Of 455 triangles 23 turn the wrong way, and 2 of 39 Delaunay edges differ. The bounds leave
    // room for 4 triangles and 3 edges more.
    assert!(found.orientation_error.unwrap() < 0.06, "{found:?}");
    assert!(found.delaunay_error < 0.13, "{found:?}");
    // The field is 5.7 m by 11.1 m.
    assert!(found.rmse < 0.9, "{found:?}");
}

#[test]
fn the_default_beats_the_method_of_the_paper_on_the_robot_log() {
    let [auto, classical] = [Method::Auto, Method::Classical].map(robot_errors);
    assert!(auto.orientation_error < classical.orientation_error);
    assert!(auto.delaunay_error < classical.delaunay_error);
    assert!(auto.rmse < classical.rmse);
}

#[test]
fn a_board_of_many_regions_keeps_its_shape() {
    const SIDE: i32 = 20;
    let log = SightingLog::from_steps(board(SIDE, "square"));
    let map = map(&log, Method::Auto);
    assert!(map.report().regions > 1, "{:?}", map.report());
    let rows = (0..SIDE * SIDE).map(|k| (k / SIDE, k % SIDE));
    let truth: String = rows.map(|(r, c)| format!("square {r}-{c},{c},{r}\n")).collect();
    let truth = Truth::parse(format!("id,x,y\n{truth}").as_bytes(), "board").unwrap();
    let found = evaluate::against(&map, &truth, &EvaluateParams::default()).unwrap();
    // In units of a square: the rim, where less is seen, is pulled in a little.
    assert!(found.rmse < 0.5, "{found:?}");
    assert!(found.orientation_error.unwrap() < 0.01, "{found:?}");
}

#[test]
fn the_number_of_threads_does_not_change_a_bit() {
    let logs = [robot_log(), SightingLog::from_steps(board(20, "square"))];
    for (log, method) in logs.iter().flat_map(|log| [(log, Method::Auto), (log, Method::Classical)]) {
        let bytes = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let mut bytes = Vec::new();
            pool.install(|| map(log, method)).write_json(&mut bytes).unwrap();
            bytes
        };
        let one = bytes(1);
        assert!(one == bytes(2) && one == bytes(5), "{method:?}");
    }
}

#[test]
fn parts_without_a_common_sighting_are_charts_of_their_own() {
    let steps = [board(4, "small"), board(6, "large"), vec![vec!["alone".to_owned()]]].concat();
    for method in [Method::Auto, Method::Classical] {
        let map = map(&SightingLog::from_steps(&steps), method);
        let sizes: Vec<_> = map.report().components.iter().map(|component| component.landmarks).collect();
        assert_eq!(sizes, [36, 16, 1]);
        for (id, landmark) in map.names().iter().zip(map.landmarks()) {
            let wanted = ["large", "small", "alone"].iter().position(|name| id.starts_with(name));
            assert_eq!(Some(landmark.component as usize), wanted, "{id}");
        }
    }
}

#[test]
fn every_component_is_in_the_frame_that_the_conventions_promise() {
    let steps = [board(4, "small"), board(6, "large")].concat();
    for (log, method) in [
        (robot_log(), Method::Auto),
        (robot_log(), Method::Classical),
        (SightingLog::from_steps(&steps), Method::Auto),
    ] {
        let map = map(&log, method);
        for component in 0..map.report().components.len() as u32 {
            let members = map.landmarks().iter().filter(|landmark| landmark.component == component);
            let points: Vec<_> = members.map(|PlacedLandmark { position, .. }| *position).collect();
            let moment = |f: fn(f64, f64) -> f64| points.iter().map(|&[x, y]| f(x, y)).sum::<f64>();
            let size = moment(|x, y| x * x + y * y);
            assert!(moment(|x, _| x).abs() < 1e-9 * size && moment(|_, y| y).abs() < 1e-9 * size);
            assert!(moment(|x, y| x * y).abs() < 1e-9 * size, "the axes are those of the spread");
            assert!(moment(|x, y| x * x - y * y) > -1e-9 * size, "x is the longer one");
            assert!(points[0][0] >= 0.0 && points[0][1] >= 0.0);
        }
    }
}

#[test]
fn a_saved_map_is_read_back_as_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("map.json");
    for method in [Method::Auto, Method::Classical] {
        let map = map(&robot_log(), method);
        map.save(&path).unwrap();
        assert_eq!(GlobalMap::load(&path).unwrap(), map);
    }
}

/// Asks to stop as soon as a stage has begun.
struct StopsAt {
    stage: Stage,
    begun: std::sync::atomic::AtomicBool,
}

impl Observer for StopsAt {
    fn started(&self, stage: Stage, _total: Option<u64>) {
        self.begun.fetch_or(stage == self.stage, std::sync::atomic::Ordering::SeqCst);
    }

    fn interrupted(&self) -> bool {
        self.begun.load(std::sync::atomic::Ordering::SeqCst)
    }
}

/// The stages between are stopped one by one in the tests of the mapper.
#[test]
fn a_build_can_be_stopped_in_its_first_stage_and_in_its_last() {
    for stage in [Stage::Read, Stage::Sensor] {
        let observer = StopsAt { stage, begun: false.into() };
        let ended = SightingLog::read(&[data("mrclam-1.jsonl")], None, &observer)
            .and_then(|log| mapper(Method::Auto).build(&log, &observer));
        assert!(matches!(ended, Err(MapError::Interrupted)), "{stage:?}");
    }
}
