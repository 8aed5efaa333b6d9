use covimap_embed::Point;
use serde_json::Value;

use super::*;
use crate::{BuildReport, GlobalMap, LandmarkId, LandmarkNames, MapperParams, PlacedLandmark, SightLines};

/// A map of landmarks `(id, position, component, region)`.
pub(super) fn map(rows: &[(&str, Point, u32, u32)]) -> GlobalMap {
    let names: LandmarkNames = rows.iter().map(|row| row.0).collect();
    let placed = rows.iter().map(|&(_, position, component, region)| PlacedLandmark {
        position,
        component,
        region,
        sightings: 8,
        partners: 2,
        ..PlacedLandmark::default()
    });
    GlobalMap::from_parts(names, placed.collect(), MapperParams::default(), BuildReport::default()).unwrap()
}

fn text(map: &GlobalMap, write: fn(&GlobalMap, &mut dyn std::io::Write) -> std::io::Result<()>) -> String {
    let mut bytes = Vec::new();
    write(map, &mut bytes).unwrap();
    String::from_utf8(bytes).unwrap()
}

/// Three landmarks of one component, two of another in the same places.
fn two_components() -> GlobalMap {
    map(&[
        ("a", [0.0, 0.0], 0, 0),
        ("far, \"b\"", [3.0, 4.0], 0, 1),
        ("x<&>", [0.0, 0.0], 1, 2),
        ("c", [-0.5, 1e-7], 0, 0),
        ("nul\0", [1.0, 0.0], 1, 2),
    ])
}

#[test]
fn csv_has_a_row_a_landmark_and_quotes_where_needed() {
    assert_eq!(
        text(&two_components(), csv),
        "id,x,y,component,region,sightings,partners\n\
         a,0.0,0.0,0,0,8,2\n\
         \"far, \"\"b\"\"\",3.0,4.0,0,1,8,2\n\
         x<&>,0.0,0.0,1,2,8,2\n\
         c,-0.5,1e-7,0,0,8,2\n\
         nul\0,1.0,0.0,1,2,8,2\n"
    );
    assert_eq!(text(&map(&[]), csv), "id,x,y,component,region,sightings,partners\n");
}

#[test]
fn geojson_has_points_then_lines_inside_components() {
    let text = text(&two_components(), geojson);
    // A feature a line, one line before and one after: 5 landmarks, 3 + 1 edges.
    assert_eq!(text.lines().count(), 11);
    let json: Value = serde_json::from_str(&text).unwrap();
    let features = json["features"].as_array().unwrap();
    assert_eq!(features[3]["geometry"]["coordinates"], serde_json::json!([-0.5, 1e-7]));
    assert_eq!(features[4]["properties"]["id"], "nul\0");
    assert_eq!(features[1]["properties"]["region"], 1);
    let lines: Vec<_> = features[5..]
        .iter()
        .map(|line| {
            assert_eq!(line["geometry"]["type"], "LineString");
            let properties = &line["properties"];
            [&properties["from"], &properties["to"]].map(|id| id.as_str().unwrap().to_owned())
        })
        .collect();
    assert_eq!(lines, [["a", "far, \"b\""], ["a", "c"], ["far, \"b\"", "c"], ["x<&>", "nul\0"]]);
    let empty: Value = serde_json::from_str(&self::text(&map(&[]), geojson)).unwrap();
    assert_eq!(empty["features"], serde_json::json!([]));
}

#[test]
fn graphml_escapes_ids_and_gives_edges_their_lengths() {
    let text = text(&two_components(), graphml);
    assert!(text.starts_with("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<graphml "));
    assert!(text.contains(
        "<node id=\"n2\"><data key=\"label\">x&lt;&amp;&gt;</data><data key=\"x\">0.0</data>\
         <data key=\"y\">0.0</data><data key=\"component\">1</data><data key=\"region\">2</data>\
         <data key=\"sightings\">8</data><data key=\"partners\">2</data></node>"
    ));
    // XML cannot hold the character NUL in any form.
    assert!(text.contains("<data key=\"label\">nul\u{fffd}</data>") && !text.contains('\0'));
    // a to b: the hypotenuse of 3 and 4.
    assert!(text.contains("<edge source=\"n0\" target=\"n1\"><data key=\"length\">5.0</data></edge>"));
    assert!(text.contains("<edge source=\"n2\" target=\"n4\"><data key=\"length\">1.0</data></edge>"));
    assert_eq!(text.matches("<edge ").count(), 4);
}

#[test]
fn a_route_graph_has_the_fields_that_nav2_reads() {
    let lines = [(0, 1, 5), (0, 3, 8), (2, 4, 1)].map(|(a, b, steps)| (LandmarkId(a), LandmarkId(b), steps));
    let map = two_components().with_sight_lines(SightLines::from_pairs(5, lines).unwrap()).unwrap();
    let graph = |component| {
        let mut bytes = Vec::new();
        nav2_route(&map, component).unwrap()(&mut bytes).unwrap();
        serde_json::from_slice::<Value>(&bytes).unwrap()
    };
    let json = graph(0);
    assert_eq!(json["type"], "FeatureCollection");
    let features = json["features"].as_array().unwrap();
    assert!(features.iter().all(|feature| feature["type"] == "Feature"));
    // Three landmarks, two lines of sight in both directions.
    let (nodes, edges) = features.split_at(3);
    assert_eq!(edges.len(), 4);
    assert_eq!(
        nodes[1],
        serde_json::json!({
            "type": "Feature",
            "geometry": { "type": "Point", "coordinates": [3.0, 4.0] },
            "properties": {
                "id": 1, "frame": "map", "metadata": { "landmark": "far, \"b\"", "region": 1, "sightings": 8 },
            },
        })
    );
    assert_eq!(
        edges[1],
        serde_json::json!({
            "type": "Feature",
            "geometry": { "type": "MultiLineString", "coordinates": [[[3.0, 4.0], [0.0, 0.0]]] },
            "properties": {
                "id": 6, "startid": 1, "endid": 0, "cost": 5.0, "overridable": true, "metadata": { "steps": 5 },
            },
        })
    );
    let ids: Vec<u64> =
        features.iter().map(|feature| feature["properties"]["id"].as_u64().unwrap()).collect();
    assert_eq!(ids, [0, 1, 3, 5, 6, 7, 8]);
    let ends = |edge: &Value| {
        [&edge["properties"]["startid"], &edge["properties"]["endid"]].map(|v| v.as_u64().unwrap())
    };
    assert_eq!(edges.iter().map(ends).collect::<Vec<_>>(), [[0, 1], [1, 0], [0, 3], [3, 0]]);
    assert_eq!(graph(1)["features"].as_array().unwrap().len(), 4);
}

#[test]
fn a_component_without_a_road_makes_no_route_graph() {
    let refusal = |map: &GlobalMap, component| nav2_route(map, component).err().unwrap().to_string();
    let told = "component 0 of the map has no line of sight, so there is no route in it; give another component, or \
                build a map that holds none at all again from its log";
    assert_eq!(refusal(&two_components(), 0), told);
    assert_eq!(refusal(&map(&[]), 0), told);
}

#[test]
fn ply_counts_what_it_lists_and_gives_regions_their_colours() {
    let text = text(&two_components(), ply);
    let (header, body) = text.split_once("end_header\n").unwrap();
    assert!(header.starts_with("ply\nformat ascii 1.0\n"));
    assert!(header.contains("element vertex 5\n") && header.contains("element edge 4\n"));
    let lines: Vec<&str> = body.lines().collect();
    assert_eq!(lines.len(), 9);
    let columns = |line: usize| lines[line].split(' ').collect::<Vec<_>>();
    assert_eq!((&columns(1)[..3], &columns(1)[6..]), (&["3.0", "4.0", "0"][..], &["0", "1"][..]));
    assert_eq!(columns(0)[3..6], columns(3)[3..6]);
    assert_ne!(columns(0)[3..6], columns(1)[3..6]);
    assert_eq!(&lines[5..], ["0 1", "0 3", "1 3", "2 4"]);
}

#[test]
fn neighbouring_regions_differ_in_colour_and_all_colours_are_used() {
    // A board of 12 x 12 landmarks, a region for every 2 x 2 of them.
    let ids: Vec<String> = (0..144).map(|i| i.to_string()).collect();
    let rows: Vec<_> = (0..144u32)
        .map(|i| {
            let (x, y) = (i % 12, i / 12);
            (
                ids[i as usize].as_str(),
                [f64::from(x) + 0.01 * f64::from(y), f64::from(y)],
                0,
                x / 2 + 6 * (y / 2),
            )
        })
        .collect();
    let map = map(&rows);
    let graphs = ComponentGraph::all(&map);
    let colours = palette::by_region(&map, &graphs);
    let region = |id: LandmarkId| map.landmarks()[id.index()].region;
    for (a, b) in graphs[0].landmark_edges() {
        assert_eq!(region(a) == region(b), colours[a.index()] == colours[b.index()], "{a:?} {b:?}");
    }
    for colour in 0..palette::COLOURS.len() {
        // 36 regions of 4 landmarks share 9 colours: about 16 landmarks each.
        let used = colours.iter().filter(|&&used| used == colour).count();
        assert!((8..=24).contains(&used), "{colour}: {used}");
    }
}
