use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::*;
use crate::fixtures::scattered;
use crate::{MapError, Mapper, MapperParams, Silent};

/// Looks from random places of a hall of 2 by 2 metres, with ranges of five per cent noise; of so many in a thousand the
/// range is any number.
fn hall(steps: usize, noise: f64, wild: u32, seed: u64) -> (SightingLog, Vec<Point>) {
    let truth = scattered(60, [2.0, 2.0], 7);
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let (mut looks, mut ranges) = (Vec::new(), Vec::new());
    for _ in 0..steps {
        let place = [random.random_range(0.0..2.0), random.random_range(0.0..2.0)];
        let mut look = Vec::new();
        for (i, [x, y]) in truth.iter().enumerate() {
            let away = (x - place[0]).hypot(y - place[1]);
            // The sum of twelve uniform numbers is nearly normal.
            let normal = (0..12).map(|_| random.random_range(-0.5..0.5)).sum::<f64>();
            if away < 0.6 {
                let wildly = random.random_range(0..1000) < wild;
                let metres =
                    if wildly { random.random_range(0.1..3.0) } else { away * (1.0 + noise * normal) };
                look.push((i, metres));
            }
        }
        looks.push(look);
    }
    let log = SightingLog::from_steps(looks.iter().map(|look| look.iter().map(|(i, _)| i.to_string())));
    let number = |i: usize| log.names().iter().position(|name| name == i.to_string()).unwrap() as u32;
    let numbers: Vec<u32> =
        (0..60).map(|i| if log.names().iter().any(|n| n == i.to_string()) { number(i) } else { 0 }).collect();
    for (step, look) in looks.iter().enumerate() {
        ranges.extend(look.iter().map(|&(i, metres)| Range { step, landmark: numbers[i], metres }));
    }
    let places = log.names().iter().map(|name| truth[name.parse::<usize>().unwrap()]).collect();
    (log.with_ranges(ranges).unwrap(), places)
}

/// Root mean square of the lengths of near pairs against the truth, metres, and the ratio of all lengths.
fn errors(points: &[Point], truth: &[Point]) -> (f64, f64) {
    let away = |p: &[Point], i: usize, j: usize| (p[i][0] - p[j][0]).hypot(p[i][1] - p[j][1]);
    let (mut squares, mut near, mut found, mut wanted) = (0.0, 0.0, 0.0, 0.0);
    for i in 0..points.len() {
        for j in 0..i {
            let (a, b) = (away(points, i, j), away(truth, i, j));
            (found, wanted) = (found + a, wanted + b);
            if b < 0.5 {
                (squares, near) = (squares + (a - b).powi(2), near + 1.0);
            }
        }
    }
    ((squares / near).sqrt(), found / wanted)
}

fn mapped(log: &SightingLog) -> crate::GlobalMap {
    Mapper::new(MapperParams::default()).unwrap().build(log, &Silent).unwrap()
}

#[test]
fn ranges_make_the_map_metric_and_more_exact() {
    for seed in 1..4 {
        let (log, truth) = hall(600, 0.05, 0, seed);
        let map = mapped(&log);
        let points: Vec<Point> = map.landmarks().iter().map(|landmark| landmark.position).collect();
        let (off, ratio) = errors(&points, &truth);
        assert!((ratio - 1.0).abs() < 0.01, "seed {seed}: {ratio}");
        let report = map.report().components[0].ranges.as_ref().unwrap();
        // Five per cent of .4 m, the root mean square of ranges up to .6 m.
        assert!((0.012..0.024).contains(&report.deviation), "{report:?}");
        assert!(
            // Beyond four deviations is one in 16 000 of normal noise; a few places are on the wrong side of
            // landmarks in line.
            report.outliers < report.ranges / 200 && report.scale_error < 0.003 * report.scale,
            "{report:?}"
        );
        let fit = &map.alignment()[0];
        assert_eq!((fit.scale, fit.distances, fit.handed), (report.scale, report.ranges, false));
        // The sensor is told in metres too.
        assert!((map.sensing().unwrap().sensor(0).range - 0.6).abs() < 0.04);

        let without = mapped(&log.clone().with_ranges(Vec::new()).unwrap());
        let scale = |point: Point| point.map(|c| c * report.scale);
        let plain: Vec<Point> = without.landmarks().iter().map(|landmark| scale(landmark.position)).collect();
        assert!(without.alignment().is_empty());
        assert!(off < 0.25 * errors(&plain, &truth).0, "seed {seed}: {off} {:?}", errors(&plain, &truth));
    }
}

#[test]
fn exact_ranges_take_out_what_bends_a_map_as_a_whole() {
    // A corridor of 6 by .6 metres, bent into an arc of 60 degrees with a radius of 6 m.
    let truth = scattered(60, [6.0, 0.6], 3);
    let mut bent: Vec<Point> = truth
        .iter()
        .map(|[x, y]| {
            let (sin, cos) = (x / 6.0).sin_cos();
            [(6.0 - y) * sin, 6.0 - (6.0 - y) * cos]
        })
        .collect();
    let step = |k: u32| {
        let from = [f64::from(k) * 0.05, 0.3 + 0.2 * f64::from(k).sin()];
        let away = truth.iter().map(|[x, y]| (x - from[0]).hypot(y - from[1]));
        (0..).zip(away).filter(|range| range.1 < 0.8).collect::<Vec<(u32, f64)>>()
    };
    let steps: Vec<_> = (0..120).map(step).filter(|step| step.len() >= FEWEST).collect();
    let ends = |points: &[Point]| {
        let end = |sign: f64| {
            (0..60).max_by(|&i, &j| (sign * truth[i][0]).total_cmp(&(sign * truth[j][0]))).unwrap()
        };
        let [a, b] = [points[end(1.0)], points[end(-1.0)]];
        (a[0] - b[0]).hypot(a[1] - b[1])
    };
    // The chord of the arc is 2 sin(30 degrees) of the radius: 6 % shorter than the corridor.
    assert!(ends(&bent) < 0.97 * ends(&truth));
    let report = fit_component(&steps, &mut bent).unwrap();
    assert!((report.scale * ends(&bent) / ends(&truth) - 1.0).abs() < 1e-3, "{report:?}");
}

#[test]
fn wild_ranges_are_told_and_have_no_say() {
    let (log, truth) = hall(600, 0.05, 50, 1);
    let map = mapped(&log);
    let points: Vec<Point> = map.landmarks().iter().map(|landmark| landmark.position).collect();
    let (off, ratio) = errors(&points, &truth);
    assert!((ratio - 1.0).abs() < 0.01 && off < 0.02, "{ratio} {off}");
    let report = map.report().components[0].ranges.as_ref().unwrap();
    let share = report.outliers as f64 / report.ranges as f64;
    assert!((0.03..0.06).contains(&share), "{share}");
}

#[test]
fn exact_ranges_give_the_truth() {
    let (log, truth) = hall(400, 0.0, 0, 2);
    let map = mapped(&log);
    let points: Vec<Point> = map.landmarks().iter().map(|landmark| landmark.position).collect();
    let (off, ratio) = errors(&points, &truth);
    assert!((ratio - 1.0).abs() < 1e-3 && off < 1e-3, "{ratio} {off}");
}

#[test]
fn too_few_ranges_leave_the_map_as_it_is() {
    let (log, _) = hall(200, 0.05, 0, 3);
    let bare = mapped(&log.clone().with_ranges(Vec::new()).unwrap());
    // Two a step fix its place and tell nothing.
    let mut kept = Vec::new();
    for ranges in log.ranges().chunk_by(|a, b| a.step == b.step) {
        kept.extend(ranges.iter().take(2).copied());
    }
    let few = mapped(&log.with_ranges(kept).unwrap());
    assert_eq!(few.landmarks(), bare.landmarks());
    assert!(few.alignment().is_empty() && few.report().components[0].ranges.is_none());
    // Landmarks at one place have no length to compare with.
    let reading = |landmark| (landmark, 1.0);
    let mut pile = vec![[1.0, 1.0]; 3];
    assert_eq!(fit_component(&[(0..3).map(reading).collect()], &mut pile), None);
    assert_eq!(pile, [[1.0, 1.0]; 3]);
    assert_eq!(fit_component(&[], &mut Vec::new()), None);
}

#[test]
fn ranges_that_no_step_can_have_are_refused() {
    let log = SightingLog::from_steps([["A", "B"], ["B", "C"]]);
    let refused = |step, landmark, metres| {
        let error = log.clone().with_ranges(vec![Range { step, landmark, metres }]).unwrap_err();
        matches!(error, MapError::BadRange { .. })
    };
    assert!(refused(0, 2, 1.0) && refused(2, 0, 1.0) && refused(0, 0, 0.0) && refused(0, 0, f64::NAN));
    assert!(refused(0, 0, -1.0) && refused(0, 0, f64::INFINITY));
}
