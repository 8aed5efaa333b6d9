use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::*;
use crate::places::grid::{Cells, Cutting};
use crate::places::sensor::Sensor;

const SENSOR: Sensor = Sensor { range: 0.6, edge: 0.05, detectability: 0.9, false_sighting: 1e-3 };
/// A fifth of the range.
const SPACING: f64 = 0.12;

/// Logarithm of the summed likelihood over the places, eq. (2), with the exact curve.
fn log_likelihood(landmarks: &[Landmark]) -> f64 {
    likelihoods(landmarks).iter().sum::<f64>().ln()
}

/// A landmark at its offset from the first place, in spacings.
#[derive(Clone, Copy)]
struct Landmark {
    offset: Point,
    detectability: f64,
    seen: bool,
}

/// At every place, by rows.
fn likelihoods(landmarks: &[Landmark]) -> Vec<f64> {
    let factor = |landmark: &Landmark, place: Point| {
        let away = (landmark.offset[0] - place[0]).hypot(landmark.offset[1] - place[1]) * SPACING;
        let v = 1.0 / (1.0 + ((away - SENSOR.range) / SENSOR.edge).exp());
        let p = 1e-3 + (landmark.detectability - 1e-3) * v;
        if landmark.seen { p } else { 1.0 - p }
    };
    let place = |k: usize| [(k % CELLS) as f64, (k / CELLS) as f64];
    (0..CELLS * CELLS).map(|k| landmarks.iter().map(|l| factor(l, place(k))).product()).collect()
}

/// Random landmarks, some of them seen, and the posterior over the grid of places.
fn random_step(seed: u64) -> (Vec<Witness>, Cells) {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut coordinate = |size: f64| rng.random_range(-size..size);
    let witnesses: Vec<Witness> = (0..9)
        .map(|landmark| {
            let at = [coordinate(0.9), coordinate(0.9)];
            let detectability = 0.75 + coordinate(0.2) as f32;
            let seen = at[0].hypot(at[1]) + coordinate(0.2) < 0.6;
            Witness { landmark, cutting: Cutting::of(at, SPACING), detectability, seen }
        })
        .collect();
    let likelihoods = likelihoods(&witnesses.iter().map(landmark).collect::<Vec<_>>());
    let total: f64 = likelihoods.iter().sum();
    let share = |row: usize, column: usize| (likelihoods[row * CELLS + column] / total) as f32;
    let places = std::array::from_fn(|row| std::array::from_fn(|column| share(row, column)));
    (witnesses, places)
}

fn landmark(witness: &Witness) -> Landmark {
    let offset = witness.cutting.offset.map(f64::from);
    Landmark { offset, detectability: f64::from(witness.detectability), seen: witness.seen }
}

/// Fisher's identity: the posterior mean of the score is the derivative of the log-likelihood in which
/// the place is summed out.
#[test]
fn scores_are_derivatives_of_the_marginal_likelihood() {
    let sight = Sight::new(SENSOR);
    for seed in 0..20 {
        let (witnesses, places) = random_step(seed);
        let landmarks: Vec<Landmark> = witnesses.iter().map(landmark).collect();
        let mut board = ScoreBoard::new(9);
        board.gather(&Step { witnesses: &witnesses, places: &places, rows: 0..CELLS }, 3.0, &sight);
        for (landmark, scores) in board.take() {
            let at = |change: &dyn Fn(&mut Landmark, f64)| {
                let by = 1e-5;
                let value = |by: f64| {
                    let mut moved = landmarks.clone();
                    change(&mut moved[landmark as usize], by);
                    log_likelihood(&moved)
                };
                3.0 * (value(by) - value(-by)) / (2.0 * by)
            };
            let by_offset = |axis: usize| at(&move |l, by| l.offset[axis] += by / SPACING);
            let wanted = [by_offset(0), by_offset(1), at(&|l, by| l.detectability += by)];
            let [x, y] = scores.position;
            for (got, wanted) in [x, y, scores.detectability].into_iter().zip(wanted) {
                assert!(
                    (got - wanted).abs() < 2e-4 * (5.0 + wanted.abs()),
                    "{seed}, {landmark}: {got}, {wanted}"
                );
            }
        }
    }
}

#[test]
fn information_computed_by_hand() {
    // All weight on place (3, 2) of the grid and a landmark five spacings to its right, at (0.6, 0)
    // from it, on the edge, seen: v = 1/2, P = 0.001 + 0.899 / 2 = 0.4505, P (1 - P) = 0.24754975,
    // dP/dx = -0.899 / 4 / 0.05 = -4.495.
    let from_middle = |cell: f64| (cell - 3.5) * SPACING;
    let cutting = Cutting::of([from_middle(8.0), from_middle(2.0)], SPACING);
    assert_eq!(cutting.offset, [8.0, 2.0]);
    let witness = Witness { landmark: 2, cutting, detectability: 0.9, seen: true };
    let mut places = [[0.0; CELLS]; CELLS];
    places[2][3] = 1.0;
    let step = Step { witnesses: &[witness], places: &places, rows: 2..3 };
    let mut board = ScoreBoard::new(3);
    board.gather(&step, 2.0, &Sight::new(SENSOR));
    let scores = board.take();
    assert_eq!(scores.len(), 1);
    let (landmark, scores) = scores[0];
    assert_eq!(landmark, 2);
    let close = |got: f64, wanted: f64| (got - wanted).abs() < 1e-4 * wanted.abs();
    // Twice (1 - P) / (P (1 - P)) * -4.5 = -4.495 / 0.4505 = -9.97780.
    assert!(close(scores.position[0], -19.9556), "{}", scores.position[0]);
    assert_eq!(scores.position[1].abs(), 0.0);
    // Twice 4.495^2 / 0.24754975 = 81.6201 along x, none across.
    assert!(close(scores.information[0], 163.240), "{:?}", scores.information);
    assert_eq!(scores.information[1..].iter().map(|i| i.abs()).sum::<f64>(), 0.0);
    // Twice 0.5 / 0.4505 = 1.10988, and twice 0.25 / 0.24754975.
    assert!(close(scores.detectability, 2.21976), "{}", scores.detectability);
    assert!(close(scores.detectability_information, 2.01979), "{}", scores.detectability_information);
    assert!(board.take().is_empty());
}

#[test]
fn steps_computed_by_hand() {
    let scores = Scores { position: [3.0, 0.0], information: [8.0, 0.0, 2.0], ..Scores::default() };
    // The ridge adds 0.05 * 10 to both axes: 3 / 8.5 along x.
    let step = scores.step(1.0);
    assert!((step[0] - 3.0 / 8.5).abs() < 1e-15 && step[1] == 0.0, "{step:?}");
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
fn variances_computed_by_hand() {
    // [[2, 0], [0, 8]] and a ridge of 0.5: 1 / 2.5 + 1 / 8.5.
    let scores = Scores { information: [2.0, 0.0, 8.0], ..Scores::default() };
    assert!((scores.variance() - (1.0 / 2.5 + 1.0 / 8.5)).abs() < 1e-15);
    assert_eq!(Scores::default().variance(), 0.0);
}
