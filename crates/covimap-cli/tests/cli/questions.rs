//! Questions about a map: `near`, `relation`, `route`, `explain`, `explore`, and `align`.

use crate::scratch::Scratch;

const BAD_INPUT: i32 = 3;
const USAGE: i32 = 2;

/// The square beside a pair that was never seen with it.
fn square_and_pair() -> Scratch {
    let scratch = Scratch::with_square();
    let log = format!("{}{}", scratch.read("square.jsonl"), "{\"seen\": [\"P\", \"Q\"]}\n".repeat(3));
    scratch.file("both.jsonl", log);
    scratch.succeeds(&["build", "both.jsonl", "-q", "-o", "map.json"]);
    scratch
}

fn names(value: &serde_json::Value) -> Vec<&str> {
    value.as_array().unwrap().iter().map(|name| name.as_str().unwrap()).collect()
}

#[test]
fn near_lists_the_nearest_first() {
    let scratch = square_and_pair();
    let found = scratch.succeeds(&["near", "map.json", "B", "-k", "2", "--json"]).json();
    assert_eq!((&found["landmark"], &found["component"]), (&"B".into(), &0.into()));
    let near = found["near"].as_array().unwrap();
    let ids: Vec<_> = near.iter().map(|near| near["id"].as_str().unwrap()).collect();
    assert!(ids == ["A", "C"] || ids == ["C", "A"], "{ids:?}");
    assert!(near[0]["distance"].as_f64().unwrap() <= near[1]["distance"].as_f64().unwrap());
    assert_eq!(near[0]["next_to"], true);
    let table = scratch.succeeds(&["near", "map.json", "B"]).stdout;
    assert_eq!(table.lines().count(), 4, "{table}");
    let table = scratch.succeeds(&["near", "map.json", "B", "--radius", "0"]).stdout;
    assert_eq!(table, "landmark  distance\n");
    scratch.refuses(&["near", "map.json", "B", "--radius=-1"], BAD_INPUT, "the radius is -1");
}

#[test]
fn relation_tells_the_side_and_how_sure_it_is() {
    let scratch = square_and_pair();
    let side = |a, b, c| scratch.succeeds(&["relation", "map.json", a, b, c, "--json"]).json();
    let found = side("A", "C", "B");
    let probability = found["probability"].as_f64().unwrap();
    assert!((0.5..=1.0).contains(&probability));
    assert_eq!(found["may_be_mirrored"], true);
    // The other way along the line, and the landmark on the other side of it.
    assert_eq!(side("C", "A", "D")["orientation"], found["orientation"]);
    assert_ne!(side("A", "C", "D")["orientation"], found["orientation"]);
    let run = scratch.succeeds(&["relation", "map.json", "A", "C", "B"]);
    let word = found["orientation"].as_str().unwrap();
    assert!(run.stdout.starts_with(&format!("B is to the {word} of the line from A to C, with probability")));
    assert!(run.stderr.contains("may be a mirror image"));
}

#[test]
fn route_goes_over_lines_of_sight() {
    let scratch = square_and_pair();
    let found = scratch.succeeds(&["route", "map.json", "B", "D", "--json"]).json();
    let way = names(&found["landmarks"]);
    assert!(way == ["B", "A", "D"] || way == ["B", "C", "D"], "{way:?}");
    assert_eq!(found["length"], found["cost"]);
    assert_eq!(found["objective"], "shortest");
    let points = found["waypoints"].as_array().unwrap();
    assert_eq!(names(&points[0]["in_sight"]), way[..2]);
    assert_eq!(points[1]["cost"], found["length"]);
    let safest = scratch.succeeds(&["route", "map.json", "B", "D", "--prefer", "safest", "--json"]).json();
    assert_eq!(safest["objective"], "safest");
    let table = scratch.succeeds(&["route", "map.json", "B", "D"]).stdout;
    assert!(table.starts_with("from  to") && table.contains("over 3 landmarks"), "{table}");
    let here = scratch.succeeds(&["route", "map.json", "B", "B", "--json"]).json();
    assert_eq!((names(&here["landmarks"]), &here["length"]), (vec!["B"], &0.0.into()));
}

#[test]
fn what_cannot_be_answered_is_bad_input() {
    let scratch = square_and_pair();
    scratch.refuses(&["route", "map.json", "B", "P"], BAD_INPUT, "\"P\" in component 1");
    scratch.refuses(&["relation", "map.json", "A", "B", "Q"], BAD_INPUT, "\"Q\" in component 1");
    scratch.refuses(&["relation", "map.json", "A", "B", "A"], BAD_INPUT, "named twice");
    scratch.refuses(&["route", "map.json", "B", "D", "--min-steps", "9"], BAD_INPUT, "in 9 steps or more");
    let scratch = Scratch::new();
    scratch.file("halls.jsonl", "{\"seen\":[\"door-1\",\"desk\"]}\n{\"seen\":[\"desk\"]}\n");
    scratch.succeeds(&["build", "halls.jsonl", "-q"]);
    let asked = ["near", "relation", "route", "explain"];
    for (command, more) in asked.into_iter().zip([&[][..], &["desk", "desk"], &["desk"], &[]]) {
        let question = [&[command, "halls.map.json", "door-l"], more].concat();
        let told = "covimap: the map has no landmark \"door-l\"; did you mean \"door-1\"?";
        scratch.refuses(&question, BAD_INPUT, told);
    }
}

#[test]
fn an_older_map_has_no_roads() {
    let scratch = Scratch::with_map();
    let mut map: serde_json::Value = serde_json::from_str(&scratch.read("square.map.json")).unwrap();
    for landmark in map["landmarks"].as_array_mut().unwrap() {
        landmark.as_object_mut().unwrap().remove("links");
    }
    scratch.file("older.json", map.to_string());
    scratch.succeeds(&["near", "older.json", "A"]);
    scratch.refuses(&["route", "older.json", "A", "B"], BAD_INPUT, "the map holds no lines of sight");
    scratch.refuses(
        &["export", "older.json", "--to", "nav2-route"],
        BAD_INPUT,
        "component 0 of the map has no line of sight",
    );
}

#[test]
fn explain_lists_what_holds_a_landmark() {
    let scratch = square_and_pair();
    let found = scratch.succeeds(&["explain", "map.json", "A", "--json"]).json();
    assert_eq!((&found["id"], &found["sightings"], &found["partners"]), (&"A".into(), &4.into(), &3.into()));
    assert_eq!(found["component_landmarks"], 4);
    assert!(found["holds"].as_array().unwrap().len() >= 2);
    let pair = scratch.succeeds(&["explain", "map.json", "P"]).stdout;
    assert!(pair.contains("held by") && pair.contains("seen with 1 other landmarks only"), "{pair}");
}

#[test]
fn align_brings_a_map_to_known_positions() {
    let scratch = square_and_pair();
    scratch.file("anchors.csv", "id,x,y\nA,0,0\nB,3,0\nC,3,3\nPOST,9,9\n");
    let run = scratch.succeeds(&["align", "map.json", "--truth", "anchors.csv", "-o", "m.json", "--json"]);
    assert!(run.stderr.contains("left out: 1 landmark that the map does not have"), "{}", run.stderr);
    assert!(run.stderr.contains("left as they were: 1 component"), "{}", run.stderr);
    let fit = &run.json()["components"][0];
    assert_eq!((&fit["component"], &fit["anchors"], &fit["handed"]), (&0.into(), &3.into(), &true.into()));
    assert_eq!(run.json()["residuals"].as_array().unwrap().len(), 3);
    let errors = scratch.succeeds(&["evaluate", "m.json", "anchors.csv", "--json"]).json();
    let (rmse, told) = (errors["rmse"].as_f64().unwrap(), fit["rmse"].as_f64().unwrap());
    assert!((rmse - told).abs() < 1e-9, "{rmse} {told}");
    let side = scratch.succeeds(&["relation", "m.json", "A", "B", "C", "--json"]).json();
    assert_eq!((&side["orientation"], &side["may_be_mirrored"]), (&"left".into(), &false.into()));
    // A file of the binary form answers as the JSON does.
    scratch.succeeds(&["align", "map.json", "--truth", "anchors.csv", "-o", "m.covimap", "-q"]);
    for question in [["near", "A"], ["explain", "A"]] {
        let ask = |map| scratch.succeeds(&[question[0], map, question[1]]).stdout;
        assert_eq!(ask("m.covimap"), ask("m.json"));
    }
}

#[test]
fn align_takes_distances_and_turns() {
    let scratch = square_and_pair();
    let align = |options: &[&str]| {
        scratch.succeeds(&[&["align", "map.json", "-o", "m.json"], options].concat());
        let side = |map| scratch.succeeds(&["relation", map, "A", "B", "C", "--json"]).json();
        (
            scratch.succeeds(&["near", "m.json", "P", "--json"]).json()["near"][0]["distance"].clone(),
            side("m.json"),
        )
    };
    let (apart, side) = align(&["--distance", "P,Q,4"]);
    assert_eq!((apart.as_f64().unwrap() * 1e9).round(), 4e9);
    assert_eq!(side["may_be_mirrored"], true);
    assert_eq!(align(&["--turn", "A,B,C"]).1["orientation"], "left");
    assert_eq!(align(&["--turn", "C,B,A"]).1["orientation"], "right");
    let table = scratch.succeeds(&["align", "map.json", "--turn", "A,B,C", "-o", "m.json"]).stdout;
    assert!(table.starts_with("component  positions  distances"), "{table}");
}

#[test]
fn align_refuses_what_tells_nothing() {
    let scratch = square_and_pair();
    scratch.file("anchors.csv", "id,x,y\nA,0,0\nB,3,0\n");
    let align = |options: &[&str], code, told| {
        scratch.refuses(&[&["align", "map.json", "-o", "m.json"], options].concat(), code, told);
    };
    align(&[], BAD_INPUT, "nothing to align the map with");
    align(&["--truth", "anchors.csv"], BAD_INPUT, "the known positions are of 2 landmarks of the map");
    align(&["--distance", "A,B,-1"], BAD_INPUT, "the distance from \"A\" to \"B\" is -1");
    align(&["--distance", "A,B"], USAGE, "give two IDs and a distance, as in door,desk,3.5");
    align(&["--distance", "A,B,far"], USAGE, "give two IDs and a distance, as in door,desk,3.5");
    align(&["--turn", "A,B"], USAGE, "give three IDs, as in door,desk,window");
    align(&["--turn", "A,B,C", "--turn", "A,C,B"], BAD_INPUT, "contradicts the known positions");
}

#[test]
fn locate_tells_the_place_and_how_sure_it_is() {
    let scratch = square_and_pair();
    let found = scratch.succeeds(&["locate", "map.json", "--seen", "A,B,C", "--json"]).json();
    assert!(found["x"].is_f64() && found["y"].is_f64() && found["ambiguous"].is_boolean());
    assert_eq!(found["component"], 0);
    let covariance = |a: usize, b: usize| found["covariance"][a][b].as_f64().unwrap();
    assert_eq!(covariance(0, 1), covariance(1, 0));
    assert!(covariance(0, 0) * covariance(1, 1) > covariance(0, 1).powi(2));
    let total: f64 =
        found["modes"].as_array().unwrap().iter().map(|m| m["probability"].as_f64().unwrap()).sum();
    assert!((total - 1.0).abs() < 1e-9);
    // The option given twice, an ID that is not there, and one of the other component.
    let seen = ["locate", "map.json", "--seen", "A,B", "--seen", "C,nobody,P", "--json"];
    let found = scratch.succeeds(&seen).json();
    assert_eq!((names(&found["unknown"]), names(&found["misfits"])), (vec!["nobody"], vec!["P"]));
    let run = scratch.succeeds(&["locate", "map.json", "--seen", "A,B,C,nobody"]);
    assert!(run.stdout.contains("in component 0, standard deviations"), "{}", run.stdout);
    assert!(run.stderr.contains("1 ID not in the map: nobody"), "{}", run.stderr);
}

#[test]
fn locate_says_when_nothing_is_known() {
    let scratch = square_and_pair();
    let found = scratch.succeeds(&["locate", "map.json", "--seen", "nobody", "--json"]).json();
    assert_eq!((&found["lost"], &found["ambiguous"]), (&true.into(), &false.into()));
    assert!(found["x"].is_null() && found["component"].is_null());
    let text = scratch.succeeds(&["locate", "map.json", "--seen", "nobody", "-q"]).stdout;
    assert!(text.starts_with("lost: the map has none of these landmarks"), "{text}");
    scratch.refuses(&["locate", "map.json"], USAGE, "--seen");
    scratch.refuses(&["locate", "none.json", "--seen", "A"], BAD_INPUT, "none.json");
    scratch.file("pair.jsonl", "{\"seen\": [\"P\", \"Q\"]}\n".repeat(3));
    scratch.succeeds(&["build", "pair.jsonl", "-q", "-o", "pair.json"]);
    scratch.refuses(&["locate", "pair.json", "--seen", "P"], BAD_INPUT, "does not know its sensor");
}

#[test]
fn explore_tells_where_to_look_and_whether_to_stop() {
    let scratch = square_and_pair();
    let found = scratch.succeeds(&["explore", "map.json", "--json"]).json();
    let goals = found["goals"].as_array().unwrap();
    assert!(!goals.is_empty() && goals.iter().all(|goal| goal["gain"].as_f64().unwrap() > 0.0), "{found}");
    let error = found["error"].as_f64().unwrap();
    assert_eq!(found["stop"], error <= 0.03);
    // What is as good as asked needs no more; a tenth of the error a hundred times the steps.
    let asked = |error: f64| {
        scratch.succeeds(&["explore", "map.json", "--json", "--error", &error.to_string()]).json()
    };
    assert_eq!((&asked(error)["stop"], &asked(error)["more_steps"]), (&true.into(), &0.into()));
    let steps = found["steps"].as_u64().unwrap();
    let more = asked(error / 10.0)["more_steps"].as_u64().unwrap();
    assert!(more.abs_diff(99 * steps) <= 1, "{more} of {steps}");
    // From the square the pair is out of reach.
    let from = scratch.succeeds(&["explore", "map.json", "--from", "A,B", "-k", "1", "--json"]).json();
    assert_eq!((from["goals"].as_array().unwrap().len(), &from["goals"][0]["component"]), (1, &0.into()));
    assert!(from["goals"][0]["distance"].as_f64().is_some());
    let text = scratch.succeeds(&["explore", "map.json"]).stdout;
    assert!(
        text.starts_with("go to  component") && text.contains("of near triangles are expected"),
        "{text}"
    );
    scratch.refuses(&["explore", "map.json", "--error", "0.5"], BAD_INPUT, "setting explore.error is 0.5");
    scratch.refuses(&["explore", "map.json", "--looks", "0"], BAD_INPUT, "setting explore.looks is 0");
}
