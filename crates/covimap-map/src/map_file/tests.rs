use covimap_embed::{DistanceCurve, DistanceFamily, Lens};
use proptest::prelude::*;

use super::*;
use crate::{ComponentReport, DistanceReport, FamilyScore, HonestyReport, Method, ShepardRow, Warning};

const SMALL: &str = r#"{"format":1,"generator":"covimap 0.1.0","method":"classical","seed":7,"settings":{"auto":{"distance":"auto","local_stop":{"max_iterations":100,"tolerance":0.00001},"polish_stop":{"max_iterations":40,"tolerance":1e-6},"refine_iterations":4,"regions":{"core":12,"halo_links":3,"members":150},"split_aliases":false},"classical":{"alpha":null,"hi":2.0,"lo":0.1,"phi":"phi2","tic":true}},"landmarks":[
{"id":"A","x":0.1,"y":-2.0,"component":0,"region":0,"sightings":3,"partners":1,"links":[[1,2]],"branch":0,"loose":false},
{"id":"say \"B\"","x":1e-7,"y":-0.0,"component":0,"region":1,"sightings":2,"partners":1,"branch":0,"loose":false}
],"report":{"steps":4,"sightings":5,"landmarks":2,"pairs":1,"honesty":{"set_aside":0,"misrecognition":null},"regions":2,"stress1":0.25,"components":[],"warnings":[]}}
"#;

fn text(map: &GlobalMap) -> String {
    let mut bytes = Vec::new();
    map.write_json(&mut bytes).unwrap();
    String::from_utf8(bytes).unwrap()
}

fn parse(text: &str) -> Result<GlobalMap, MapError> {
    GlobalMap::parse_json(text.as_bytes(), "map.json")
}

/// The refusal of the small map after one replacement in its text.
fn refusal(old: &str, new: &str) -> String {
    assert!(SMALL.contains(old), "{old}");
    parse(&SMALL.replace(old, new)).unwrap_err().to_string()
}

#[test]
fn the_file_says_what_the_map_holds() {
    let map = parse(SMALL).unwrap();
    assert_eq!(map.params().method, Method::Classical);
    assert_eq!(map.params().seed, 7);
    assert_eq!(map.names().iter().collect::<Vec<_>>(), ["A", "say \"B\""]);
    let expected =
        PlacedLandmark { position: [1e-7, -0.0], region: 1, sightings: 2, partners: 1, ..Default::default() };
    assert_eq!(map.landmarks()[1], expected);
    assert_eq!((map.report().steps, map.report().stress1), (4, 0.25));
    let lines: Vec<_> = map.sight_lines().pairs().collect();
    assert_eq!(lines, [(LandmarkId(0), LandmarkId(1), 2)]);
    assert_eq!(text(&map), SMALL);
}

#[test]
fn a_file_without_lines_of_sight_is_a_map_that_knows_none() {
    let older = SMALL.replace(r#","links":[[1,2]]"#, "");
    let map = parse(&older).unwrap();
    assert_eq!(map.sight_lines().count(), 0);
    assert_eq!(text(&map), older);
}

#[test]
fn what_is_known_of_the_sensor_stands_in_the_file_and_older_ones_know_no_warp() {
    let sensors = r#""sensors":[{"range":0.5,"edge":0.04,"detectability":0.9,"outliers":0.001}],"occluded":[[0,1]],"report""#;
    let warps = r#""detectability":0.8,"deviation":0.02,"warp":0.125,"branch""#;
    let sensed = SMALL.replace(r#""report""#, sensors).replace(r#""branch""#, warps);
    let map = parse(&sensed).unwrap();
    let sensing = map.sensing().unwrap();
    let wanted = Sensed { detectability: 0.8, deviation: 0.02, warp: 0.125 };
    assert_eq!((*sensing.of(LandmarkId(1)), sensing.occluded_from(LandmarkId(0))), (wanted, &[1][..]));
    assert_eq!(parse(&text(&map)).unwrap(), map);
    let older = parse(&sensed.replace(r#","warp":0.125"#, "")).unwrap();
    assert_eq!(*older.sensing().unwrap().of(LandmarkId(1)), Sensed { warp: 0.0, ..wanted });
    let without = parse(&sensed.replace(r#""deviation":0.02,"#, "")).unwrap_err().to_string();
    assert!(without.contains("what is known of landmark 0 is") && without.contains("NaN"), "{without}");
}

#[test]
fn the_frame_of_an_aligned_map_stands_in_the_file() {
    let fit = ChartFit { component: 0, scale: 0.5, anchors: 3, distances: 1, rmse: 0.1, handed: true };
    let map = parse(SMALL).unwrap().with_positions(&[[1.0, 2.0], [3.0, 4.5]], vec![fit]).unwrap();
    let key =
        r#","alignment":[{"component":0,"scale":0.5,"anchors":3,"distances":1,"rmse":0.1,"handed":true}],"#;
    assert!(text(&map).contains(key));
    assert_eq!(parse(&text(&map)).unwrap(), map);
}

#[test]
fn a_map_without_landmarks_is_a_map() {
    let map = GlobalMap::from_parts(
        LandmarkNames::default(),
        Vec::new(),
        MapperParams::default(),
        BuildReport::default(),
    )
    .unwrap();
    assert_eq!(parse(&text(&map)).unwrap(), map);
}

#[test]
fn keys_of_later_builds_are_ignored() {
    let later = SMALL
        .replace(r#""seed":7"#, r#""seed":7,"made_on":{"by":["x"]}"#)
        .replace(r#""loose":false}"#, r#""loose":false,"covariance":[1,0,1]}"#)
        .replace(r#""classical":{"#, r#""polish":{"rounds":8},"classical":{"beta":0.5,"#)
        .replace(r#""steps":4"#, r#""steps":4,"bound":0.05"#);
    assert_eq!(parse(&later).unwrap(), parse(SMALL).unwrap());
}

#[test]
fn another_format_is_named_even_when_nothing_else_fits() {
    let error = parse(r#"{"format":3,"landmarks":"elsewhere"}"#).unwrap_err();
    assert!(matches!(error, MapError::MapFormat { found: 3, known: 1, .. }));
    assert_eq!(
        error.to_string(),
        "map.json: map file is format 3, this build reads 1; use the covimap that wrote it or build the map again"
    );
}

#[test]
fn damaged_files_are_refused_at_their_line() {
    let tail = "; give a file that `covimap build` wrote";
    let missing = refusal(r#""y":-2.0,"#, "");
    assert_eq!(missing, format!("map.json:2: not a whole map file, missing field `y`{tail}"));
    assert!(refusal("1e-7", "NaN").starts_with("map.json:3: not a whole map file, expected value"));
    assert!(refusal("1e-7", "1e999").starts_with("map.json:3: not a whole map file, number out of range"));
    assert!(refusal("1e-7", "null").contains("map.json:3: not a whole map file, invalid type: null"));
    assert!(refusal(r#""region":1"#, r#""region":-1"#).starts_with("map.json:3: "));
    assert!(refusal(r#""seed":7,"#, "").contains("missing field `seed`"));
    assert!(parse("").unwrap_err().to_string().starts_with("map.json:1: not a whole map file, EOF"));
    assert!(parse(r#"{"t":0,"seen":["A"]}"#).unwrap_err().to_string().contains("missing field `format`"));
    let cut = &SMALL[..SMALL.len() / 2];
    assert!(matches!(parse(cut), Err(MapError::BadLine { .. })));
    assert!(matches!(
        GlobalMap::parse_json(b"{\"format\":1,\"\xff\":0}", "m"),
        Err(MapError::BadLine { .. })
    ));
}

#[test]
fn contradictions_are_refused() {
    assert_eq!(
        refusal(r#""say \"B\"""#, r#""A""#),
        "map.json: landmark 1 has the ID \"A\" of another one; build the map again"
    );
    let told = |links| refusal(r#"[[1,2]]"#, links);
    assert!(told("[[1,3]]").starts_with("map.json: the line of sight between landmarks 0 and 1 has 3 steps"));
    assert!(told("[[0,1]]").contains("landmarks 0 and 0"));
    assert!(told("[[2,1]]").contains("landmarks 0 and 2"));
    let settings = refusal(r#""phi2""#, r#""phi9""#);
    assert!(
        settings.starts_with("map.json: the settings cannot be read, unknown variant `phi9`"),
        "{settings}"
    );
}

#[test]
fn a_path_that_cannot_be_read_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let error = GlobalMap::load(&folder.path().join("map.json")).unwrap_err();
    assert!(
        error
            .to_string()
            .ends_with("map.json: cannot be read; give a map file, as `covimap build` writes it")
    );
    assert!(matches!(GlobalMap::load(folder.path()), Err(MapError::Io { .. })));
}

fn distances(number: f64) -> DistanceReport {
    DistanceReport {
        learnt: true,
        curve: DistanceCurve::Lens(Lens { range: number / 7.0, detectability: number }),
        scores: vec![FamilyScore { family: DistanceFamily::Lens, held_out: -1e6 * number }],
        sample: 3,
        repetition: number,
        misfit: number,
        doubted: number,
        shepard: vec![ShepardRow { pairs: 3, frequency: number, expected: number, distances: [number; 5] }],
    }
}

proptest! {
    #[test]
    fn what_is_saved_is_loaded_and_saved_again_the_same(
        rows in prop::collection::btree_map(
            ".{0,8}",
            (any::<[f64; 2]>().prop_filter("finite", |p| p.iter().all(|v| v.is_finite())), any::<[u32; 5]>(), any::<bool>()),
            0..20,
        ),
        seed in any::<u64>(),
        stress1 in 0.0..1.0f64,
    ) {
        let names: LandmarkNames = rows.keys().map(String::as_str).collect();
        let landmarks = rows
            .values()
            .map(|&(position, [component, region, sightings, partners, branch], loose)| {
                PlacedLandmark { position, component, region, sightings, partners, branch, loose }
            })
            .collect();
        let params = MapperParams { seed, ..MapperParams::default() };
        let report = BuildReport {
            stress1,
            honesty: HonestyReport { set_aside: seed, misrecognition: Some(stress1) },
            components: vec![ComponentReport {
                landmarks: seed, regions: 1, pairs: 2, stress1: stress1 / 3.0, iterations: 4, converged: true,
                distances: Some(distances(stress1)), ..Default::default()
            }],
            update: None,
            warnings: vec![Warning {
                kind: "seen_once".into(), count: 1, examples: vec!["\u{1F916}".into()], message: "a\nb".into(),
            }],
            ..BuildReport::default()
        };
        let map = GlobalMap::from_parts(names, landmarks, params, report).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("map.json");
        map.save(&path).unwrap();
        let loaded = GlobalMap::load(&path).unwrap();
        prop_assert_eq!(&loaded, &map);
        prop_assert_eq!(text(&loaded).into_bytes(), fs::read(&path).unwrap());
        let mut binary = Vec::new();
        map.write_binary(&mut binary).unwrap();
        prop_assert_eq!(&GlobalMap::parse_binary(&binary, "map.covimap").unwrap(), &map);
        // One line a landmark, one before and one after.
        prop_assert_eq!(text(&map).lines().count(), rows.len() + 2);
    }
}
