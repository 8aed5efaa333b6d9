use std::sync::Mutex;

use covimap_embed::{Correspondence, ProcrustesOptions, Reflection, procrustes};

use super::*;
use crate::fixtures::{distance, log_of, looks, on_threads, scattered};
use crate::{DistanceChoice, Silent, Stage, StopParams};

fn mapper(method: Method) -> Mapper {
    Mapper::new(MapperParams { method, ..MapperParams::default() }).unwrap()
}

fn build(log: &SightingLog, method: Method) -> Result<GlobalMap, MapError> {
    mapper(method).build(log, &Silent)
}

fn map_of(steps: &[&[&str]]) -> GlobalMap {
    build(&SightingLog::from_steps(steps.iter().map(|step| step.iter().copied())), Method::Auto).unwrap()
}

fn position(map: &GlobalMap, id: &str) -> Point {
    let place = map.names().iter().position(|name| name == id).unwrap();
    map.landmarks()[place].position
}

/// Two halls of 200 and 60 landmarks, looked at by turns, and landmark 260 by itself.
fn two_halls() -> SightingLog {
    let (large, small) = (scattered(200, [4.0, 5.0], 1), scattered(60, [2.0, 3.0], 2));
    let first = looks(&large, [4.0, 5.0], 0.6, 1500);
    let second = looks(&small, [2.0, 3.0], 0.6, 500);
    let second = second.iter().map(|look| look.iter().map(|i| i + 200).collect());
    let mut all: Vec<Vec<usize>> = second.chain([vec![260], vec![260]]).collect();
    all.extend(first);
    log_of(&all)
}

#[test]
fn logs_that_make_no_map() {
    for method in [Method::Auto, Method::Classical] {
        let refusal = |steps: &[&[&str]]| {
            let log = SightingLog::from_steps(steps.iter().map(|step| step.iter().copied()));
            build(&log, method).unwrap_err()
        };
        let lonely: [&[&[&str]]; 4] = [&[], &[&[]], &[&["A"]], &[&["A"], &["B"], &["A"]]];
        for steps in lonely {
            assert!(matches!(refusal(steps), MapError::NothingTogether { .. }), "{steps:?}");
        }
        assert_eq!(
            refusal(&[&["A"], &["B"], &["A"]]).to_string(),
            "no step shows two landmarks - 2 landmarks in 3 steps; pool several sightings of a slow or narrow \
             sensor into one step"
        );
        let together: [&[&str]; 3] = [&["A", "B", "C"], &[], &["C", "A", "B"]];
        assert!(matches!(refusal(&together), MapError::NoInformation { landmarks: 3, steps: 2 }));
        assert_eq!(
            refusal(&together).to_string(),
            "all 3 landmarks are seen in the same 2 steps, so nothing tells how far apart they are; limit the range \
             of the sensor or move the robot further"
        );
    }
}

#[test]
fn two_landmarks_are_one_distance_apart() {
    // n = 2 and 1, together once: f = 1.5 / (2 + 1 - 1 + 1) = 1/2, d = sqrt(0.3 ln 2) = 0.4560090.
    let map = map_of(&[&["A", "B"], &["A"]]);
    assert!((position(&map, "A")[0] - 0.456_009_0 / 2.0).abs() < 1e-7);
    assert!((position(&map, "B")[0] + 0.456_009_0 / 2.0).abs() < 1e-7);
    // Always together is no contradiction for two.
    let map = map_of(&[&["A", "B"]]);
    assert!(distance(position(&map, "A"), position(&map, "B")) > 0.1);
    assert_eq!(map.report().warnings.iter().filter(|w| w.kind == "too_few_landmarks").count(), 1);
}

#[test]
fn three_landmarks_make_a_triangle() {
    // A and B are together more often than either is with C.
    let map = map_of(&[&["A", "B"], &["A", "B"], &["A", "B", "C"], &["B", "C"], &["A", "C"], &["C"]]);
    let side = |a, b| distance(position(&map, a), position(&map, b));
    assert!(side("A", "B") < side("A", "C") && side("A", "B") < side("B", "C"));
    assert!(map.landmarks().iter().all(|landmark| landmark.position.iter().all(|c| c.is_finite())));
    assert!(map.report().components[0].converged);
    let kinds: Vec<&str> = map.report().warnings.iter().map(|warning| warning.kind.as_str()).collect();
    assert_eq!(kinds, ["too_few_landmarks"]);
}

#[test]
fn components_are_charts_of_their_own_with_regions_of_their_own() {
    for method in [Method::Auto, Method::Classical] {
        let map = build(&two_halls(), method).unwrap();
        let report = map.report();
        let sizes: Vec<u64> = report.components.iter().map(|component| component.landmarks).collect();
        assert_eq!(sizes, [200, 60, 1], "{method:?}");
        assert_eq!(report.regions, report.components.iter().map(|component| component.regions).sum::<u64>());
        let mut first_region = 0;
        for (number, component) in (0..).zip(&report.components) {
            let members: Vec<_> =
                map.landmarks().iter().filter(|landmark| landmark.component == number).collect();
            // Landmarks 0 to 199, then 200 to 259, then 260.
            assert_eq!(members.len() as u64, component.landmarks);
            let n = members.len() as f64;
            let mean = |axis: usize| members.iter().map(|landmark| landmark.position[axis]).sum::<f64>() / n;
            assert!(mean(0).hypot(mean(1)) < 1e-9, "{method:?}: component {number} is not centred");
            // Every region of the component, and no other, has landmarks in it.
            let mut regions: Vec<u64> = members.iter().map(|landmark| u64::from(landmark.region)).collect();
            regions.sort_unstable();
            regions.dedup();
            assert_eq!(regions, (first_region..first_region + component.regions).collect::<Vec<_>>());
            first_region += component.regions;
            let partners: u64 = members.iter().map(|landmark| u64::from(landmark.partners)).sum();
            assert_eq!(partners, 2 * component.pairs);
        }
        assert_eq!(report.components[0].regions > 1, method == Method::Auto);
        assert_eq!(map.landmarks()[260].position, [0.0, 0.0]);
        let pairs: u64 = report.components.iter().map(|component| component.pairs).sum();
        assert_eq!((report.landmarks, report.pairs, report.steps), (261, pairs, 261 + 2002));
    }
}

#[test]
fn a_component_does_not_depend_on_what_else_is_in_the_log() {
    let large = scattered(200, [4.0, 5.0], 1);
    let alone = build(&log_of(&looks(&large, [4.0, 5.0], 0.6, 1500)), Method::Auto).unwrap();
    let both = build(&two_halls(), Method::Auto).unwrap();
    for (a, b) in alone.landmarks().iter().zip(both.landmarks()) {
        assert_eq!(a.position, b.position);
    }
}

#[test]
fn names_do_not_matter() {
    let truth = scattered(60, [2.0, 3.0], 2);
    let looks = looks(&truth, [2.0, 3.0], 0.6, 600);
    let renamed: Vec<Vec<usize>> = looks.iter().map(|look| look.iter().map(|i| 59 - i).collect()).collect();
    // Polished to the end: where steps stop on the way depends on the order of sums. Learning the distances never
    // ends; what is left open there is small against what the log leaves open, some 0.02.
    let settings = [
        (Method::Auto, DistanceChoice::FixedLog, 1e-4),
        (Method::Auto, DistanceChoice::Auto, 2e-3),
        (Method::Classical, DistanceChoice::Auto, 1e-4),
    ];
    for (method, distance, close) in settings {
        let mut params = MapperParams { method, ..MapperParams::default() };
        params.auto.polish_stop = StopParams { max_iterations: 1000, tolerance: 1e-12 };
        params.auto.distance = distance;
        let mapper = Mapper::new(params).unwrap();
        let map_of = |looks: &Vec<Vec<usize>>| mapper.build(&log_of(looks), &Silent).unwrap();
        let [map, other] = [&looks, &renamed].map(map_of);
        let pairs = (0..60).map(|i| Correspondence {
            source: position(&map, &i.to_string()),
            target: position(&other, &(59 - i).to_string()),
            weight: 1.0,
        });
        let options = ProcrustesOptions { scale: false, reflection: Reflection::Allow };
        let rmse = procrustes(&pairs.collect::<Vec<_>>(), options).unwrap().rmse;
        assert!(rmse < close, "{method:?}, {distance:?}: {rmse}");
    }
}

/// Writes down what it is told, and asks to stop at the beginning of a stage.
#[derive(Default)]
struct Diary {
    told: Mutex<Vec<(Stage, bool)>>,
    stop_at: Option<Stage>,
}

impl Observer for Diary {
    fn started(&self, stage: Stage, _total: Option<u64>) {
        self.told.lock().unwrap().push((stage, true));
    }

    fn finished(&self, stage: Stage) {
        self.told.lock().unwrap().push((stage, false));
    }

    fn interrupted(&self) -> bool {
        self.stop_at.is_some_and(|stage| self.told.lock().unwrap().contains(&(stage, true)))
    }
}

#[test]
fn every_stage_is_told_once_for_each_component_and_ends_before_the_next() {
    let auto = [
        Stage::Regions,
        Stage::LocalMaps,
        Stage::Stitch,
        Stage::Variants,
        Stage::Lift,
        Stage::Distances,
        Stage::Polish,
        Stage::Refine,
    ];
    for (method, stages) in [(Method::Auto, &auto[..]), (Method::Classical, &[Stage::Classical])] {
        let diary = Diary::default();
        mapper(method).build(&two_halls(), &diary).unwrap();
        // Two components, and the landmark by itself, of which nothing is learnt.
        let learnt = [Stage::Variants, Stage::Lift, Stage::Refine];
        let lone: Vec<Stage> = stages.iter().copied().filter(|stage| !learnt.contains(stage)).collect();
        let wanted = [&[Stage::Count], stages, stages, &lone, &[Stage::Sensor]].concat();
        let wanted: Vec<_> = wanted.iter().flat_map(|&stage| [(stage, true), (stage, false)]).collect();
        assert_eq!(diary.told.into_inner().unwrap(), wanted, "{method:?}");
    }
}

#[test]
fn a_build_stops_in_any_stage() {
    let auto = [
        Stage::Count,
        Stage::Regions,
        Stage::LocalMaps,
        Stage::Stitch,
        Stage::Variants,
        Stage::Lift,
        Stage::Distances,
        Stage::Polish,
        Stage::Refine,
        Stage::Sensor,
    ];
    let stages = auto.map(|stage| (Method::Auto, stage));
    for (method, stage) in stages.into_iter().chain([(Method::Classical, Stage::Classical)]) {
        let diary = Diary { stop_at: Some(stage), ..Diary::default() };
        let ended = mapper(method).build(&two_halls(), &diary);
        assert!(matches!(ended, Err(MapError::Interrupted)), "{stage:?}");
        // Nothing is begun after it.
        assert_eq!(diary.told.into_inner().unwrap().last(), Some(&(stage, true)));
    }
}

#[test]
fn a_polish_that_is_cut_short_is_told() {
    let mut params = MapperParams::default();
    params.auto.polish_stop.max_iterations = 1;
    let map = Mapper::new(params).unwrap().build(&two_halls(), &Silent).unwrap();
    let warning = map.report().warnings.iter().find(|warning| warning.kind == "not_converged").unwrap();
    // The landmark by itself has nothing to converge.
    assert_eq!(warning.count, 2);
    assert_eq!(map.report().components.iter().map(|c| c.iterations).collect::<Vec<_>>(), [1, 1, 0]);
}

#[test]
fn the_same_bits_on_one_thread_and_on_three() {
    let log = two_halls();
    for method in [Method::Auto, Method::Classical] {
        let run = |threads| on_threads(threads, || build(&log, method).unwrap());
        assert_eq!(run(1), run(3), "{method:?}");
    }
}

#[test]
fn a_landmark_without_an_honest_link_is_kept_and_told() {
    // Every hundredth sighting is of another landmark, now and then of 300, which is nowhere.
    let points = scattered(300, [5.0, 6.0], 1);
    let mut looks = looks(&points, [5.0, 6.0], 0.6, 6000);
    for (number, look) in looks.iter_mut().enumerate() {
        if number % 10 == 0
            && let Some(seen) = look.last_mut()
        {
            *seen = if number % 200 == 0 { 300 } else { number * 7919 % 300 };
        }
        look.sort_unstable();
        look.dedup();
    }
    let map = build(&log_of(&looks), Method::Auto).unwrap();
    let report = map.report();
    assert_eq!((map.len(), report.components.len(), report.components[0].landmarks), (301, 2, 300));
    let of_300 = map.names().iter().position(|id| id == "300").unwrap();
    let placed = map.landmarks()[of_300];
    assert_eq!((placed.component, placed.partners, placed.position), (1, 0, [0.0, 0.0]));
    assert!(placed.sightings > 25, "{placed:?}");
    let told = report.honesty.misrecognition.unwrap();
    assert!((0.006..0.014).contains(&told) && report.honesty.set_aside > 1000, "{:?}", report.honesty);
    let about = |kind: &str| report.warnings.iter().find(|warning| warning.kind == kind).unwrap();
    assert_eq!(about("all_links_doubtful").examples, ["300"]);
    assert_eq!(about("misrecognition").count, report.honesty.set_aside);
    assert!(report.warnings.iter().all(|warning| warning.kind != "never_together"));
}

#[test]
fn a_start_of_ones_own_may_be_in_any_frame_and_unit() {
    let points = scattered(30, [2.0, 2.0], 3);
    let log = log_of(&looks(&points, [2.0, 2.0], 0.6, 600));
    let from = |start: &[Point], method| mapper(method).build_from(&log, start, &Silent).unwrap();
    let map = from(&points, Method::Auto);
    // Turned by a right angle, mirrored, and in millimetres somewhere else.
    let moved: Vec<Point> = points.iter().map(|[x, y]| [1000.0 * y + 77.0, 1000.0 * x - 5.0]).collect();
    for (a, b) in map.landmarks().iter().zip(from(&moved, Method::Auto).landmarks()) {
        assert!(distance(a.position, b.position) < 1e-4, "{:?} {:?}", a.position, b.position);
    }
    assert_eq!(map.report().regions, 1);
    // The paper's method has no start; what is built is a map by auto, and says so.
    assert_eq!(from(&points, Method::Classical), map);
}

#[test]
fn starts_that_do_not_fit_the_log() {
    let log = SightingLog::from_steps([["A", "B"], ["B", "C"]]);
    let refusal = |start: &[Point]| mapper(Method::Auto).build_from(&log, start, &Silent).unwrap_err();
    assert!(matches!(
        refusal(&[[0.0; 2]; 2]),
        MapError::Embed(EmbedError::BadStart { found: 2, wanted: 3, .. })
    ));
    for bad in [f64::NAN, f64::INFINITY] {
        assert!(matches!(refusal(&[[0.0; 2], [1.0, bad], [1.0; 2]]), MapError::NotFinite { index: 1, .. }));
    }
    // All in one place: no scale.
    let refused = refusal(&[[1.0; 2]; 3]);
    assert!(matches!(refused, MapError::Embed(EmbedError::CoincidingPoints { pairs: 2 })), "{refused}");
}
