use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::*;
use crate::places::posterior::Witness;
use crate::places::sensor::Sensor;

const SENSOR: Sensor = Sensor { range: 0.6, edge: 0.05, detectability: 0.9, false_sighting: 1e-3 };

/// Logarithm of the summed likelihood over the places, eq. (2), with the exact curve.
fn log_likelihood(witnesses: &[Witness], places: &[(Point, f64)]) -> f64 {
    likelihoods(witnesses, places).iter().sum::<f64>().ln()
}

fn likelihoods(witnesses: &[Witness], places: &[(Point, f64)]) -> Vec<f64> {
    let factor = |witness: &Witness, place: Point| {
        let away = (witness.at[0] - place[0]).hypot(witness.at[1] - place[1]);
        let v = 1.0 / (1.0 + ((away - SENSOR.range) / SENSOR.edge).exp());
        let p = SENSOR.probability(witness.detectability, v);
        if witness.seen { p } else { 1.0 - p }
    };
    places.iter().map(|&(place, _)| witnesses.iter().map(|w| factor(w, place)).product()).collect()
}

/// Random landmarks, some of them seen, and the posterior over a grid of places.
fn random_step(seed: u64) -> (Vec<Witness>, Vec<(Point, f64)>) {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut coordinate = |size: f64| rng.random_range(-size..size);
    let witnesses: Vec<Witness> = (0..9)
        .map(|landmark| {
            let at = [coordinate(0.9), coordinate(0.9)];
            let detectability = 0.75 + coordinate(0.2);
            Witness { landmark, at, detectability, seen: at[0].hypot(at[1]) + coordinate(0.2) < 0.6 }
        })
        .collect();
    let mut places: Vec<(Point, f64)> = (-5..=5)
        .flat_map(|x| (-5..=5).map(move |y| ([0.12 * f64::from(x), 0.12 * f64::from(y)], 0.0)))
        .collect();
    let likelihoods = likelihoods(&witnesses, &places);
    let total: f64 = likelihoods.iter().sum();
    places.iter_mut().zip(likelihoods).for_each(|(place, likelihood)| place.1 = likelihood / total);
    (witnesses, places)
}

/// Fisher's identity: the posterior mean of the score is the derivative of the log-likelihood in which
/// the place is summed out.
#[test]
fn scores_are_derivatives_of_the_marginal_likelihood() {
    let curve = Curve::new(SENSOR, 3.2 * SENSOR.range);
    for seed in 0..20 {
        let (witnesses, places) = random_step(seed);
        let mut board = ScoreBoard::new(9);
        board.gather(&Step { witnesses: &witnesses, places: &places }, 3.0, &curve, SENSOR);
        for (landmark, scores) in board.take() {
            let at = |change: &dyn Fn(&mut Witness, f64)| {
                let by = 1e-5;
                let value = |by: f64| {
                    let mut moved = witnesses.clone();
                    change(&mut moved[landmark as usize], by);
                    log_likelihood(&moved, &places)
                };
                3.0 * (value(by) - value(-by)) / (2.0 * by)
            };
            let wanted = [at(&|w, by| w.at[0] += by), at(&|w, by| w.at[1] += by)];
            // The table is exact to half a step of it: a few thousandths of the slope, 1 / (4 s) = 5 a
            // place.
            for (got, wanted) in scores.position.iter().zip(wanted) {
                assert!(
                    (got - wanted).abs() < 0.03 * (5.0 + wanted.abs()),
                    "{seed}, {landmark}: {got}, {wanted}"
                );
            }
            let wanted = at(&|w, by| w.detectability += by);
            let miss = (scores.detectability - wanted).abs();
            assert!(
                miss < 0.01 * (5.0 + wanted.abs()),
                "{seed}, {landmark}: {} {wanted}",
                scores.detectability
            );
        }
    }
}

#[test]
fn information_computed_by_hand() {
    // One place at the origin and a landmark at (0.6, 0), on the edge, seen: v = 1/2,
    // P = 0.001 + 0.899 / 2 = 0.4505, P (1 - P) = 0.24754975, dP/dx = -0.9 / 4 / 0.05 = -4.5.
    let witness = Witness { landmark: 2, at: [0.6, 0.0], detectability: 0.9, seen: true };
    let step = Step { witnesses: &[witness], places: &[([0.0, 0.0], 1.0)] };
    let mut board = ScoreBoard::new(3);
    board.gather(&step, 2.0, &Curve::new(SENSOR, 3.2 * SENSOR.range), SENSOR);
    let scores = board.take();
    assert_eq!(scores.len(), 1);
    let (landmark, scores) = scores[0];
    assert_eq!(landmark, 2);
    let close = |got: f64, wanted: f64| (got - wanted).abs() < 0.01 * wanted.abs();
    // Twice (1 - P) / (P (1 - P)) * -4.5 = -4.5 / 0.4505 = -9.98890.
    assert!(close(scores.position[0], -19.978), "{}", scores.position[0]);
    assert_eq!(scores.position[1].abs(), 0.0);
    // Twice 4.5^2 / 0.24754975 = 81.8018 along x, none across.
    assert!(close(scores.information[0], 163.60), "{:?}", scores.information);
    assert_eq!(scores.information[1..].iter().map(|i| i.abs()).sum::<f64>(), 0.0);
    // Twice 0.5 / 0.4505 = 1.10988, and twice 0.25 / 0.24754975.
    assert!(close(scores.detectability, 2.2198), "{}", scores.detectability);
    assert!(close(scores.detectability_information, 2.0198), "{}", scores.detectability_information);
    assert!(board.take().is_empty());
}

#[test]
fn steps_computed_by_hand() {
    let scores = Scores { position: [3.0, 0.0], information: [8.0, 0.0, 2.0], ..Scores::default() };
    // The ridge adds 0.05 * 10 to both axes: 3 / 8.5 along x.
    assert_eq!(scores.step(1.0), [3.0 / 8.5, 0.0]);
    let cut = scores.step(0.1);
    assert!((cut[0] - 0.1).abs() < 1e-15 && cut[1] == 0.0);
    assert_eq!(Scores::default().step(1.0), [0.0; 2]);
    // A landmark seen from one side alone, along the diagonal: [[2, 2], [2, 2]] + 0.2 I.
    let scores = Scores { position: [1.0, 1.0], information: [2.0, 2.0, 2.0], ..Scores::default() };
    let step = scores.step(1.0);
    assert!((step[0] - 1.0 / 4.2).abs() < 1e-12 && (step[1] - 1.0 / 4.2).abs() < 1e-12, "{step:?}");
}

#[test]
fn a_detectability_is_drawn_towards_the_common_one() {
    // (20 + 100 (0.9 - 0.5)) / (300 + 100) = 0.15.
    let scores = Scores { detectability: 20.0, detectability_information: 300.0, ..Scores::default() };
    assert!((scores.improved_detectability(0.5, 0.9) - 0.65).abs() < 1e-15);
    // Without sightings of its own, to the common one at once.
    assert_eq!(Scores::default().improved_detectability(0.5, 0.9), 0.9);
    let certain = Scores { detectability: 1e9, detectability_information: 1.0, ..Scores::default() };
    assert_eq!(certain.improved_detectability(0.5, 0.9), DETECTABILITY.1);
}

#[test]
fn the_table_follows_the_curve() {
    let curve = Curve::new(SENSOR, 3.2 * SENSOR.range);
    for k in 1..1900 {
        let distance = f64::from(k) * 1e-3;
        let v = 1.0 / (1.0 + ((distance - 0.6) / 0.05).exp());
        let [got, slope] = curve.at(distance * distance);
        // Half a step of the table is 0.00045 in d^2, 0.0004 in d at the edge: 0.002 of v there, and
        // more near zero, where the curve is flat.
        assert!((got - v).abs() < 3e-3, "{distance}: {got}, {v}");
        assert!((slope * distance - v * (1.0 - v) / 0.05).abs() < 0.05, "{distance}: {slope}");
    }
    // Beyond its end the table goes on with its last entry.
    assert!(curve.at(100.0)[0] < 1e-9);
}
