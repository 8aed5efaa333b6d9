//! `covimap evaluate`.

use crate::scratch::Scratch;

/// The map of the square, and its truth with one landmark that nobody saw.
fn surveyed() -> Scratch {
    let scratch = Scratch::with_map();
    scratch.file("truth.csv", "id,x,y\nA,0,0\nB,2,0\nC,2,2\nD,0,2\nE,9,9\n");
    scratch
}

#[test]
fn the_errors_of_a_map_are_printed_for_people() {
    let run = surveyed().succeeds(&["evaluate", "square.map.json", "truth.csv"]);
    assert_eq!(run.stderr, "left out: 1 landmark of the truth not in the map\n");
    assert!(run.stdout.contains("landmarks compared                               4\n"), "{}", run.stdout);
    assert!(run.stdout.contains("triangles turned the wrong way              0.0000\n"), "{}", run.stdout);
}

#[test]
fn the_errors_of_a_map_are_printed_for_programs() {
    let found = surveyed().succeeds(&["evaluate", "square.map.json", "truth.csv", "--json"]).json();
    assert_eq!(found["n"], 4);
    assert_eq!(found["missing"], 1);
    assert_eq!(found["orientation_error"], 0.0);
    for key in ["delaunay_error", "rmse", "knn10"] {
        assert!(found[key].is_f64(), "{key} in {found}");
    }
}

#[test]
fn quiet_leaves_the_result() {
    let run = surveyed().succeeds(&["evaluate", "-q", "square.map.json", "truth.csv"]);
    assert_eq!(run.stderr, "");
    assert!(run.stdout.contains("landmarks compared"));
}
