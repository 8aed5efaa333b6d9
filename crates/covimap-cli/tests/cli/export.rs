//! `covimap export`.

use crate::scratch::Scratch;

#[test]
fn a_table_starts_with_the_columns_that_others_rely_on() {
    let scratch = Scratch::with_map();
    let table = scratch.succeeds(&["export", "square.map.json", "--to", "csv"]).stdout;
    assert!(table.starts_with("id,x,y,component"), "{table}");
    assert_eq!(table.lines().count(), 5);
    let run = scratch.succeeds(&["export", "square.map.json", "--to", "csv", "-o", "square.csv"]);
    assert_eq!((run.stdout.as_str(), run.stderr.as_str()), ("", ""));
    assert_eq!(scratch.read("square.csv"), table);
}

#[test]
fn every_format_is_written() {
    let scratch = Scratch::with_map();
    scratch.file("truth.csv", "id,x,y\nA,0,0\nB,2,0\nC,2,2\nD,0,2\n");
    let export = |options: &[&str]| {
        scratch.succeeds(&[&["export", "square.map.json", "--to"], options].concat()).stdout
    };
    let picture = export(&["svg"]);
    assert!(picture.contains("<svg") && picture.contains("</svg>"), "{picture}");
    assert_ne!(export(&["svg", "--truth", "truth.csv"]), picture);
    assert!(export(&["geojson"]).contains("FeatureCollection"));
    assert!(export(&["graphml"]).contains("<graphml"));
    assert!(export(&["ply"]).starts_with("ply\n"));
}

#[test]
fn a_route_graph_is_of_one_component() {
    let scratch = Scratch::with_map();
    let run = scratch.succeeds(&["export", "square.map.json", "--to", "nav2-route"]);
    assert!(run.stderr.contains("in map units, not metres"), "{}", run.stderr);
    let features = run.json()["features"].as_array().unwrap().len();
    // Four landmarks, and four or five lines of sight in both directions.
    assert!(features == 4 + 2 * 4 || features == 4 + 2 * 5, "{features}");
    scratch.refuses(
        &["export", "square.map.json", "--to", "nav2-route", "--component", "1"],
        3,
        "component 1 of the map has no line of sight",
    );
    scratch.refuses(
        &["export", "square.map.json", "--to", "csv", "--component", "0"],
        2,
        "--component belongs to --to nav2-route alone",
    );
}

#[test]
fn the_map_file_changes_its_form_and_back() {
    let scratch = Scratch::with_map();
    scratch.succeeds(&["export", "square.map.json", "--to", "binary", "-o", "m.covimap"]);
    let json = scratch.succeeds(&["export", "m.covimap", "--to", "json"]).stdout;
    assert_eq!(json, scratch.read("square.map.json"));
    scratch.succeeds(&["build", "square.jsonl", "-q", "-o", "direct.covimap"]);
    let [direct, exported] =
        ["direct.covimap", "m.covimap"].map(|name| std::fs::read(scratch.path().join(name)).unwrap());
    assert_eq!(direct, exported);
    scratch.file("cut.covimap", &direct[..direct.len() - 9]);
    scratch.refuses(&["info", "cut.covimap"], 3, "cut.covimap: the map file is damaged, its check sum is");
}
