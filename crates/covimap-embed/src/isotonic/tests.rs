use proptest::prelude::*;

use super::*;

/// The min-max formula: `z_k = max over i <= k of min over j >= k of mean(i ..= j)`.
fn oracle(values: &[f64], weights: &[f64]) -> Vec<f64> {
    let mean = |i: usize, j: usize| {
        let sum: f64 = (i..=j).map(|k| values[k] * weights[k]).sum();
        sum / weights[i..=j].iter().sum::<f64>()
    };
    let n = values.len();
    let least = |i: usize, k: usize| (k..n).map(|j| mean(i, j)).fold(f64::INFINITY, f64::min);
    (0..n).map(|k| (0..=k).map(|i| least(i, k)).fold(f64::NEG_INFINITY, f64::max)).collect()
}

fn observations() -> impl Strategy<Value = Vec<(f64, f64, u8)>> {
    // Value, weight and a dissimilarity with many ties.
    prop::collection::vec((-5.0..5.0, 0.1..3.0, 0_u8..6), 0..40)
}

proptest! {
    #[test]
    fn agrees_with_the_min_max_formula(observations in observations()) {
        let values: Vec<f64> = observations.iter().map(|o| o.0).collect();
        let weights: Vec<f64> = observations.iter().map(|o| o.1).collect();
        let fitted = isotonic_regression(&values, &weights).unwrap();
        for (found, expected) in fitted.iter().zip(oracle(&values, &weights)) {
            prop_assert!((found - expected).abs() < 1e-12);
        }
        prop_assert!(fitted.is_sorted());
        let again = isotonic_regression(&fitted, &weights).unwrap();
        prop_assert!(again.iter().zip(&fitted).all(|(a, b)| (a - b).abs() < 1e-12));
    }

    #[test]
    fn each_kind_of_tie_keeps_its_promise_and_costs_what_it_should(observations in observations()) {
        let values: Vec<f64> = observations.iter().map(|o| o.0).collect();
        let weights: Vec<f64> = observations.iter().map(|o| o.1).collect();
        let given: Vec<f64> = observations.iter().map(|o| f64::from(o.2)).collect();
        let order = DissimilarityOrder::new(&given).unwrap();
        let fit = |ties| order.disparities(&values, &weights, ties).unwrap();
        let cost = |fitted: &[f64]| -> f64 {
            (0..values.len()).map(|k| weights[k] * (fitted[k] - values[k]).powi(2)).sum()
        };
        let (primary, secondary, tertiary) = (fit(Ties::Primary), fit(Ties::Secondary), fit(Ties::Tertiary));
        for a in 0..given.len() {
            for b in 0..given.len() {
                if given[a] < given[b] {
                    prop_assert!(primary[a] <= primary[b] && secondary[a] <= secondary[b]);
                }
                if given[a] == given[b] {
                    prop_assert_eq!(secondary[a], secondary[b]);
                    let kept = (tertiary[a] - tertiary[b]) - (values[a] - values[b]);
                    prop_assert!(kept.abs() < 1e-12);
                }
            }
        }
        // Each kind asks less than the one before it or keeps more of the distances.
        prop_assert!(cost(&primary) <= cost(&secondary) + 1e-12);
        prop_assert!(cost(&tertiary) <= cost(&secondary) + 1e-12);
    }
}

#[test]
fn weights_draw_the_mean() {
    // (1 * 4 + 3 * 2) / 4 = 2.5.
    assert_eq!(isotonic_regression(&[4.0, 2.0, 7.0], &[1.0, 3.0, 1.0]).unwrap(), [2.5, 2.5, 7.0]);
}

#[test]
fn ties_worked_by_hand() {
    // Dissimilarities 1, 2, 2, 3 and distances 1, 5, 2, 3, in another order of the list.
    let order = DissimilarityOrder::new(&[2.0, 1.0, 3.0, 2.0]).unwrap();
    let fit = |ties| order.disparities(&[5.0, 1.0, 3.0, 2.0], &[1.0; 4], ties).unwrap();
    // Sorted within the tie 1, 2, 5, 3: the last two are pooled.
    assert_eq!(fit(Ties::Primary), [4.0, 1.0, 4.0, 2.0]);
    // Means 1, 3.5 (of two), 3: the last three are pooled, (5 + 2 + 3) / 3.
    let third = 10.0 / 3.0;
    assert_eq!(fit(Ties::Secondary), [third, 1.0, third, third]);
    // The tie moves from 3.5 to 10/3 as a whole.
    let moved = third - 3.5;
    assert_eq!(fit(Ties::Tertiary), [5.0 + moved, 1.0, third, 2.0 + moved].map(|x: f64| x));
}

#[test]
fn zeros_of_either_sign_are_tied() {
    let order = DissimilarityOrder::new(&[0.0, -0.0, 0.0]).unwrap();
    let fitted = order.disparities(&[3.0, 1.0, 2.0], &[1.0; 3], Ties::Secondary).unwrap();
    assert_eq!(fitted, [2.0; 3]);
}

#[test]
fn nothing_one_and_all_equal() {
    assert!(isotonic_regression(&[], &[]).unwrap().is_empty());
    assert_eq!(isotonic_regression(&[-2.0], &[0.5]).unwrap(), [-2.0]);
    assert_eq!(isotonic_regression(&[1.5; 4], &[0.1, 0.2, 0.3, 0.4]).unwrap(), [1.5; 4]);
    let none = DissimilarityOrder::new(&[]).unwrap();
    assert!(none.disparities(&[], &[], Ties::Primary).unwrap().is_empty());
}

#[test]
fn unusable_observations_are_refused_with_their_place() {
    let at = |result: Result<Vec<f64>, EmbedError>| match result.unwrap_err() {
        EmbedError::BadObservation { index, .. } => index,
        other => panic!("{other}"),
    };
    assert_eq!(at(isotonic_regression(&[1.0, f64::NAN], &[1.0; 2])), 1);
    assert_eq!(at(isotonic_regression(&[f64::INFINITY, 1.0], &[1.0; 2])), 0);
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(at(isotonic_regression(&[1.0, 2.0], &[1.0, bad])), 1);
    }
    let nan = DissimilarityOrder::new(&[1.0, f64::NAN]).unwrap_err();
    assert!(matches!(nan, EmbedError::BadObservation { index: 1, .. }));
    let order = DissimilarityOrder::new(&[1.0, 2.0]).unwrap();
    for error in [
        isotonic_regression(&[1.0, 2.0], &[1.0]).unwrap_err(),
        order.disparities(&[1.0], &[1.0], Ties::Primary).unwrap_err(),
        order.disparities(&[1.0, 2.0], &[1.0], Ties::Primary).unwrap_err(),
    ] {
        assert!(matches!(error, EmbedError::Lengths { .. }));
    }
}
