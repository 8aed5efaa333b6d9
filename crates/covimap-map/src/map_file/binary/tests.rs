use super::*;
use crate::LandmarkNames;
use crate::{BuildReport, ChartFit, MapperParams, SensorModel, SightLines};

/// Three landmarks in a row, aligned.
fn small() -> GlobalMap {
    let at = |x| PlacedLandmark {
        position: [x, -0.5],
        component: 0,
        region: 2,
        sightings: 7,
        partners: 2,
        ..Default::default()
    };
    let names = ["A", "", "Ångström"].into_iter().collect();
    let map = GlobalMap::from_parts(
        names,
        vec![at(0.1), at(1e-300), at(-3.0)],
        MapperParams::default(),
        BuildReport::default(),
    );
    let lines = [(LandmarkId(0), LandmarkId(1), 7), (LandmarkId(2), LandmarkId(1), 3)];
    let map = map.unwrap().with_sight_lines(SightLines::from_pairs(3, lines).unwrap()).unwrap();
    let fit = ChartFit { component: 0, scale: 0.5, anchors: 3, distances: 0, rmse: 0.25, handed: true };
    let map = map.with_positions(&[[0.1, -0.5], [1e-300, 2.0], [-3.0, -0.0]], vec![fit]).unwrap();
    let sensor = SensorModel { range: 0.5, edge: 0.04, detectability: 0.9, outliers: 0.001 };
    let sensed = [(0.9, 0.01, 0.25), (0.8, 0.02, 0.0), (0.7, 0.03, 0.125)]
        .map(|(detectability, deviation, warp)| Sensed { detectability, deviation, warp });
    let sensing = Sensing::from_parts(vec![sensor], sensed.to_vec(), &[[0, 2]]);
    map.with_sensing(sensing.unwrap()).unwrap()
}

fn bytes_of(map: &GlobalMap) -> Vec<u8> {
    let mut bytes = Vec::new();
    map.write_binary(&mut bytes).unwrap();
    bytes
}

/// With a check sum that fits.
fn summed(mut bytes: Vec<u8>) -> Vec<u8> {
    let body = bytes.len() - 4;
    let sum = crc32fast::hash(&bytes[..body]);
    bytes[body..].copy_from_slice(&sum.to_le_bytes());
    bytes
}

fn refusal(bytes: &[u8]) -> String {
    GlobalMap::parse_binary(bytes, "m.covimap").unwrap_err().to_string()
}

#[test]
fn the_name_decides_how_a_map_is_saved_and_both_forms_load_as_the_same_map() {
    let folder = tempfile::tempdir().unwrap();
    for (name, binary) in [("m.covimap", true), ("m.json", false), ("covimap", false)] {
        let path = folder.path().join(name);
        small().save(&path).unwrap();
        assert_eq!(is_binary(&std::fs::read(&path).unwrap()), binary, "{name}");
        assert_eq!(GlobalMap::load(&path).unwrap(), small(), "{name}");
    }
}

#[test]
fn a_map_without_landmarks_is_a_map() {
    let (params, report) = (MapperParams::default(), BuildReport::default());
    let empty = GlobalMap::from_parts(LandmarkNames::default(), Vec::new(), params, report).unwrap();
    assert_eq!(GlobalMap::parse_binary(&bytes_of(&empty), "m").unwrap(), empty);
}

#[test]
fn a_file_from_before_there_was_a_warp_is_a_map_without_bends() {
    let whole = bytes_of(&small());
    let head = 20 + u64::from_le_bytes(whole[12..20].try_into().unwrap()) as usize;
    let old_head = String::from_utf8(whole[20..head].to_vec()).unwrap().replace(",\"sensed\":3", "");
    // Sizes, lengths and letters of the IDs, coordinates and numbers of three landmarks.
    let sensed = head + 24 + 12 + 11 + 48 + 72;
    let kept = |place: &usize| (place - sensed) % 24 < 16;
    let of_landmarks: Vec<u8> = (sensed..sensed + 72).filter(kept).map(|place| whole[place]).collect();
    let length = (old_head.len() as u64).to_le_bytes();
    let parts = [&whole[..12], &length, old_head.as_bytes(), &whole[head..sensed], &of_landmarks];
    let old = summed([&parts.concat()[..], &whole[sensed + 72..]].concat());
    let map = GlobalMap::parse_binary(&old, "m").unwrap();
    for id in [0, 1, 2].map(LandmarkId) {
        let wanted = Sensed { warp: 0.0, ..*small().sensing().unwrap().of(id) };
        assert_eq!(*map.sensing().unwrap().of(id), wanted);
    }
    let later = String::from_utf8(whole[20..head].to_vec()).unwrap().replace("\"sensed\":3", "\"sensed\":4");
    let later = [&whole[..20], later.as_bytes(), &whole[head..]].concat();
    assert!(refusal(&summed(later)).contains("its head tells 4 numbers of each landmark"));
}

#[test]
fn no_byte_can_be_changed_or_lost_unnoticed() {
    let whole = bytes_of(&small());
    for place in 0..whole.len() {
        let mut changed = whole.clone();
        changed[place] ^= 0x10;
        assert!(GlobalMap::parse_binary(&changed, "m").is_err(), "byte {place}");
        assert!(GlobalMap::parse_binary(&whole[..place], "m").is_err(), "{place} bytes");
    }
    let longer = [&whole[..], &[0]].concat();
    assert!(refusal(&longer).contains("its check sum is"));
}

#[test]
fn what_is_wrong_is_said() {
    let whole = bytes_of(&small());
    assert_eq!(
        refusal(&whole[..5]),
        "m.covimap: the map file is damaged, it ends 3 bytes too early; copy it again or build the map again"
    );
    assert!(refusal(b"no map at all").contains("it does not begin as one"));
    let mut later = whole.clone();
    later[8] = 9;
    assert!(matches!(
        GlobalMap::parse_binary(&later, "m"),
        Err(MapError::MapFormat { found: 9, known: FORMAT, .. })
    ));
    assert!(refusal(&whole[..whole.len() - 1]).contains("its check sum is"));
}

#[test]
fn files_with_a_fitting_check_sum_are_checked_too() {
    let whole = bytes_of(&small());
    let head = u64::from_le_bytes(whole[12..20].try_into().unwrap()) as usize;
    let with = |place: usize, value: &[u8]| {
        let mut bytes = whole.clone();
        bytes[place..place + value.len()].copy_from_slice(value);
        refusal(&summed(bytes))
    };
    let sizes = 20 + head;
    assert!(with(12, &u64::MAX.to_le_bytes()).contains("too early"));
    assert!(with(20, b"!").contains("its head, expected"));
    assert!(with(sizes, &u64::MAX.to_le_bytes()).contains("its sizes are beyond any memory"));
    assert!(with(sizes, &2u64.to_le_bytes()).contains("bytes are left where 4 should be"));
    assert!(with(sizes + 24, &100u32.to_le_bytes()).contains("the lengths of its IDs do not add up"));
    // The IDs begin after three lengths: A, then Ångström.
    assert!(with(sizes + 36, &[0xff]).contains("its IDs are no text"));
    // Then come 11 bytes of IDs and the coordinates.
    let refused = with(sizes + 47, &f64::NAN.to_le_bytes());
    assert_eq!(refused, "m.covimap: landmark 0 \"A\" is at (NaN, -0.5), positions must be finite");
    let joined = with(whole.len() - 8, &99u32.to_le_bytes());
    assert!(joined.starts_with("m.covimap: the line of sight between landmarks"), "{joined}");
}
