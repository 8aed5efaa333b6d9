use covimap_embed::{Correspondence, Point, ProcrustesOptions, procrustes};

use super::*;
use crate::fixtures::{distance, looks, on_threads, scattered};
use crate::{Mapper, MapperParams, Silent};

/// Range of the sensor.
const RANGE: f64 = 0.5;

/// A world of 20 landmarks a unit square.
struct World {
    points: Vec<Point>,
    height: f64,
}

impl World {
    fn new(width: f64, height: f64) -> Self {
        Self { points: scattered((20.0 * width * height) as usize, [width, height], 1), height }
    }

    /// What is seen from so many places with `x` from `from` to `to`.
    fn steps(&self, [from, to]: [f64; 2], steps: usize) -> Vec<Vec<String>> {
        let shifted: Vec<Point> = self.points.iter().map(|[x, y]| [x - from, *y]).collect();
        let looks = looks(&shifted, [to - from, self.height], RANGE, steps);
        looks.iter().map(|look| look.iter().map(|landmark| format!("L{landmark}")).collect()).collect()
    }

    /// Distances of a component's landmarks from their true places, after the best rigid fit of the first
    /// `fitted` landmarks in the log's order, in the units of the world.
    fn errors(&self, map: &GlobalMap) -> Vec<f64> {
        let pairs: Vec<Correspondence> = map
            .names()
            .iter()
            .zip(map.landmarks())
            .filter(|(_, placed)| placed.component == 0)
            .map(|(id, placed)| Correspondence {
                source: placed.position,
                target: self.place(id),
                weight: 1.0,
            })
            .collect();
        let fit = procrustes(&pairs, ProcrustesOptions::default()).unwrap().target_from_source;
        pairs.iter().map(|pair| distance(fit.apply(pair.source), pair.target)).collect()
    }

    fn rmse(&self, map: &GlobalMap) -> f64 {
        let errors = self.errors(map);
        (errors.iter().map(|error| error * error).sum::<f64>() / errors.len() as f64).sqrt()
    }

    fn place(&self, id: &str) -> Point {
        self.points[id[1..].parse::<usize>().unwrap()]
    }
}

fn log(steps: &[Vec<String>]) -> SightingLog {
    SightingLog::from_steps(steps)
}

fn built(steps: &[Vec<String>]) -> MapState {
    Mapper::new(MapperParams::default()).unwrap().build_with_state(log(steps), &Silent).unwrap()
}

fn updated(state: &MapState, steps: &[Vec<String>]) -> (MapState, UpdateReport) {
    let mut next = state.clone();
    let report = next.update(&log(steps), &Silent).unwrap();
    assert_eq!(next.map.report().update.as_ref(), Some(&report));
    // Whatever was solved, counts are exactly those of the joined log.
    let counts = CoVisibility::count(&next.log, &Silent).unwrap();
    assert_eq!(next.counts, counts);
    assert_eq!(next.map.report().steps, counts.steps());
    (next, report)
}

/// Landmarks whose places two maps have to the last bit.
fn unmoved(before: &GlobalMap, after: &GlobalMap) -> usize {
    let pairs = before.landmarks().iter().zip(after.landmarks());
    pairs.filter(|(before, after)| before.position == after.position).count()
}

#[test]
fn a_part_seen_again_moves_and_the_rest_does_not() {
    let world = World::new(7.0, 2.0);
    let state = built(&world.steps([0.0, 7.0], 4200));
    let (next, report) = updated(&state, &world.steps([3.0, 4.0], 300));
    assert_eq!((report.whole, report.landmarks, report.steps), (None, 0, 300));
    // 300 looks at 2 of 14 square units, where 600 were before: what is seen from there is free, 4 square units
    // with 20 landmarks each, and whom they push.
    assert!((30..140).contains(&report.solved), "{}", report.solved);
    assert_eq!(unmoved(&state.map, &next.map), state.map.len() - report.solved as usize);
    // What is far from it keeps all that is known of it.
    let sensing = |map: &GlobalMap, id| *map.sensing().unwrap().of(id);
    for (id, name) in (0..).map(crate::LandmarkId).zip(state.map.names().iter()) {
        if (world.place(name)[0] - 3.5).abs() > 1.5 {
            assert_eq!(sensing(&state.map, id), sensing(&next.map, id), "{name}");
        }
    }
    assert!(world.rmse(&next.map) < 1.1 * world.rmse(&state.map));
}

#[test]
fn evidence_that_is_spread_thin_moves_nothing_but_is_not_forgotten() {
    let world = World::new(5.0, 2.0);
    let mut state = built(&world.steps([0.0, 5.0], 3000));
    let whole = state.map.clone();
    let mut reports = Vec::new();
    for k in 0..5 {
        // 2 % each.
        let (next, report) = updated(&state, &world.steps([0.0, 5.0], 60 + k));
        reports.push(report);
        state = next;
    }
    assert!(reports[0].whole.is_none() && reports[0].solved < 40, "{:?}", reports[0]);
    assert!(unmoved(&whole, &state.map) < 10);
    let solved_whole: Vec<usize> = (0..5).filter(|&k| reports[k].whole.is_some()).collect();
    // 60 + 61 + .. of 3000 + 60 + 61 + ..: beyond a twelfth with the fifth.
    assert_eq!(solved_whole, [4]);
    assert_eq!(state.ground.whole, state.log.sightings() as u64);
    assert!(world.rmse(&state.map) < 1.1 * world.rmse(&whole));
}

#[test]
fn new_landmarks_get_their_places_in_the_old_frame() {
    let world = World::new(7.0, 2.0);
    // From x < 6 what is at x < 6.5 is seen.
    let state = built(&world.steps([0.0, 6.0], 4000));
    let (next, report) = updated(&state, &world.steps([5.6, 7.0], 300));
    assert_eq!(report.whole, None);
    assert!(report.landmarks > 15, "{report:?}");
    assert!(unmoved(&state.map, &next.map) > 150, "{report:?}");
    let errors = world.errors(&next.map);
    let new = &errors[state.map.len()..];
    let rms = (new.iter().map(|e| e * e).sum::<f64>() / new.len() as f64).sqrt();
    // At the rim, and seen by a tenth of the steps of the others: twice the error of the others is allowed.
    assert!(rms < 2.0 * world.rmse(&state.map).max(0.05), "{rms} {}", world.rmse(&state.map));
    assert!(next.map.landmarks()[state.map.len()..].iter().all(|placed| placed.component == 0));
    assert_eq!(next.map.report().components.len(), 1);
    // The chart is bent there as it was at its old rim, where landmarks were seldom seen.
    let warp = |map: &GlobalMap, id: &str| {
        let number = map.names().iter().position(|name| name == id).unwrap();
        map.sensing().unwrap().of(crate::LandmarkId(number as u32)).warp
    };
    // As good as a build of the joined log.
    let full = built(&[world.steps([0.0, 6.0], 4000), world.steps([5.6, 7.0], 300)].concat());
    let ratio = next.map.report().stress1 / full.map.report().stress1;
    assert!((0.97..1.03).contains(&ratio), "{ratio}");
    assert!(world.rmse(&next.map) < 1.3 * world.rmse(&full.map));
    let new: Vec<&str> = next.map.names().iter().skip(state.map.len()).collect();
    let square = |map: &GlobalMap| new.iter().map(|id| warp(map, id).powi(2)).sum::<f64>();
    let ratio = (square(&next.map) / square(&full.map)).sqrt();
    assert!((0.7..3.0).contains(&ratio), "{ratio}");
}

#[test]
fn a_large_chart_that_new_steps_join_is_carried_into_the_frame_of_the_larger() {
    let world = World::new(12.6, 2.0);
    // What is seen from x < 6 is at x < 6.8, what is seen from x > 7.8 at x > 7.
    let apart = [world.steps([0.0, 6.0], 3000), world.steps([7.8, 12.6], 2400)].concat();
    let state = built(&apart);
    let sizes: Vec<u64> = state.map.report().components.iter().map(|c| c.landmarks).collect();
    assert!(sizes[1] > 150, "{sizes:?}");
    let (next, report) = updated(&state, &world.steps([6.2, 7.6], 400));
    assert_eq!((report.whole.as_ref(), report.carried), (None, 1));
    assert_eq!(next.map.report().components[0].landmarks, sizes.iter().sum::<u64>() + report.landmarks);
    let kinds: Vec<&str> = next.map.report().warnings.iter().map(|warning| warning.kind.as_str()).collect();
    assert!(kinds.contains(&"charts_joined") && !kinds.contains(&"components"), "{kinds:?}");
    // The larger chart stays, but for the end where they meet.
    assert!(unmoved(&state.map, &next.map) > sizes[0] as usize / 2);
    let full = built(&[apart, world.steps([6.2, 7.6], 400)].concat());
    assert!(
        world.rmse(&next.map) < 2.0 * world.rmse(&full.map),
        "{} {}",
        world.rmse(&next.map),
        world.rmse(&full.map)
    );
}

#[test]
fn a_small_chart_that_new_steps_join_is_solved_again_in_the_frame_of_the_larger() {
    let world = World::new(9.0, 2.0);
    let apart = [world.steps([0.0, 6.0], 3000), world.steps([7.8, 8.6], 500)].concat();
    let state = built(&apart);
    let small = state.map.report().components[1].landmarks;
    assert!((30..150).contains(&small), "{small}");
    let (next, report) = updated(&state, &world.steps([6.2, 7.6], 260));
    assert_eq!((report.whole, report.carried), (None, 0));
    assert_eq!(next.map.report().components.len(), 1);
    let full = built(&[apart, world.steps([6.2, 7.6], 260)].concat());
    assert!(
        world.rmse(&next.map) < 2.0 * world.rmse(&full.map),
        "{} {}",
        world.rmse(&next.map),
        world.rmse(&full.map)
    );
}

#[test]
fn a_part_that_nothing_ties_to_the_map_becomes_a_chart_of_its_own() {
    let world = World::new(9.0, 2.0);
    let state = built(&world.steps([0.0, 6.0], 3000));
    let (next, report) = updated(&state, &world.steps([7.8, 9.0], 200));
    assert_eq!(report.whole, None);
    assert_eq!(next.map.report().components.len(), 2);
    assert_eq!(unmoved(&state.map, &next.map), state.map.len());
    assert_eq!(report.solved, report.landmarks);
    // And grows in its turn.
    let (grown, report) = updated(&next, &world.steps([7.8, 9.0], 50));
    assert_eq!((report.whole, grown.map.report().components.len()), (None, 2));
    assert_eq!(unmoved(&state.map, &grown.map), state.map.len());
}

#[test]
fn nothing_new_changes_nothing() {
    let world = World::new(4.0, 2.0);
    let state = built(&world.steps([0.0, 4.0], 2000));
    let (next, report) = updated(&state, &[]);
    assert_eq!(report, UpdateReport::default());
    assert_eq!(unmoved(&state.map, &next.map), state.map.len());
    assert_eq!((next.ground, next.log, next.counts), (state.ground, state.log, state.counts));
}

#[test]
fn lone_landmarks_and_steps_without_any_are_only_counted() {
    let world = World::new(4.0, 2.0);
    let state = built(&world.steps([0.0, 4.0], 2000));
    let lone = ["nobody", "nowhere"].map(|id| vec![id.to_owned()]);
    let (next, report) = updated(&state, &[lone.to_vec(), vec![vec![], vec!["L0".to_owned()]]].concat());
    assert_eq!((report.steps, report.landmarks, report.whole), (4, 2, None));
    assert_eq!(unmoved(&state.map, &next.map), state.map.len());
    assert_eq!(next.map.report().components.len(), 3);
    // One of them turns out to be near what is known.
    let beside =
        world.steps([1.0, 1.2], 12).into_iter().map(|step| [step, vec!["nobody".to_owned()]].concat());
    let (next, report) = updated(&next, &beside.collect::<Vec<_>>());
    assert_eq!((report.whole, next.map.report().components.len()), (None, 2));
    let nobody = next.map.landmarks()[state.map.len()];
    assert_eq!(nobody.component, 0);
}

#[test]
fn what_is_too_much_is_solved_as_a_whole_and_laid_onto_the_old_map() {
    let world = World::new(4.0, 2.0);
    let state = built(&world.steps([0.0, 4.0], 1000));
    let (next, report) = updated(&state, &world.steps([0.0, 4.0], 999));
    assert_eq!(
        report.whole.as_deref(),
        Some("a twelfth of the evidence is newer than the last whole solution")
    );
    assert_eq!(report.solved as usize, next.map.len());
    // The same map as that of a build, in the frame of the old one.
    let full = built(&[world.steps([0.0, 4.0], 1000), world.steps([0.0, 4.0], 999)].concat());
    assert_eq!(full.map.report().stress1, next.map.report().stress1);
    let miss = |after: &GlobalMap| {
        let pairs = state.map.landmarks().iter().zip(after.landmarks());
        pairs.map(|(a, b)| distance(a.position, b.position).powi(2)).sum::<f64>()
    };
    assert!(miss(&next.map) <= miss(&full.map) * (1.0 + 1e-9));
    assert!(miss(&next.map) < 0.05 * 0.05 * state.map.len() as f64, "{}", miss(&next.map));
}

#[test]
fn settings_that_solve_everything_at_once_do_so_in_every_update() {
    let world = World::new(2.0, 2.0);
    let params = MapperParams { method: Method::Classical, ..MapperParams::default() };
    let steps = world.steps([0.0, 2.0], 600);
    let mut state = Mapper::new(params).unwrap().build_with_state(log(&steps), &Silent).unwrap();
    let report = state.update(&log(&world.steps([0.0, 2.0], 6)), &Silent).unwrap();
    assert_eq!(report.whole.as_deref(), Some("the classical method is dense and solves everything at once"));
    assert_eq!(state.map.params().method, Method::Classical);
}

#[test]
fn an_update_is_the_same_for_any_number_of_threads() {
    let world = World::new(7.0, 2.0);
    let state = built(&world.steps([0.0, 6.0], 3000));
    let steps = world.steps([5.6, 7.0], 220);
    let of = |threads| on_threads(threads, || updated(&state, &steps));
    let one = of(1);
    assert_eq!(one.1.whole, None);
    assert!(one == of(2) && one == of(3));
}

#[test]
fn a_state_stays_as_it_was_when_an_update_is_stopped() {
    struct Stopped;
    impl Observer for Stopped {
        fn interrupted(&self) -> bool {
            true
        }
    }
    let world = World::new(2.0, 2.0);
    let mut state = built(&world.steps([0.0, 2.0], 500));
    let before = state.clone();
    let error = state.update(&log(&world.steps([0.0, 2.0], 20)), &Stopped).unwrap_err();
    assert!(matches!(error, MapError::Interrupted));
    assert_eq!(state, before);
}
