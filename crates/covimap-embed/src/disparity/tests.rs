use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use super::*;
use crate::Pair;

/// Objects on a line, so that each pair has a distance of its own.
const POINTS: [Point; 5] = [[0.0, 0.0], [1.0, 0.0], [3.0, 0.0], [7.0, 0.0], [7.5, 0.0]];

/// The complete list of five objects.
fn list(given: &[f64], weights: &[f64]) -> PairDistances {
    let ends = (0..5).flat_map(|i| (i + 1..5).map(move |j| (i, j)));
    let pair = |(((i, j), &distance), &weight)| Pair { i, j, distance, weight };
    PairDistances::new(5, ends.zip(given).zip(weights).map(pair).collect()).unwrap()
}

fn fitted(pairs: &PairDistances, transformation: &Transformation) -> Vec<f64> {
    let rule = Disparities::new(pairs, transformation).unwrap();
    rule.fit(&POINTS).unwrap_or_else(|| rule.first())
}

fn size(pairs: &PairDistances, values: &[f64]) -> f64 {
    pairs.pairs().iter().zip(values).map(|(pair, e)| pair.weight * e * e).sum()
}

fn cost(pairs: &PairDistances, values: &[f64]) -> f64 {
    let miss = |pair: &Pair, e: &f64| distance(POINTS[pair.i as usize], POINTS[pair.j as usize]) - e;
    pairs.pairs().iter().zip(values).map(|(pair, e)| pair.weight * miss(pair, e).powi(2)).sum()
}

/// Some member of what the transformation admits, steered by `knobs`.
fn admitted(pairs: &PairDistances, transformation: &Transformation, knobs: &[f64]) -> Vec<f64> {
    let given: Vec<f64> = pairs.pairs().iter().map(|pair| pair.distance).collect();
    match transformation {
        Transformation::Ratio => given,
        Transformation::Interval => {
            let least = given.iter().copied().fold(f64::INFINITY, f64::min);
            given.iter().map(|d| knobs[0] + knobs[1] * (d - least)).collect()
        }
        Transformation::MSpline { degree, interior_knots } => {
            let basis = MonotoneSplineBasis::at_quantiles(&given, *interior_knots, *degree).unwrap();
            let design = SplineDesign::new(&basis, &given, &vec![1.0; given.len()]);
            design.values(&knobs[..basis.coefficients()])
        }
        Transformation::Ordinal(ties) => {
            // Levels that rise from one value to the next, and what sets a pair off from its tie.
            let below = |d: f64| given.iter().filter(|&&other| other < d).count();
            let level = |d: f64| knobs[..=below(d)].iter().sum::<f64>();
            let values: Vec<f64> = given.iter().map(|&d| level(d)).collect();
            match ties {
                Ties::Secondary => values,
                // Up to the next level.
                Ties::Primary => (0..given.len())
                    .map(|k| {
                        let tied = given.iter().filter(|&&other| other == given[k]).count();
                        let next: f64 = knobs[below(given[k]) + 1..][..tied - 1].iter().sum();
                        values[k] + next * knobs[k] / 2.0
                    })
                    .collect(),
                // Two of a tie change places symmetrically, as far as neither falls below zero.
                Ties::Tertiary => {
                    let mut values = values;
                    for a in 0..given.len() {
                        let Some(b) = (a + 1..given.len()).find(|&b| given[b] == given[a]) else { continue };
                        let [w, v] = [a, b].map(|k| pairs.pairs()[k].weight);
                        let most = (values[b] * v / w).min(values[a]);
                        let shift = most * (knobs[a] - 1.0).clamp(-1.0, 1.0);
                        if values[a] + shift >= 0.0 && values[b] - shift * w / v >= 0.0 {
                            values[a] += shift;
                            values[b] -= shift * w / v;
                        }
                    }
                    values
                }
            }
        }
        Transformation::Bounds(bounds) => {
            let between = |((l, u), knob): ((&f64, &f64), &f64)| l + (u - l) * knob / 2.0;
            bounds.lower.iter().zip(&bounds.upper).zip(knobs).map(between).collect()
        }
    }
}

fn all_transformations() -> Vec<Transformation> {
    let lower: Vec<f64> = (0..10).map(|k| f64::from(k % 4)).collect();
    let upper = lower.iter().map(|l| 2.0 * l + 0.5).collect();
    vec![
        Transformation::Ratio,
        Transformation::Interval,
        Transformation::Ordinal(Ties::Primary),
        Transformation::Ordinal(Ties::Secondary),
        Transformation::Ordinal(Ties::Tertiary),
        Transformation::MSpline { degree: 2, interior_knots: 2 },
        Transformation::Bounds(PairBounds::new(lower, upper).unwrap()),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 256, rng_seed: RngSeed::Fixed(2), ..ProptestConfig::default() })]

    #[test]
    fn nothing_admitted_fits_better(
        given in prop::collection::vec(1_u8..6, 10),
        weights in prop::collection::vec(0.1..5.0_f64, 10),
        knobs in prop::collection::vec(0.0..2.0_f64, 30),
    ) {
        let given: Vec<f64> = given.into_iter().map(f64::from).collect();
        prop_assume!(given.iter().any(|d| *d != given[0]));
        let pairs = list(&given, &weights);
        for transformation in all_transformations() {
            let found = fitted(&pairs, &transformation);
            prop_assert!(found.iter().all(|e| *e >= 0.0), "{transformation:?}: {found:?}");
            let mut other = admitted(&pairs, &transformation, &knobs);
            if !matches!(transformation, Transformation::Bounds(_)) {
                prop_assert!((size(&pairs, &found) / size(&pairs, &given) - 1.0).abs() < 1e-12);
                let factor = (size(&pairs, &given) / size(&pairs, &other)).sqrt();
                other.iter_mut().for_each(|e| *e *= factor);
            }
            let (best, trial) = (cost(&pairs, &found), cost(&pairs, &other));
            prop_assert!(best <= trial + 1e-9, "{transformation:?}: {best} {trial} {found:?} {other:?}");
        }
    }
}

#[test]
fn a_tie_that_would_fall_below_zero_is_held_there() {
    // Distances 1, 3, 7, 7.5, 2, 6, 6.5, 4, 4.5, 0.5 of the line; the first nine are tied below the
    // last. Their mean, 41.5 / 9, and 0.5 are pooled to 4.2: the tie is lowered by 0.411, the last
    // one raised. Nothing falls below zero. With the last one heavier, the common level is lower:
    // (41.5 + 100 * 0.5) / 109 = 0.839, and the tie as a whole would fall by 3.77.
    let mut given = [1.0; 10];
    given[9] = 2.0;
    let mut weights = [1.0; 10];
    weights[9] = 100.0;
    let pairs = list(&given, &weights);
    let order = DissimilarityOrder::new(&given).unwrap();
    let distances = Disparities::new(&pairs, &Transformation::Ratio).unwrap().distances(&POINTS);
    let plain = order.nearest(&distances, &weights, Ties::Tertiary);
    assert!(plain.iter().any(|e| *e < -2.0));
    let held = non_negative_tertiary(&order, &distances, &weights);
    // Shifted by t and cut at zero, with a mean m of the tie; the last one at m as well. The least
    // sum of squares has 9 (m - cut mean) ... worked out by equal multipliers: t * 9 = 100 (m - 0.5).
    let cut: Vec<f64> = held[..9].to_vec();
    let shift = distances[3] - held[3];
    for (e, d) in cut.iter().zip(&distances) {
        assert!((e - (d - shift).max(0.0)).abs() < 1e-8, "{held:?}");
    }
    let mean = cut.iter().sum::<f64>() / 9.0;
    assert!((mean - held[9]).abs() < 1e-8 && (9.0 * shift - 100.0 * (held[9] - 0.5)).abs() < 1e-6);
}

#[test]
fn an_interval_worked_by_hand() {
    // Three objects on a line at 0, 1, 3: distances 1, 3, 2. Given 5, 7, 6: e = 1 + (d - 5) fits
    // exactly, of size 1 + 9 + 4 = 14; held at 25 + 49 + 36 = 110.
    let pair = |i, j, distance| Pair { i, j, distance, weight: 1.0 };
    let pairs = PairDistances::new(3, vec![pair(0, 1, 5.0), pair(0, 2, 7.0), pair(1, 2, 6.0)]).unwrap();
    let factor = (110.0_f64 / 14.0).sqrt();
    for (found, expected) in fitted(&pairs, &Transformation::Interval).iter().zip([1.0, 3.0, 2.0]) {
        assert!((found - factor * expected).abs() < 1e-9);
    }
}

#[test]
fn dissimilarities_that_are_all_equal_stay() {
    let pairs = list(&[4.0; 10], &[1.0; 10]);
    for transformation in all_transformations() {
        if !matches!(
            transformation,
            Transformation::Bounds(_) | Transformation::Ordinal(Ties::Primary | Ties::Tertiary)
        ) {
            for e in fitted(&pairs, &transformation) {
                assert!((e - 4.0).abs() < 1e-12, "{transformation:?}: {e}");
            }
        }
    }
}

#[test]
fn objects_in_one_place_tell_nothing() {
    let pairs = list(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0], &[1.0; 10]);
    for transformation in &all_transformations()[..6] {
        let rule = Disparities::new(&pairs, transformation).unwrap();
        assert_eq!(rule.fit(&[[2.0, 2.0]; 5]), None, "{transformation:?}");
    }
}

#[test]
fn bounds_are_checked_and_clip() {
    let pair = |i, j, distance| Pair { i, j, distance, weight: 1.0 };
    let pairs = PairDistances::new(3, vec![pair(0, 1, 9.0), pair(0, 2, 1.0), pair(1, 2, 2.0)]).unwrap();
    let bounds = PairBounds::new(vec![0.0, 4.0, 1.0], vec![0.5, f64::INFINITY, 5.0]).unwrap();
    let bounded = Transformation::Bounds(bounds);
    let rule = Disparities::new(&pairs, &bounded).unwrap();
    assert_eq!(rule.first(), [0.5, 4.0, 2.0]);
    // Distances 1, 3 and 2.
    assert_eq!(rule.fit(&POINTS[..3]).unwrap(), [0.5, 4.0, 2.0]);
    assert_eq!(rule.fit(&[[0.0, 0.0], [0.25, 0.0], [6.0, 0.0]]).unwrap(), [0.25, 6.0, 5.0]);

    for (lower, upper) in
        [(-1.0, 1.0), (2.0, 1.0), (f64::NAN, 1.0), (0.0, f64::NAN), (f64::INFINITY, f64::INFINITY)]
    {
        let error = PairBounds::new(vec![0.0, lower], vec![1.0, upper]).unwrap_err();
        assert!(matches!(error, EmbedError::BadObservation { index: 1, .. }), "{lower} {upper}");
    }
    let lengths = PairBounds::new(vec![0.0], vec![]).unwrap_err();
    assert!(matches!(lengths, EmbedError::Lengths { first: 1, second: 0 }));
    let short = Transformation::Bounds(PairBounds::new(vec![0.0], vec![1.0]).unwrap());
    assert!(matches!(Disparities::new(&pairs, &short), Err(EmbedError::Lengths { first: 3, second: 1 })));
    let flat = Transformation::MSpline { degree: 0, interior_knots: 2 };
    assert!(matches!(Disparities::new(&pairs, &flat), Err(EmbedError::BadDegree)));
}
