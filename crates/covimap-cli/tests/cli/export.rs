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
