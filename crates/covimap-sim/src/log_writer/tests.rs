use std::fs;

use super::*;
use crate::recording::Recording;
use crate::spec::{Floor, SimSpec};

fn simulate(spec: &SimSpec) -> (World, Recording) {
    let world = World::new(&spec.world, 1).unwrap();
    let recording = Simulation::new(&world, &spec.run, 1).unwrap().record();
    (world, recording)
}

fn write(spec: &SimSpec, folder: &Path) -> Result<Summary, SimError> {
    let world = World::new(&spec.world, 1)?;
    write_files(&world, Simulation::new(&world, &spec.run, 1)?, folder, |_| ())
}

#[test]
fn the_log_is_one_json_object_a_step() {
    let mut out = Vec::new();
    let mut writer = LogWriter::new(&mut out, "ob");
    for seen in [&[0, 12][..], &[], &[7]] {
        writer.write(seen).unwrap();
    }
    let text = String::from_utf8(out).unwrap();
    assert_eq!(text, "{\"seen\":[\"ob0\",\"ob12\"]}\n{\"seen\":[]}\n{\"seen\":[\"ob7\"]}\n");
}

#[test]
fn files_hold_what_the_simulation_saw() {
    let scratch = tempfile::tempdir().unwrap();
    let spec = SimSpec::large(Floor::Ring {}, 60, 10);
    let summary = write(&spec, &scratch.path().join("new")).unwrap();
    let (world, recording) = simulate(&spec);
    let log = fs::read_to_string(scratch.path().join("new/observations.jsonl")).unwrap();
    assert_eq!(log.lines().count(), 600);
    for (line, step) in log.lines().zip(recording.steps()) {
        let value: serde_json::Value = serde_json::from_str(line).unwrap();
        let ids: Vec<_> = step.seen.iter().map(|number| format!("L{number}")).collect();
        assert_eq!(value, serde_json::json!({ "seen": ids }));
    }
    let truth = fs::read_to_string(scratch.path().join("new/truth.csv")).unwrap();
    let mut lines = truth.lines();
    assert_eq!(lines.next(), Some("id,x,y"));
    for (number, &[x, y]) in world.landmarks().iter().enumerate() {
        let fields: Vec<_> = lines.next().unwrap().split(',').collect();
        assert_eq!(fields[0], format!("L{number}"));
        assert_eq!([fields[1].parse(), fields[2].parse()], [Ok(x), Ok(y)]);
    }
    assert_eq!(lines.next(), None);
    assert_eq!((summary.steps, summary.landmarks), (600, 60));
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

#[test]
fn progress_ends_at_the_number_of_steps() {
    let scratch = tempfile::tempdir().unwrap();
    let spec = SimSpec::paper_room(5, 1.5, REPORT_EVERY + 10);
    let world = World::new(&spec.world, 1).unwrap();
    let simulation = Simulation::new(&world, &spec.run, 1).unwrap();
    let mut reports = Vec::new();
    write_files(&world, simulation, scratch.path(), |steps| reports.push(steps)).unwrap();
    assert_eq!(reports, [REPORT_EVERY, REPORT_EVERY + 10]);
}

#[test]
fn a_log_that_cannot_be_written_leaves_neither_file() {
    let scratch = tempfile::tempdir().unwrap();
    // A folder stands where the partial log would go.
    fs::create_dir(scratch.path().join(".observations.jsonl.partial")).unwrap();
    let error = write(&SimSpec::paper_room(5, 1.5, 10), scratch.path()).unwrap_err();
    assert!(matches!(&error, SimError::Io { path, .. } if path.ends_with("observations.jsonl")), "{error}");
    assert!(!scratch.path().join("truth.csv").exists());
    assert!(!scratch.path().join(".truth.csv.partial").exists());
}

#[test]
fn a_folder_that_cannot_be_made_is_named() {
    let scratch = tempfile::tempdir().unwrap();
    fs::write(scratch.path().join("file"), "").unwrap();
    let error = write(&SimSpec::paper_room(5, 1.5, 10), &scratch.path().join("file/below")).unwrap_err();
    assert!(matches!(&error, SimError::Io { path, .. } if path.ends_with("file/below")), "{error}");
}
