use super::*;
use crate::fixtures::{index_of, scattered, square_and_pair};

fn survey(rows: &[(&str, Point)]) -> Truth {
    let lines: Vec<String> = rows.iter().map(|(id, [x, y])| format!("{id},{x},{y}\n")).collect();
    Truth::parse(format!("id,x,y\n{}", lines.concat()).as_bytes(), "survey").unwrap()
}

fn ids(ids: [&str; 3]) -> [String; 3] {
    ids.map(str::to_owned)
}

fn ruler(from: &str, to: &str, distance: f64) -> KnownDistance {
    KnownDistance { from: from.to_owned(), to: to.to_owned(), distance }
}

fn with_positions(index: &MapIndex, truth: &Truth, turns: &[[String; 3]]) -> Result<Aligned, PlanError> {
    align(index, &Known { positions: Some(truth), distances: &[], left_turns: turns })
}

fn with_distances(index: &MapIndex, distances: &[KnownDistance]) -> Result<Aligned, PlanError> {
    align(index, &Known { distances, ..Known::default() })
}

fn with_turns(index: &MapIndex, left_turns: &[[String; 3]]) -> Result<Aligned, PlanError> {
    align(index, &Known { left_turns, ..Known::default() })
}

fn position(aligned: &Aligned, number: usize) -> Point {
    aligned.map.landmarks()[number].position
}

fn assert_near(a: Point, b: Point) {
    assert!(apart(a, b) < 1e-9, "{a:?} {b:?}");
}

#[test]
fn three_known_positions_place_scale_and_turn_over_a_component() {
    // The square mirrored, twice as large, at (10, 20): (x, y) -> (10 + 2 y, 20 + 2 x).
    let truth =
        survey(&[("L0", [10.0, 20.0]), ("L1", [10.0, 22.0]), ("L3", [12.0, 20.0]), ("post", [0.0, 0.0])]);
    let aligned = with_positions(&square_and_pair(), &truth, &[]).unwrap();
    assert_near(position(&aligned, 2), [12.0, 22.0]);
    assert_eq!((aligned.carried.as_slice(), aligned.unknown), (&[0][..], 1));
    assert_eq!(aligned.residuals.len(), 3);
    assert!(aligned.residuals.iter().all(|&(_, off)| off < 1e-9));
    // The pair stays where it was, in map units.
    assert_eq!(position(&aligned, 5), [0.5, 0.0]);
    let [fit] = aligned.map.alignment() else { panic!("one component") };
    assert!((fit.scale - 2.0).abs() < 1e-12 && fit.rmse < 1e-9);
    assert_eq!((fit.component, fit.anchors, fit.distances, fit.handed), (0, 3, 0, true));
    // Lines of sight and evidence are those of before.
    assert_eq!(aligned.map.sight_lines().count(), 5);
    let index = MapIndex::new(std::sync::Arc::new(aligned.map));
    assert!(index.is_handed(0) && !index.is_handed(1));
}

#[test]
fn residuals_are_what_the_fit_leaves() {
    // The corners of the square, moved outwards and inwards by 0.1 in turn along the diagonals: the best
    // similarity is the identity, and leaves 0.1 everywhere.
    let d = 0.1 / 2f64.sqrt();
    let truth =
        survey(&[("L0", [-d, -d]), ("L1", [1.0 - d, d]), ("L2", [1.0 + d, 1.0 + d]), ("L3", [d, 1.0 - d])]);
    let aligned = with_positions(&square_and_pair(), &truth, &[]).unwrap();
    assert!(aligned.residuals.iter().all(|&(_, off)| (off - 0.1).abs() < 1e-9), "{:?}", aligned.residuals);
    assert!((aligned.map.alignment()[0].rmse - 0.1).abs() < 1e-9);
}

#[test]
fn two_known_positions_need_a_turn() {
    let truth = survey(&[("L0", [0.0, 0.0]), ("L1", [3.0, 0.0])]);
    let index = square_and_pair();
    assert_eq!(
        with_positions(&index, &truth, &[]).unwrap_err().to_string(),
        "the known positions are of 2 landmarks of the map, and no component has three that are not in line, or \
         two and a known turn; survey more landmarks of one component"
    );
    let left = with_positions(&index, &truth, &[ids(["L0", "L1", "L2"])]).unwrap();
    assert_near(position(&left, 2), [3.0, 3.0]);
    let right = with_positions(&index, &truth, &[ids(["L1", "L0", "L2"])]).unwrap();
    assert_near(position(&right, 2), [3.0, -3.0]);
    assert!(right.map.alignment()[0].handed);
}

#[test]
fn known_positions_in_line_tell_no_handedness() {
    let line: Vec<Point> = [0.0, 1.0, 2.0].map(|x| [x, 0.0]).into_iter().chain([[1.0, 1.0]]).collect();
    let index = index_of(&line, &[]);
    let truth = survey(&[("L0", [0.0, 0.0]), ("L1", [0.0, 2.0]), ("L2", [0.0, 4.0])]);
    assert!(matches!(with_positions(&index, &truth, &[]), Err(PlanError::TooFewAnchors { anchors: 3 })));
    let coincide = survey(&[("L0", [1.0; 2]), ("L1", [1.0; 2])]);
    assert!(matches!(with_positions(&index, &coincide, &[]), Err(PlanError::Embed(_))));
    let none = survey(&[("post", [1.0; 2])]);
    assert!(matches!(with_positions(&index, &none, &[]), Err(PlanError::TooFewAnchors { anchors: 0 })));
}

#[test]
fn known_distances_scale_by_least_squares() {
    // On the map 1 and sqrt 2: s = (2 + 3 sqrt 2) / (1 + 2) = 2.0808802; what is left is
    // 2.0808802 - 2 = 0.0808802 and 2.9428090 - 3 = -0.0571910, root mean square 0.0700443.
    let rulers = [ruler("L0", "L1", 2.0), ruler("L0", "L2", 3.0)];
    let aligned = with_distances(&square_and_pair(), &rulers).unwrap();
    let fit = &aligned.map.alignment()[0];
    assert!((fit.scale - 2.080_880_2).abs() < 1e-7 && (fit.rmse - 0.070_044_3).abs() < 1e-7);
    assert_eq!((fit.distances, fit.anchors, fit.handed), (2, 0, false));
    assert_near(position(&aligned, 1), [fit.scale, 0.0]);
    // A component of its own has a scale of its own.
    let pair = with_distances(&square_and_pair(), &[ruler("L4", "L5", 4.0)]).unwrap();
    assert_eq!(pair.carried, [1]);
    assert_eq!((position(&pair, 5), position(&pair, 1)), ([4.0, 0.0], [1.0, 0.0]));
}

#[test]
fn a_turn_alone_mirrors_or_confirms() {
    let index = square_and_pair();
    let same = with_turns(&index, &[ids(["L0", "L1", "L2"])]).unwrap();
    assert_eq!(position(&same, 2), [1.0, 1.0]);
    let mirrored = with_turns(&index, &[ids(["L2", "L1", "L0"])]).unwrap();
    assert_eq!(position(&mirrored, 2), [1.0, -1.0]);
    for aligned in [same, mirrored] {
        let [fit] = aligned.map.alignment() else { panic!("one component") };
        assert!(fit.handed);
        assert_eq!((fit.scale, fit.anchors, fit.rmse), (1.0, 0, 0.0));
    }
}

#[test]
fn what_is_known_later_adds_to_what_was_known() {
    let first = with_turns(&square_and_pair(), &[ids(["L2", "L1", "L0"])]).unwrap();
    let index = MapIndex::new(std::sync::Arc::new(first.map));
    let second = with_distances(&index, &[ruler("L0", "L1", 2.0)]).unwrap();
    let index = MapIndex::new(std::sync::Arc::new(second.map));
    let third = with_distances(&index, &[ruler("L0", "L1", 6.0), ruler("L4", "L5", 1.0)]).unwrap();
    let [square, pair] = third.map.alignment() else { panic!("two components") };
    assert_eq!((square.component, square.scale, square.handed), (0, 6.0, true));
    assert_eq!((pair.component, pair.scale, pair.handed), (1, 2.0, false));
    assert_eq!(position(&third, 2), [6.0, -6.0]);
}

#[test]
fn a_turn_leaves_a_survey_as_it_is_or_contradicts_it() {
    let truth = survey(&[("L0", [10.0, 20.0]), ("L1", [12.0, 20.0]), ("L3", [10.0, 22.0])]);
    let surveyed = with_positions(&square_and_pair(), &truth, &[]).unwrap();
    let before = surveyed.map.alignment()[0].clone();
    let index = MapIndex::new(std::sync::Arc::new(surveyed.map));
    let confirmed = with_turns(&index, &[ids(["L0", "L1", "L2"])]).unwrap();
    assert_eq!(confirmed.map.alignment(), [before]);
    assert_eq!(confirmed.map.landmarks(), index.map().landmarks());
    let refused = with_turns(&index, &[ids(["L2", "L1", "L0"])]);
    assert!(matches!(refused, Err(PlanError::TurnContradicted { .. })), "{refused:?}");
}

#[test]
fn contradictions_and_what_tells_nothing_are_refused() {
    let index = square_and_pair();
    assert_eq!(
        align(&index, &Known::default()).unwrap_err().to_string(),
        "nothing to align the map with; give known positions, known distances or a known turn"
    );
    let twice = [ids(["L0", "L1", "L2"]), ids(["L1", "L0", "L3"])];
    assert_eq!(
        with_turns(&index, &twice).unwrap_err().to_string(),
        "that \"L1\", \"L0\" and \"L3\" turn left contradicts the known positions or another known turn; correct \
         one of them"
    );
    let truth = survey(&[("L0", [0.0, 0.0]), ("L1", [1.0, 0.0]), ("L3", [0.0, 1.0])]);
    assert!(matches!(
        with_positions(&index, &truth, &[ids(["L1", "L0", "L3"])]),
        Err(PlanError::TurnContradicted { .. })
    ));
    let refusal = |from, to, distance| with_distances(&index, &[ruler(from, to, distance)]).unwrap_err();
    assert_eq!(
        refusal("L0", "L1", -2.0).to_string(),
        "the distance from \"L0\" to \"L1\" is -2; give a finite one above 0"
    );
    assert!(matches!(refusal("L0", "L1", f64::NAN), PlanError::BadDistance { .. }));
    assert!(matches!(refusal("L0", "L0", 1.0), PlanError::Repeated { .. }));
    assert!(matches!(refusal("L0", "L4", 1.0), PlanError::Apart { .. }));
    assert!(matches!(refusal("L0", "L7", 1.0), PlanError::UnknownLandmark { .. }));
    let one_place = index_of(&[[1.0; 2]; 2], &[]);
    assert_eq!(
        with_distances(&one_place, &[ruler("L0", "L1", 1.0)]).unwrap_err().to_string(),
        "the known distances of component 0 are all between landmarks at one place of the map; measure others"
    );
}

#[test]
fn a_turn_of_landmarks_nearly_in_line_is_refused() {
    let index = index_of(&[[0.0, 0.0], [1.0, 0.01], [2.0, 0.0]], &[]);
    let refused = with_turns(&index, &[ids(["L0", "L1", "L2"])]).unwrap_err();
    assert!(matches!(refused, PlanError::UncertainTurn { probability, .. } if probability < 0.6));
    assert!(refused.to_string().starts_with(
        "\"L0\", \"L1\" and \"L2\" lie nearly in line on the map, which shows their turn with probability 0.5"
    ));
}

#[test]
fn a_random_similarity_is_undone() {
    let points = scattered(30, 4);
    let (sin, cos) = 0.7f64.sin_cos();
    for mirror in [1.0, -1.0] {
        let moved: Vec<Point> = points
            .iter()
            .map(|[x, y]| {
                [3.0 * (cos * x - sin * mirror * y) - 5.0, 3.0 * (sin * x + cos * mirror * y) + 1.0]
            })
            .collect();
        let rows: Vec<_> = points.iter().enumerate().take(4).map(|(i, &p)| (format!("L{i}"), p)).collect();
        let rows: Vec<_> = rows.iter().map(|(id, point)| (id.as_str(), *point)).collect();
        let aligned = with_positions(&index_of(&moved, &[]), &survey(&rows), &[]).unwrap();
        for (number, &wanted) in points.iter().enumerate() {
            assert_near(position(&aligned, number), wanted);
        }
    }
}
