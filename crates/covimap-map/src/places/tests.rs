use covimap_embed::{Correspondence, ProcrustesOptions, procrustes};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::posterior::Witness;
use super::*;
use crate::fixtures::{counts_of, distance, links_where, log_of, looks, on_threads, scattered};
use crate::{SightingLog, Silent};

/// The sets of the one component there is.
fn only(mut sets: Vec<SeenSets>) -> SeenSets {
    assert_eq!(sets.len(), 1);
    sets.remove(0)
}

/// A hall, what is seen in it from a range of 0.6, and the model that is true of it.
struct Hall {
    truth: Vec<Point>,
    graph: LinkGraph,
    sets: SeenSets,
}

/// The truth of [`looks`].
const SENSOR: Sensor = Sensor { range: 0.6, edge: 0.08 * 0.6, detectability: 0.9, false_sighting: 1e-3 };

fn hall(n: usize, steps: usize) -> Hall {
    let extent = [2.0, n as f64 / 20.0];
    let truth = scattered(n, extent, 4);
    let log = log_of(&looks(&truth, extent, SENSOR.range, steps));
    let graph = LinkGraph::from_counts(&counts_of(&log));
    Hall { sets: only(SeenSets::by_component(&log, &[(0..n as u32).collect()])), truth, graph }
}

impl Hall {
    fn true_model(&self) -> Model {
        let detectability = vec![SENSOR.detectability; self.truth.len()];
        Model { points: self.truth.clone(), detectability, sensor: SENSOR }
    }

    /// The truth with every coordinate off by up to `size`.
    fn jittered(&self, size: f64) -> Vec<Point> {
        let mut rng = ChaCha8Rng::seed_from_u64(6);
        self.truth.iter().map(|point| point.map(|x| x + rng.random_range(-size..size))).collect()
    }

    /// Root mean square distance of points from the truth after the best similarity.
    fn error(&self, points: &[Point]) -> f64 {
        let pair = |(&source, &target)| Correspondence { source, target, weight: 1.0 };
        let pairs: Vec<_> = points.iter().zip(&self.truth).map(pair).collect();
        procrustes(&pairs, ProcrustesOptions::default()).unwrap().rmse
    }
}

/// The middle of what is seen, coordinate by coordinate.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let half = values.len() / 2;
    if values.len() % 2 == 1 { values[half] } else { (values[half - 1] + values[half]) / 2.0 }
}

fn middle(model: &Model, seen: &[u32]) -> Point {
    [0, 1].map(|axis| median(seen.iter().map(|&i| model.points[i as usize][axis]).collect()))
}

/// The landmarks that a step says something about: those seen, and those linked to at least half of
/// them, as far as they are near the middle.
fn witnesses(graph: &LinkGraph, model: &Model, seen: &[u32]) -> Vec<(u32, bool)> {
    let middle = middle(model, seen);
    let links = |i: u32| graph.of(i).iter().filter(|link| seen.contains(&link.to)).count();
    (0..graph.landmarks() as u32)
        .filter(|&i| distance(model.points[i as usize], middle) < 2.2 * model.sensor.range)
        .filter(|i| seen.contains(i) || 2 * links(*i) >= seen.len())
        .map(|i| (i, seen.contains(&i)))
        .collect()
}

#[test]
fn the_posterior_is_that_of_the_obvious_computation() {
    let hall = hall(80, 400);
    let model = hall.true_model();
    let neighbours = Neighbours::new(&hall.graph);
    let posterior = Posterior::new(&neighbours, &model);
    let mut workspace = Workspace::new(80);
    let mut unseen = 0;
    for set in (0..hall.sets.len()).step_by(7) {
        let seen = hall.sets.seen(set);
        let step = posterior.of(seen, &mut workspace);
        let witnesses = witnesses(&hall.graph, &model, seen);
        let mut found: Vec<(u32, bool)> = step.witnesses.iter().map(|w| (w.landmark, w.seen)).collect();
        found.sort_unstable();
        assert_eq!(found, witnesses);
        unseen += witnesses.iter().filter(|witness| !witness.1).count();

        let middle = middle(&model, seen);
        // Eight by eight places, 0.12 apart.
        let first = middle.map(|along| along - 3.5 * 0.12);
        let likelihood = |row: usize, column: usize| {
            let factor = |witness: &Witness| {
                // Rounded to a quarter of the spacing.
                let landmark = witness.cutting.offset.map(f64::from);
                let point = model.points[witness.landmark as usize];
                for axis in 0..2 {
                    let exact = (point[axis] - first[axis]) / 0.12;
                    assert!((landmark[axis] - exact).abs() < 0.1251);
                }
                let away = distance(landmark, [column as f64, row as f64]) * 0.12;
                let p = 1e-3 + (0.9 - 1e-3) / (1.0 + ((away - 0.6) / 0.048).exp());
                if witness.seen { p } else { 1.0 - p }
            };
            step.witnesses.iter().map(factor).product::<f64>()
        };
        let all: Vec<f64> = (0..64).map(|k| likelihood(k / 8, k % 8)).collect();
        let most = all.iter().copied().fold(0.0, f64::max);
        let total: f64 = all.iter().filter(|&&value| value > 0.01 * most).sum();
        for (k, value) in all.iter().enumerate() {
            let got = f64::from(step.places[k / 8][k % 8]);
            // On the verge of being dropped rounding decides.
            let share = value / total;
            assert!(
                (got - share).abs() < 1e-4 || (got == 0.0 && *value < 0.0101 * most),
                "{set}: {got}, {share}"
            );
            assert!(got == 0.0 || step.rows.contains(&(k / 8)));
        }
        assert!((step.places.as_flattened().iter().sum::<f32>() - 1.0).abs() < 1e-5);
    }
    assert!(unseen > 100, "hardly any landmark was near and not seen");
}

#[test]
fn what_a_wall_hides_is_no_witness() {
    // 0 to 3 on one side see each other; 4 is next to them, but was only ever seen with 3.
    let graph = links_where(5, |i, j| (j < 4 || i == 3).then_some(0.3));
    let points = vec![[0.0, 0.0], [0.2, 0.0], [0.0, 0.2], [0.2, 0.2], [0.1, 0.3]];
    let model = Model { points, detectability: vec![0.9; 5], sensor: SENSOR };
    let neighbours = Neighbours::new(&graph);
    let posterior = Posterior::new(&neighbours, &model);
    let mut workspace = Workspace::new(5);
    let mut unseen = |seen: &[u32]| {
        let step = posterior.of(seen, &mut workspace);
        step.witnesses.iter().filter(|witness| !witness.seen).map(|w| w.landmark).collect::<Vec<_>>()
    };
    // 4 is linked to one of three seen, then to one of two.
    assert_eq!(unseen(&[0, 1, 3]), [2]);
    assert_eq!(unseen(&[0, 3]), [1, 2, 4]);
}

#[test]
fn sightings_that_contradict_each_other_do_no_harm() {
    // Two crowds of 200, four ranges apart: from anywhere 200 of the sightings are false, 1e-3 each,
    // the product of which no number can hold.
    let points = (0..400).map(|i| [2.4 * f64::from(i % 2), 1e-4 * f64::from(i)]).collect();
    let model = Model { points, detectability: vec![0.9; 400], sensor: SENSOR };
    let neighbours = Neighbours::new(&links_where(400, |_, _| Some(1.0)));
    let posterior = Posterior::new(&neighbours, &model);
    let mut workspace = Workspace::new(400);
    let all: Vec<u32> = (0..400).collect();
    let step = posterior.of(&all, &mut workspace);
    assert_eq!(step.witnesses.len(), 400);
    assert!((step.places.as_flattened().iter().sum::<f32>() - 1.0).abs() < 1e-5, "{:?}", step.places);
    let mut board = ScoreBoard::new(400);
    board.gather(&step, 1.0, posterior.sight());
    assert!(board.take().iter().all(|(_, scores)| scores.step(0.1).iter().all(|c| c.abs() <= 0.1)));
    // Apart by more than is near, they are no witnesses at all, and no place is better than another.
    let points = (0..400).map(|i| [6.0 * f64::from(i % 2), 1e-4 * f64::from(i)]).collect();
    let model = Model { points, ..model };
    let posterior = Posterior::new(&neighbours, &model);
    let step = posterior.of(&all, &mut workspace);
    assert!(step.witnesses.is_empty());
    assert_eq!(*step.places, [[1.0 / 64.0; 8]; 8]);
}

#[test]
fn the_sensor_moves_to_the_truth() {
    let hall = hall(80, 6000);
    let mut model = hall.true_model();
    model.sensor = Sensor { range: 0.48, edge: 0.12, detectability: 0.6, false_sighting: 1e-3 };
    model.detectability = vec![0.6; 80];
    let mut misses = Vec::new();
    for _ in 0..12 {
        let Sensor { range, edge, detectability, .. } = model.sensor;
        misses.push([(range / 0.6).ln().abs(), (edge / 0.048).ln().abs(), (detectability - 0.9).abs()]);
        model.sensor =
            sensor_scores(&Neighbours::new(&hall.graph), &hall.sets, &model).improve(model.sensor, true);
        model.detectability = vec![model.sensor.detectability; 80];
    }
    // The first step already helps each of the three, and the last is near: the grid of places is
    // 0.12 wide, which blurs the edge.
    assert!((0..3).all(|k| misses[1][k] < misses[0][k]), "{misses:?}");
    let Sensor { range, edge, detectability, .. } = model.sensor;
    assert!((range / 0.6 - 1.0).abs() < 0.05, "{range}");
    assert!((0.7..1.7).contains(&(edge / 0.048)), "{edge}");
    assert!((detectability - 0.9).abs() < 0.05, "{detectability}");
}

#[test]
fn the_rate_of_false_sightings_is_learnt_from_a_small_room() {
    // In a room of 20 landmarks, all of them near; each is seen by mistake in 3 steps of a hundred.
    let points = scattered(20, [1.5, 1.5], 4);
    for (share, lowest, highest) in [(0.0, 0.001, 0.004), (0.03, 0.02, 0.04)] {
        let mut looks = looks(&points, [1.5, 1.5], 0.6, 3000);
        let mut rng = ChaCha8Rng::seed_from_u64(5);
        for look in &mut looks {
            let missing: Vec<usize> = (0..20).filter(|i| !look.contains(i)).collect();
            look.extend(missing.into_iter().filter(|_| rng.random_bool(share)));
            look.sort_unstable();
        }
        let log = log_of(&looks);
        let graph = LinkGraph::from_counts(&counts_of(&log));
        let sets = only(SeenSets::by_component(&log, &[(0..20).collect()]));
        let learnt = refine(&graph, &sets, points.clone(), 3, &Silent).unwrap().sensor.false_sighting;
        assert!((lowest..highest).contains(&learnt), "{learnt} for {share}");
    }
}

#[test]
fn a_sensor_whose_range_is_held_keeps_it() {
    let hall = hall(80, 1000);
    let mut model = hall.true_model();
    model.sensor.range = 0.5;
    let sensor =
        sensor_scores(&Neighbours::new(&hall.graph), &hall.sets, &model).improve(model.sensor, false);
    assert_eq!(sensor.range, 0.5);
    assert_ne!(sensor.edge, model.sensor.edge);
    // Nothing to learn from.
    assert_eq!(SensorScores::default().improve(SENSOR, true), SENSOR);
}

#[test]
fn refinement_takes_errors_away() {
    let hall = hall(80, 6000);
    let start = hall.jittered(0.08);
    let before = hall.error(&start);
    let refined = refine(&hall.graph, &hall.sets, start, 6, &Silent).unwrap();
    let after = hall.error(&refined.points);
    assert!(before > 0.05, "{before}");
    assert!(after < 0.4 * before, "{before} to {after}");
    // From the truth the same place is reached: what is left is the noise of the log, not the start.
    let from_truth = refine(&hall.graph, &hall.sets, hall.truth.clone(), 6, &Silent).unwrap();
    assert!(after < 1.3 * hall.error(&from_truth.points), "{after}");
    // Detectabilities follow.
    let mean = refined.detectability.iter().sum::<f64>() / 80.0;
    assert!((mean - 0.9).abs() < 0.05, "{mean}");
}

#[test]
fn a_landmark_that_is_often_missed_is_found_out() {
    let mut hall = hall(60, 4000);
    // Landmark 7 loses two of three sightings.
    let extent = [2.0, 3.0];
    let mut looks = looks(&hall.truth, extent, SENSOR.range, 4000);
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    looks.iter_mut().for_each(|look| look.retain(|&i| i != 7 || rng.random_bool(1.0 / 3.0)));
    let log = log_of(&looks);
    hall.sets = only(SeenSets::by_component(&log, &[(0..60).collect()]));
    let refined = refine(&hall.graph, &hall.sets, hall.truth.clone(), 6, &Silent).unwrap();
    let others = (0..60).filter(|&i| i != 7).map(|i| refined.detectability[i]).fold(1.0, f64::min);
    assert!((refined.detectability[7] - 0.3).abs() < 0.1, "{}", refined.detectability[7]);
    assert!(others > 0.7, "{others}");
    // And it stays where it is.
    assert!(distance(refined.points[7], hall.truth[7]) < 0.1);
}

#[test]
fn without_an_iteration_the_map_stays() {
    let hall = hall(40, 300);
    let start = hall.jittered(0.1);
    assert_eq!(refine(&hall.graph, &hall.sets, start.clone(), 0, &Silent).unwrap().points, start);
}

#[test]
fn the_range_starts_at_half_the_length_of_a_long_link() {
    // Lengths 1 to 20 from landmark 0: the 20th of 20 is passed over by 19/20, index 19 is 20.
    let points: Vec<Point> = (0..21).map(|k| [f64::from(k), 0.0]).collect();
    let star = links_where(21, |i, _| (i == 0).then_some(1.0));
    assert_eq!(half_far_link(&star, &points), 10.0);
    // Of 40 links twice as dense index 38 counts: 39 of 40 at half a unit apart.
    let points: Vec<Point> = (0..41).map(|k| [0.5 * f64::from(k), 0.0]).collect();
    let star = links_where(41, |i, _| (i == 0).then_some(1.0));
    assert_eq!(half_far_link(&star, &points), 0.5 * 39.0 / 2.0);
}

#[test]
fn three_landmarks_are_refined_without_a_fuss() {
    let log = SightingLog::from_steps([vec!["A", "B"], vec!["B", "C"], vec!["A", "B", "C"], vec!["C"]]);
    let graph = LinkGraph::from_counts(&counts_of(&log));
    let sets = only(SeenSets::by_component(&log, &[vec![0, 1, 2]]));
    let model = refine(&graph, &sets, vec![[0.0, 0.0], [0.4, 0.0], [0.8, 0.1]], 8, &Silent).unwrap();
    assert!(model.points.iter().flatten().all(|c| c.is_finite()));
    // Two landmarks in one place are no reason to divide by zero either.
    let model = refine(&graph, &sets, vec![[0.0, 0.0], [0.0, 0.0], [0.8, 0.1]], 8, &Silent).unwrap();
    assert!(model.points.iter().flatten().all(|c| c.is_finite()));
}

#[test]
fn the_same_bits_on_one_thread_and_on_three() {
    // Several chunks of sets.
    let hall = hall(120, 7000);
    assert!(hall.sets.len() > 2 * CHUNK);
    let run = |threads| {
        let refine = || refine(&hall.graph, &hall.sets, hall.jittered(0.05), 3, &Silent).unwrap();
        let model = on_threads(threads, refine);
        (model.points, model.detectability, model.sensor)
    };
    assert_eq!(run(1), run(3));
}

struct Stop;

impl Observer for Stop {
    fn interrupted(&self) -> bool {
        true
    }
}

#[test]
fn refinement_can_be_interrupted() {
    let hall = hall(40, 300);
    let ended = refine(&hall.graph, &hall.sets, hall.truth.clone(), 2, &Stop);
    assert!(matches!(ended, Err(MapError::Interrupted)));
}
