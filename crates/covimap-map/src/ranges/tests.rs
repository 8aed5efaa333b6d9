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
    let report = fit_component(&steps, &mut bent, |_, _| true, &Silent).unwrap().unwrap();
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
    assert_eq!(
        fit_component(&[(0..3).map(reading).collect()], &mut pile, |_, _| true, &Silent).unwrap(),
        None
    );
    assert_eq!(pile, [[1.0, 1.0]; 3]);
    assert_eq!(fit_component(&[], &mut Vec::new(), |_, _| true, &Silent).unwrap(), None);
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

/// Landmarks of a map that is off by some centimetres, what a robot on a winding way ranges, and who are neighbours.
fn off_by(deviation: f64) -> (Vec<Vec<(u32, f64)>>, Vec<Point>) {
    let truth = scattered(80, [2.0, 2.0], 11);
    let mut random = ChaCha8Rng::seed_from_u64(5);
    let mut step = |k: u32| {
        let turn = f64::from(k) * 0.1;
        let from = [1.0 + 0.9 * (1.7 * turn).cos(), 1.0 + 0.9 * turn.sin()];
        let away = truth.iter().map(|[x, y]| (x - from[0]).hypot(y - from[1]));
        let seen = (0..).zip(away).filter(|range| range.1 < 0.6);
        seen.map(|(i, away)| (i, away * random.random_range(0.95..1.05))).collect::<Vec<(u32, f64)>>()
    };
    let steps = (0..200).map(&mut step).filter(|step| step.len() >= FEWEST).collect();
    let mut moved = |c: f64| c + random.random_range(-1.0..1.0) * 3_f64.sqrt() * deviation;
    (steps, truth.iter().map(|point| point.map(&mut moved)).collect())
}

#[test]
fn moves_leave_no_landmark_and_no_place_a_wish() {
    let (steps, points) = off_by(0.03);
    let readings = Readings::new(&steps, points.len());
    let edges = delaunay_edges(&points).unwrap();
    let mut sweep = Sweep::start(&readings, &points, &edges, |_, _| true).unwrap();
    sweep.place_steps();
    sweep.weigh_edges();
    let moves = Equations::new(&readings, &sweep.edges, points.len()).solve(&sweep).unwrap().moves;
    // Gradients by the linearised misses themselves, the places being moved for the best.
    let (mut wishes, mut largest) = (vec![[0.0_f64; 2]; points.len()], 0.0_f64);
    for step in 0..readings.steps() {
        let looks = || {
            readings.of_step(step).map(|k| {
                let ([u, v], miss) = sweep.look(k);
                let i = readings.all()[k].landmark as usize;
                (i, [u, v], sweep.weights[k], miss - u * moves[i][0] - v * moves[i][1])
            })
        };
        let (mut a, mut b) = ([0.0; 3], [0.0; 2]);
        for (_, [u, v], w, miss) in looks() {
            a = [a[0] + w * u * u, a[1] + w * u * v, a[2] + w * v * v];
            b = [b[0] - w * u * miss, b[1] - w * v * miss];
        }
        let ridge = 1e-6 * (a[0] + a[2]);
        a = [a[0] + ridge, a[1], a[2] + ridge];
        let by = a[0] * a[2] - a[1] * a[1];
        let place = [(a[2] * b[0] - a[1] * b[1]) / by, (a[0] * b[1] - a[1] * b[0]) / by];
        for (i, [u, v], w, miss) in looks() {
            let wish = w * (miss + u * place[0] + v * place[1]);
            wishes[i] = [wishes[i][0] + wish * u, wishes[i][1] + wish * v];
            largest = largest.max((w * miss).abs());
        }
    }
    for k in 0..sweep.edges.len() {
        let ([u, v], miss) = sweep.strain(k);
        let [a, b] = sweep.edges[k].ends.map(|end| end as usize);
        let stretch = u * (moves[b][0] - moves[a][0]) + v * (moves[b][1] - moves[a][1]);
        let wish = sweep.edges[k].weight * (miss - stretch);
        largest = largest.max((sweep.edges[k].weight * miss).abs());
        wishes[a] = [wishes[a][0] - wish * u, wishes[a][1] - wish * v];
        wishes[b] = [wishes[b][0] + wish * u, wishes[b][1] + wish * v];
    }
    // The nudge is left, a billionth of curvatures that are large where neighbours stand close together.
    let left = wishes.iter().flatten().fold(0.0_f64, |most, wish| most.max(wish.abs()));
    assert!(left < 1e-4 * largest, "{left} of {largest}");
}

#[test]
fn the_error_of_the_map_is_told_by_what_its_neighbours_miss() {
    // Both ends of an edge are off by a share of the length of most edges.
    for (deviation, wanted) in [(0.01, 0.03..0.09), (0.03, 0.1..0.27)] {
        let (steps, points) = off_by(deviation);
        let readings = Readings::new(&steps, points.len());
        let edges = delaunay_edges(&points).unwrap();
        let mut sweep = Sweep::start(&readings, &points, &edges, |_, _| true).unwrap();
        for _ in 0..FIRST_ROUNDS {
            sweep.place_steps();
            sweep.fit_scale();
            fit_noise(&mut sweep);
        }
        for _ in 0..ROUNDS {
            sweep.place_steps();
            sweep.weigh_edges();
            let solved = Equations::new(&readings, &sweep.edges, points.len()).solve(&sweep).unwrap();
            sweep.move_landmarks(&solved.moves);
            sweep.place_steps();
            fit_noise(&mut sweep);
            let free = solved.freedom.iter().sum::<f64>() / solved.freedom.len() as f64;
            assert!((0.0..1.2).contains(&free), "{free}");
            fit_held(&mut sweep, &solved.freedom);
        }
        assert!(wanted.contains(&sweep.held), "{deviation}: {}", sweep.held);
    }
}

#[test]
fn neighbours_never_seen_together_do_not_hold() {
    // Two corridors side by side with a wall between them; on the map the second has come 15 cm too near.
    let truth = scattered(80, [6.0, 1.2], 3);
    let upper = |point: &Point| point[1] > 0.6;
    let mut near: Vec<Point> =
        truth.iter().map(|point| if upper(point) { [point[0], point[1] - 0.15] } else { *point }).collect();
    let mut random = ChaCha8Rng::seed_from_u64(9);
    let step = |k: u32| {
        let above = k % 2 == 1;
        let from =
            [random.random_range(0.0..6.0), random.random_range(0.1..0.5) + if above { 0.6 } else { 0.0 }];
        // There is a door at the end.
        let by_the_door = from[0] > 5.5;
        let away = truth.iter().map(|point| (point[0] - from[0]).hypot(point[1] - from[1]));
        let seen = (0..).zip(away).zip(&truth);
        seen.filter(|((_, away), point)| *away < 0.8 && (by_the_door || upper(point) == above))
            .map(|(range, _)| range)
            .collect::<Vec<(u32, f64)>>()
    };
    let steps: Vec<_> = (0..300).map(step).filter(|step| step.len() >= FEWEST).collect();
    let mut together = std::collections::BTreeSet::new();
    for step in &steps {
        step.iter().for_each(|a| together.extend(step.iter().map(|b| (a.0, b.0))));
    }
    assert!(errors(&near, &truth).0 > 0.05);
    let seen = |a, b| together.contains(&(a, b));
    let report = fit_component(&steps, &mut near, seen, &Silent).unwrap().unwrap();
    let metres: Vec<Point> = near.iter().map(|point| point.map(|c| c * report.scale)).collect();
    let (off, ratio) = errors(&metres, &truth);
    assert!(off < 0.01 && (ratio - 1.0).abs() < 2e-3, "{off} {ratio}");
}
