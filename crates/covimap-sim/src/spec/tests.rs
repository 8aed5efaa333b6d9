use super::*;
use crate::angle::Angle;
use crate::simulation::Simulation;
use crate::world::World;

/// What a changed specification is refused for.
fn refusal(change: impl FnOnce(&mut SimSpec)) -> &'static str {
    let mut spec = SimSpec::paper_room(5, 1.5, 10);
    change(&mut spec);
    let error = match World::new(&spec.world, 1) {
        Ok(world) => Simulation::new(&world, &spec.run, 1).err(),
        Err(error) => Some(error),
    };
    match error {
        Some(SimError::Setting { name, .. }) => name,
        other => panic!("{other:?}"),
    }
}

#[test]
fn every_setting_of_a_world_is_checked() {
    assert_eq!(refusal(|spec| spec.world.landmarks = 0), "landmarks");
    assert_eq!(refusal(|spec| spec.world.landmarks = 1 << 32), "landmarks");
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(refusal(|spec| spec.world.density = bad), "density");
        assert_eq!(refusal(|spec| spec.world.contrast = bad), "contrast");
        let floors = [
            (Floor::Blocks { street: bad, building: 1.0 }, "street"),
            (Floor::Blocks { street: 1.0, building: bad }, "building"),
            (Floor::Spiral { corridor: bad, wall: 1.0 }, "corridor"),
            (Floor::Spiral { corridor: 1.0, wall: bad }, "wall"),
            (Floor::Office { room: bad, door: 1.0, missing_doors: 0.0 }, "room"),
            (Floor::Office { room: 3.0, door: bad, missing_doors: 0.0 }, "door"),
            (Floor::TwoRooms { door: bad }, "door"),
            (Floor::CorridorTree { corridor: bad, pitch: 1.0 }, "corridor"),
            (Floor::CorridorTree { corridor: 1.0, pitch: bad }, "pitch"),
        ];
        for (floor, name) in floors {
            assert_eq!(refusal(|spec| spec.world.floor = floor), name);
        }
    }
    assert_eq!(refusal(|spec| spec.world.floor = Floor::CorridorTree { corridor: 1.0, pitch: 1.0 }), "pitch");
    for bad in [-0.1, f64::NAN, f64::INFINITY] {
        assert_eq!(refusal(|spec| spec.world.diameter = bad), "diameter");
        assert_eq!(refusal(|spec| spec.world.min_gap = bad), "min_gap");
        let office = Floor::Office { room: 3.0, door: 0.9, missing_doors: bad };
        assert_eq!(refusal(|spec| spec.world.floor = office), "missing_doors");
    }
}

#[test]
fn every_setting_of_a_run_is_checked() {
    assert_eq!(refusal(|spec| spec.run.robots = 0), "robots");
    assert_eq!(refusal(|spec| spec.run.step.turn = Angle::from_deg(181.0)), "turn");
    assert_eq!(refusal(|spec| spec.run.step.longest = 0.09), "longest");
    assert_eq!(refusal(|spec| spec.run.step.clearance = -0.1), "clearance");
    for bad in [0.0, f64::NAN, f64::INFINITY] {
        assert_eq!(refusal(|spec| spec.run.step.shortest = bad), "shortest");
        assert_eq!(refusal(|spec| spec.run.motion = Motion::Sweep { lane: bad }), "lane");
    }
    for bad in [-0.1, 1.1, f64::NAN] {
        assert_eq!(refusal(|spec| spec.run.errors.missed = bad), "missed");
        assert_eq!(refusal(|spec| spec.run.errors.mistaken = bad), "mistaken");
    }
}

#[test]
fn every_setting_of_a_sensor_is_checked() {
    for bad in [0.0, 361.0, f64::NAN] {
        assert_eq!(refusal(|spec| spec.run.sensor.view = Angle::from_deg(bad)), "view");
    }
    for bad in [-0.1, f64::NAN, f64::INFINITY] {
        assert_eq!(refusal(|spec| spec.run.sensor.range_noise = Some(bad)), "range noise");
    }
    assert_eq!(refusal(|spec| spec.run.sensor.detectability = [-0.1, 1.0]), "least detectability");
    assert_eq!(refusal(|spec| spec.run.sensor.detectability = [0.5, 0.4]), "greatest detectability");
    let range = |range, edge, detection| {
        move |spec: &mut SimSpec| {
            spec.run.sensor.recognition = Recognition::Range { range, edge, detection };
        }
    };
    assert_eq!(refusal(range(0.0, 0.1, 0.9)), "range");
    assert_eq!(refusal(range(0.5, f64::NAN, 0.9)), "edge");
    assert_eq!(refusal(range(0.5, 0.1, 1.5)), "detection");
    let angle = |threshold: [f64; 2], steepness| {
        move |spec: &mut SimSpec| {
            let threshold = threshold.map(Angle::from_deg);
            spec.run.sensor.recognition = Recognition::VisualAngle { threshold, steepness };
        }
    };
    assert_eq!(refusal(angle([0.0, 5.0], None)), "least threshold");
    assert_eq!(refusal(angle([5.0, 4.0], None)), "greatest threshold");
    assert_eq!(refusal(angle([5.0, 181.0], None)), "greatest threshold");
    assert_eq!(refusal(angle([5.0, 5.0], Some(0.0))), "steepness");
}

#[test]
fn a_refusal_says_what_is_allowed() {
    let spec = WorldSpec { density: -2.0, ..WorldSpec::default() };
    let error = World::new(&spec, 1).unwrap_err();
    assert_eq!(error.to_string(), "density is -2; it must be positive and finite");
}

#[test]
fn prefixes_that_log_formats_could_misread_are_refused() {
    for prefix in ["a,b", "\"", "\\", "a b", "é"] {
        let spec = WorldSpec { id_prefix: prefix.to_owned(), ..WorldSpec::default() };
        let error = World::new(&spec, 1).unwrap_err();
        assert!(matches!(error, SimError::IdPrefix { .. }), "{error}");
    }
    let spec = WorldSpec { id_prefix: String::new(), ..WorldSpec::default() };
    assert!(World::new(&spec, 1).is_ok(), "plain numbers are fine");
}

#[test]
fn worlds_and_motions_have_names() {
    for floor in Floor::ALL {
        assert_eq!(floor.name().parse::<Floor>().unwrap(), floor);
    }
    for motion in Motion::ALL {
        assert_eq!(motion.name().parse::<Motion>().unwrap(), motion);
    }
    assert_eq!(
        "maze".parse::<Floor>().unwrap_err().to_string(),
        "there is no world `maze`; choose one of hall, ring, horseshoe, blocks, spiral, office, two-rooms, \
         corridor-tree"
    );
    assert!(matches!("fly".parse::<Motion>(), Err(SimError::UnknownName { kind: "motion", .. })));
}

#[test]
fn specifications_survive_being_written_and_read() {
    for floor in Floor::ALL {
        let spec = SimSpec::large(floor, 300, 40);
        let text = serde_json::to_string(&spec).unwrap();
        assert!(text.contains(&format!("\"name\":\"{}\"", floor.name())), "{text}");
        assert_eq!(serde_json::from_str::<SimSpec>(&text).unwrap(), spec);
    }
    let room = SimSpec::paper_room(10, 1.5, 100);
    let text = serde_json::to_string(&room).unwrap();
    assert_eq!(serde_json::from_str::<SimSpec>(&text).unwrap(), room);
}

#[test]
fn what_a_file_leaves_out_is_the_default_and_what_is_unknown_is_refused() {
    let short: SimSpec = serde_json::from_str(r#"{"world": {"landmarks": 20}, "run": {}}"#).unwrap();
    let world = WorldSpec { landmarks: 20, ..WorldSpec::default() };
    assert_eq!(short, SimSpec { world, run: RunSpec::default() });
    assert!(serde_json::from_str::<SimSpec>(r#"{"world": {"landmark": 20}, "run": {}}"#).is_err());
    let odd = r#"{"world": {"floor": {"name": "hall", "door": 1}}, "run": {}}"#;
    assert!(serde_json::from_str::<SimSpec>(odd).is_err());
}
