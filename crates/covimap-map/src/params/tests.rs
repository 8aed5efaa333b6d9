use super::*;
use crate::fixtures::{log_of, looks, scattered};
use crate::{GlobalMap, Mapper, Silent};

fn refusal(change: impl Fn(&mut AutoParams)) -> String {
    let mut params = MapperParams::default();
    change(&mut params.auto);
    let error = Mapper::new(params).unwrap_err();
    assert!(matches!(error, MapError::BadParameter { .. }));
    error.to_string()
}

#[test]
fn settings_out_of_range_are_refused_by_name() {
    assert_eq!(refusal(|auto| auto.regions.core = 3), "setting auto.regions.core is 3; give at least 4");
    assert_eq!(
        refusal(|auto| auto.regions.members = 23),
        "setting auto.regions.members is 23; give at least twice auto.regions.core"
    );
    assert_eq!(
        refusal(|auto| auto.regions.halo_links = 0),
        "setting auto.regions.halo_links is 0; give at least 1"
    );
    assert_eq!(
        refusal(|auto| auto.local_stop.max_iterations = 0),
        "setting auto.local_stop is 0; give at least 1 step"
    );
    for tolerance in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(
            refusal(|auto| auto.polish_stop.tolerance = tolerance),
            format!("setting auto.polish_stop is {tolerance}; give a positive tolerance")
        );
    }
    // The settings of the paper's method are checked as well.
    let mut params = MapperParams::default();
    params.classical.lo = 3.0;
    assert!(matches!(Mapper::new(params), Err(MapError::BadParameter { name: "classical.hi", .. })));
}

#[test]
fn the_least_settings_that_are_allowed_make_a_map() {
    let mut params = MapperParams::default();
    let stop = StopParams { max_iterations: 1, tolerance: 1e-300 };
    params.auto = AutoParams {
        regions: RegionParams { core: 4, members: 8, halo_links: 1 },
        local_stop: stop,
        polish_stop: stop,
        distance: DistanceChoice::FixedLog,
        split_aliases: true,
        refine_iterations: 0,
    };
    assert!(build(params).landmarks().iter().all(|landmark| landmark.position[0].is_finite()));
}

#[test]
fn settings_are_read_as_they_are_written_and_unknown_ones_refused() {
    let mut params = MapperParams::default();
    params.classical.alpha = Some(0.25);
    params.auto.regions.core = 20;
    params.method = Method::Classical;
    let text = serde_json::to_string(&params).unwrap();
    assert_eq!(serde_json::from_str::<MapperParams>(&text).unwrap(), params);
    assert_eq!(serde_json::from_str::<MapperParams>("{}").unwrap(), MapperParams::default());
    for unknown in [
        r#"{"sede": 1}"#,
        r#"{"auto": {"region": {}}}"#,
        r#"{"auto": {"regions": {"size": 12}}}"#,
        r#"{"auto": {"local_stop": {"max_iterations": 5, "tolerance": 1, "eps": 1}}}"#,
        r#"{"classical": {"clamp": 2}}"#,
        r#"{"method": "smacof"}"#,
    ] {
        assert!(serde_json::from_str::<MapperParams>(unknown).is_err(), "{unknown}");
    }
}

#[test]
fn a_distance_function_is_written_by_its_name() {
    let written = |choice| serde_json::to_string::<DistanceChoice>(&choice).unwrap();
    assert_eq!(written(DistanceChoice::Auto), r#""auto""#);
    assert_eq!(written(DistanceChoice::FixedLog), r#""fixed_log""#);
    for family in DistanceFamily::ALL {
        let text = written(DistanceChoice::Family(family));
        assert_eq!(text, format!("{:?}", family.name()));
        assert_eq!(serde_json::from_str::<DistanceChoice>(&text).unwrap(), DistanceChoice::Family(family));
    }
    assert!(serde_json::from_str::<DistanceChoice>(r#""cosine""#).is_err());
}

fn build(params: MapperParams) -> GlobalMap {
    let extent = [4.0, 5.0];
    let log = log_of(&looks(&scattered(200, extent, 1), extent, 0.6, 1500));
    Mapper::new(params).unwrap().build(&log, &Silent).unwrap()
}

/// What is changed, and how.
type Change = (&'static str, fn(&mut MapperParams));

#[test]
fn every_setting_reaches_the_code() {
    let auto: [Change; 10] = [
        ("core", |p| p.auto.regions.core = 20),
        ("members", |p| p.auto.regions.members = 30),
        ("halo_links", |p| p.auto.regions.halo_links = 1),
        ("local steps", |p| p.auto.local_stop.max_iterations = 3),
        ("local tolerance", |p| p.auto.local_stop.tolerance = 0.1),
        ("polish steps", |p| p.auto.polish_stop.max_iterations = 1),
        ("polish tolerance", |p| p.auto.polish_stop.tolerance = 0.1),
        ("distance", |p| p.auto.distance = DistanceChoice::Family(DistanceFamily::Lens)),
        ("refinement", |p| p.auto.refine_iterations = 1),
        ("method", |p| p.method = Method::Classical),
    ];
    let classical: [Change; 5] = [
        ("phi", |p| p.classical.phi = Phi::Phi1),
        ("alpha", |p| p.classical.alpha = Some(0.2)),
        ("lo", |p| p.classical.lo = 0.3),
        ("hi", |p| p.classical.hi = 1.0),
        ("tic", |p| p.classical.tic = false),
    ];
    for (method, changes) in [(Method::Auto, &auto[..]), (Method::Classical, &classical)] {
        let params = MapperParams { method, ..MapperParams::default() };
        let plain = build(params.clone());
        for (name, change) in changes {
            let mut changed = params.clone();
            change(&mut changed);
            let map = build(changed.clone());
            assert_eq!(map.params(), &changed);
            assert_ne!(map.landmarks(), plain.landmarks(), "{name} changes nothing");
        }
    }
}
