use std::fs;
use std::sync::atomic::{AtomicU64, Ordering::SeqCst};

use covimap_map::{LogFormat, SightingLog, Silent, Truth};

use super::*;

use crate::recording::Recording;
use crate::spec::{Floor, SimSpec};

fn simulate(spec: &SimSpec) -> (World, Recording) {
    let world = World::new(&spec.world, 1).unwrap();
    let recording = Simulation::new(&world, &spec.run, 1).unwrap().record();
    (world, recording)
}

fn write(spec: &SimSpec, folder: &Path) -> Result<Summary, MapError> {
    let world = World::new(&spec.world, 1).unwrap();
    write_files(&world, Simulation::new(&world, &spec.run, 1).unwrap(), folder, &Silent)
}

#[test]
fn files_hold_what_the_simulation_saw() {
    let scratch = tempfile::tempdir().unwrap();
    let spec = SimSpec::large(Floor::Ring {}, 60, 10);
    let summary = write(&spec, &scratch.path().join("new")).unwrap();
    let (world, recording) = simulate(&spec);
    let log = fs::File::open(scratch.path().join("new").join(OBSERVATIONS)).unwrap();
    let log = SightingLog::read_from(log, OBSERVATIONS, Some(LogFormat::Jsonl), &Silent).unwrap();
    assert_eq!(log.steps(), 600);
    for (read, step) in log.iter().zip(recording.steps()) {
        let mut ids: Vec<_> = read.iter().map(|&id| log.names().name(LandmarkId(id)).to_owned()).collect();
        ids.sort_by_key(|id| id[1..].parse::<u32>().unwrap());
        assert_eq!(ids, step.seen.iter().map(|number| format!("L{number}")).collect::<Vec<_>>());
    }
    let truth = Truth::read(&scratch.path().join("new").join(TRUTH)).unwrap();
    assert_eq!(truth.positions(), world.landmarks());
    assert!(truth.names().iter().eq((0..60).map(|number| format!("L{number}"))));
    assert_eq!((summary.steps, summary.landmarks), (600, 60));
}

#[test]
fn ranges_are_written_too() {
    let scratch = tempfile::tempdir().unwrap();
    let mut spec = SimSpec::large(Floor::Ring {}, 30, 5);
    spec.run.sensor.range_noise = Some(0.05);
    write(&spec, scratch.path()).unwrap();
    let log = fs::File::open(scratch.path().join(OBSERVATIONS)).unwrap();
    let log = SightingLog::read_from(log, OBSERVATIONS, Some(LogFormat::Jsonl), &Silent).unwrap();
    let (_, recording) = simulate(&spec);
    let mut expected: Vec<(usize, String, f64)> = Vec::new();
    for (number, step) in recording.steps().enumerate() {
        expected.extend(
            step.seen.iter().zip(step.ranges).map(|(seen, &range)| (number, format!("L{seen}"), range)),
        );
    }
    let name = |landmark: u32| log.names().name(LandmarkId(landmark)).to_owned();
    let mut read: Vec<_> =
        log.ranges().iter().map(|range| (range.step, name(range.landmark), range.metres)).collect();
    let order = |a: &(usize, String, f64), b: &(usize, String, f64)| (a.0, &a.1).cmp(&(b.0, &b.1));
    expected.sort_by(order);
    read.sort_by(order);
    assert!(read.len() > 500);
    assert_eq!(read, expected);
}

#[test]
fn the_same_settings_give_the_same_bytes_and_replace_old_files() {
    let scratch = tempfile::tempdir().unwrap();
    let spec = SimSpec::paper_room(10, 1.5, 100);
    let read = |name: &str| fs::read(scratch.path().join(name)).unwrap();
    fs::write(scratch.path().join("truth.csv"), "old").unwrap();
    write(&spec, scratch.path()).unwrap();
    let first = [read("observations.jsonl"), read("truth.csv")];
    write(&spec, scratch.path()).unwrap();
    assert_eq!(first, [read("observations.jsonl"), read("truth.csv")]);
    assert_eq!(fs::read_dir(scratch.path()).unwrap().count(), 2, "no temporary file is left");
}

/// Counts steps and asks to stop after some.
struct Watch {
    done: AtomicU64,
    most: u64,
}

impl Observer for Watch {
    fn advanced(&self, amount: u64) {
        self.done.fetch_add(amount, SeqCst);
    }

    fn interrupted(&self) -> bool {
        self.done.load(SeqCst) >= self.most
    }
}

fn watched(steps: u64, most: u64, folder: &Path) -> (Result<Summary, MapError>, u64) {
    let spec = SimSpec::paper_room(5, 1.5, steps);
    let world = World::new(&spec.world, 1).unwrap();
    let simulation = Simulation::new(&world, &spec.run, 1).unwrap();
    let watch = Watch { done: AtomicU64::new(0), most };
    let result = write_files(&world, simulation, folder, &watch);
    (result, watch.done.into_inner())
}

#[test]
fn the_observer_hears_of_the_steps_and_may_stop_them() {
    let scratch = tempfile::tempdir().unwrap();
    let (result, done) = watched(3 * REPORT_EVERY + 10, u64::MAX, scratch.path());
    assert_eq!((result.unwrap().steps, done), (3 * REPORT_EVERY + 10, 3 * REPORT_EVERY));
    let before = fs::read(scratch.path().join(OBSERVATIONS)).unwrap();
    let (result, done) = watched(3 * REPORT_EVERY, 2 * REPORT_EVERY, scratch.path());
    assert!(matches!(result, Err(MapError::Interrupted)) && done == 2 * REPORT_EVERY);
    assert_eq!(fs::read(scratch.path().join(OBSERVATIONS)).unwrap(), before);
    assert_eq!(fs::read_dir(scratch.path()).unwrap().count(), 2, "no temporary file is left");
}

#[test]
fn a_log_that_cannot_be_written_leaves_neither_file() {
    let scratch = tempfile::tempdir().unwrap();
    fs::create_dir(scratch.path().join(OBSERVATIONS)).unwrap();
    let error = write(&SimSpec::paper_room(5, 1.5, 10), scratch.path()).unwrap_err();
    assert!(matches!(&error, MapError::Unwritable { path, .. } if path.ends_with(OBSERVATIONS)), "{error}");
    assert_eq!(fs::read_dir(scratch.path()).unwrap().count(), 1);
}

#[test]
fn a_folder_that_cannot_be_made_is_named() {
    let scratch = tempfile::tempdir().unwrap();
    fs::write(scratch.path().join("file"), "").unwrap();
    let error = write(&SimSpec::paper_room(5, 1.5, 10), &scratch.path().join("file/below")).unwrap_err();
    assert!(
        error
            .to_string()
            .ends_with("file/below: cannot be written: its folder does not exist; create the folder first")
    );
}
