use super::*;
use crate::fixtures::{log_of, looks, scattered};
use crate::{LandmarkId, Mapper, MapperParams, Method, PlacedLandmark, Range, Silent};

fn state() -> MapState {
    let looks = looks(&scattered(60, [2.0, 1.5], 3), [2.0, 1.5], 0.5, 600);
    let mut steps: Vec<Vec<String>> =
        looks.iter().map(|look| look.iter().map(usize::to_string).collect()).collect();
    // A component of two, a lone landmark, and a step without any.
    steps.extend([vec!["far".to_owned(), "away".to_owned()], vec!["lone".to_owned()], vec![]]);
    let log = SightingLog::from_steps(&steps);
    Mapper::new(MapperParams::default()).unwrap().build_with_state(log, &Silent).unwrap()
}

fn bytes(state: &MapState) -> Vec<u8> {
    let mut bytes = Vec::new();
    state.write(&mut bytes).unwrap();
    bytes
}

/// With a check sum that fits.
fn summed(mut body: Vec<u8>) -> Vec<u8> {
    let sum = crc32fast::hash(&body).to_le_bytes();
    body.extend(sum);
    body
}

fn refusal(bytes: &[u8]) -> String {
    MapState::parse(bytes, "s").unwrap_err().to_string()
}

/// Looks at a hall and how far the landmarks were, exactly, in a unit of a third of a metre.
fn ranged(steps: std::ops::Range<usize>) -> SightingLog {
    let places = scattered(60, [2.0, 1.5], 3);
    let looks = &looks(&places, [2.0, 1.5], 0.5, 600)[steps];
    let log = SightingLog::from_steps(looks.iter().map(|look| look.iter().map(usize::to_string)));
    let mut ranges = Vec::new();
    for (step, look) in looks.iter().enumerate() {
        // A place near the middle of what is in sight: any will do.
        let count = look.len() as f64;
        let [x, y] =
            look.iter().fold([0.1, 0.0], |[x, y], &i| [x + places[i][0] / count, y + places[i][1] / count]);
        for &landmark in log.step(step) {
            let at = places[log.names().name(LandmarkId(landmark)).parse::<usize>().unwrap()];
            ranges.push(Range { step, landmark, metres: 3.0 * (at[0] - x).hypot(at[1] - y) });
        }
    }
    log.with_ranges(ranges).unwrap()
}

#[test]
fn ranges_are_kept_and_go_on() {
    let mapper = Mapper::new(MapperParams::default()).unwrap();
    let mut state = mapper.build_with_state(ranged(0..500), &Silent).unwrap();
    let loaded = MapState::parse(&bytes(&state), "s").unwrap();
    assert!(loaded == state && loaded.log().ranges().len() > 1000);
    let before = state.map().clone();
    let report = state.update(&ranged(500..600), &Silent).unwrap();
    assert!(report.whole.is_some_and(|why| why.contains("ranges")));
    assert!(state.log().ranges() == ranged(0..600).ranges());
    // In metres, and where it was.
    let built = mapper.build(&ranged(0..600), &Silent).unwrap();
    assert_eq!(state.map().alignment(), built.alignment());
    let away = |a: &PlacedLandmark, b: &PlacedLandmark| {
        (a.position[0] - b.position[0]).hypot(a.position[1] - b.position[1])
    };
    let (updated, built) = (state.map().landmarks(), built.landmarks());
    for k in 1..60 {
        assert!((away(&updated[0], &updated[k]) - away(&built[0], &built[k])).abs() < 1e-9);
        assert!(away(&updated[k], &before.landmarks()[k]) < 0.01, "{k}");
    }
    // Steps without ranges are added to a map in metres, too.
    let bare = ranged(0..50).with_ranges(Vec::new()).unwrap();
    assert!(state.update(&bare, &Silent).unwrap().whole.is_some());
    assert_eq!(state.map().alignment().len(), 1);
}

#[test]
fn a_state_of_the_first_format_is_read() {
    let state = state();
    let now = bytes(&state);
    let counts = file::packed_pairs(&state.counts).len() + 8;
    let body = &now[..now.len() - 4];
    let (before, counts) = body.split_at(body.len() - counts);
    // Without the count and the length of no ranges.
    let mut then = [&before[..before.len() - 16], counts].concat();
    then[8] = 1;
    assert_eq!(MapState::parse(&summed(then), "s").unwrap(), state);
}

#[test]
fn a_state_comes_back_as_it_was_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("state");
    let state = state();
    state.save(&path).unwrap();
    let loaded = MapState::load(&path).unwrap();
    assert_eq!(loaded, state);
    assert_eq!(bytes(&loaded), bytes(&state));
    assert_eq!(loaded.counts(), &CoVisibility::count(loaded.log(), &Silent).unwrap());
    let update = |mut state: MapState| {
        state.update(&SightingLog::from_steps([["1", "2", "new"]]), &Silent).unwrap();
        state
    };
    assert_eq!(update(loaded), update(state));
}

#[test]
fn a_state_of_the_classical_method() {
    let log = log_of(&looks(&scattered(20, [1.0, 1.0], 3), [1.0, 1.0], 0.5, 200));
    let params = MapperParams { method: Method::Classical, ..MapperParams::default() };
    let state = Mapper::new(params).unwrap().build_with_state(log, &Silent).unwrap();
    assert_eq!(MapState::parse(&bytes(&state), "s").unwrap(), state);
}

#[test]
fn a_damaged_state_is_refused() {
    let whole = bytes(&state());
    for length in [0, 7, 11, 12, 100, whole.len() / 2, whole.len() - 5, whole.len() - 1] {
        assert!(refusal(&whole[..length]).starts_with("s: no whole state, "), "{length}");
    }
    for place in (20..whole.len()).step_by(whole.len() / 50) {
        let mut wrong = whole.clone();
        wrong[place] ^= 4;
        assert!(refusal(&wrong).contains("its check sum is "), "{place}");
    }
    let mut other = whole.clone();
    other[8] = 9;
    assert_eq!(
        refusal(&other),
        "s: state is format 9, this build reads 2; use the covimap that wrote it or build again with --state"
    );
    let foreign = "s: no whole state, it does not begin as one; give one that `covimap build --state` wrote, or build again";
    assert_eq!(refusal(b"{\"format\":1,\"landmarks\":[]}"), foreign);
}

/// Bytes that a check sum covers and that contradict each other all the same.
#[test]
fn a_state_that_contradicts_itself_is_refused() {
    let good = state();
    let changed = |change: fn(&mut MapState)| {
        let mut state = good.clone();
        change(&mut state);
        refusal(&bytes(&state))
    };
    assert!(changed(|state| state.ground.rules.truncate(1)).contains("it has 1 rules for 3 components"));
    let fewer = |state: &mut MapState| state.log = SightingLog::from_steps([["a", "b"]]);
    assert!(changed(fewer).contains("landmark"), "{}", changed(fewer));
    let body = bytes(&good);
    let body = &body[..body.len() - 4];
    assert!(refusal(&summed([body, &[0]].concat())).contains("5 bytes are left where 4 should be"));
    assert!(refusal(&summed(body[..body.len() - 10].to_vec())).contains("too early"));
}

#[test]
fn a_file_that_is_not_there_is_told() {
    let error = MapState::load(std::path::Path::new("no/state")).unwrap_err();
    assert!(matches!(error, MapError::Io { .. }));
    assert!(error.to_string().ends_with("give a state, as `covimap build --state` writes it"), "{error}");
}

#[test]
fn a_state_that_is_given_for_a_map_is_told() {
    let error = GlobalMap::parse_json(&bytes(&state()), "robot.state").unwrap_err().to_string();
    assert!(error.contains("this is a state, not a map"), "{error}");
}
