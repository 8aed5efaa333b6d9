use super::*;
use proptest::prelude::*;

fn grid(n: usize) -> Vec<f64> {
    (0..n).map(|k| k as f64 / (n - 1) as f64).collect()
}

#[test]
fn the_integrated_splines_rise_from_zero_to_one() {
    for degree in 1..4 {
        let basis = MonotoneSplineBasis::at_quantiles(&grid(50), 3, degree).unwrap();
        let p = basis.coefficients();
        assert_eq!(p, degree + 3 + 1);
        for m in 0..p {
            let mut coefficients = vec![0.0; p];
            coefficients[m] = 1.0;
            let curve = MonotoneSpline { basis: basis.clone(), coefficients };
            let values: Vec<f64> = grid(200).iter().map(|&x| curve.value(x)).collect();
            assert!(values.windows(2).all(|pair| pair[0] <= pair[1] + 1e-15), "I_{m} of degree {degree}");
            let start = if m == 0 { 1.0 } else { 0.0 };
            assert!((values[0] - start).abs() < 1e-15 && (values[199] - 1.0).abs() < 1e-14);
        }
    }
}

#[test]
fn a_quadratic_without_knots_is_worked_by_hand() {
    // Degree 2 on [0, 1]: B = (1-x)^2, 2x(1-x), x^2, hence I_1 = 2x - x^2 and I_2 = x^2.
    let basis = MonotoneSplineBasis::at_quantiles(&[0.0, 1.0], 0, 2).unwrap();
    let curve = MonotoneSpline { basis, coefficients: vec![1.0, 2.0, 4.0] };
    // 1 + 2 (0.6 - 0.09) + 4 * 0.09 = 2.38.
    assert!((curve.value(0.3) - 2.38).abs() < 1e-15);
    assert_eq!((curve.value(-5.0), curve.value(9.0)), (1.0, 7.0));
}

#[test]
fn a_curve_of_the_family_is_found_again() {
    let x = grid(60);
    let basis = MonotoneSplineBasis::at_quantiles(&x, 2, 2).unwrap();
    let truth = MonotoneSpline { basis: basis.clone(), coefficients: vec![0.5, 1.0, 0.0, 2.0, 0.3] };
    let y: Vec<f64> = x.iter().map(|&x| truth.value(x)).collect();
    let fitted = basis.fit(&x, &y, &vec![2.0; 60]).unwrap();
    for (found, expected) in fitted.coefficients().iter().zip(truth.coefficients()) {
        assert!((found - expected).abs() < 1e-8, "{:?}", fitted.coefficients());
    }
}

proptest! {
    #[test]
    fn fits_rise_stay_above_zero_and_beat_the_constant(
        y in prop::collection::vec(-1.0..4.0_f64, 12), knots in 0_usize..5, degree in 1_usize..4,
    ) {
        let x = grid(12);
        let basis = MonotoneSplineBasis::at_quantiles(&x, knots, degree).unwrap();
        let fitted = basis.fit(&x, &y, &[1.0; 12]).unwrap();
        let values: Vec<f64> = x.iter().map(|&x| fitted.value(x)).collect();
        prop_assert!(values[0] >= 0.0 && values.windows(2).all(|pair| pair[0] <= pair[1] + 1e-12));
        let cost = |value: &dyn Fn(usize) -> f64| (0..12).map(|k| (value(k) - y[k]).powi(2)).sum::<f64>();
        let mean = (y.iter().sum::<f64>() / 12.0).max(0.0);
        prop_assert!(cost(&|k| values[k]) <= cost(&|_| mean) + 1e-9);
    }
}

#[test]
fn repeated_values_make_fewer_knots() {
    let x = [0.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 2.0];
    let basis = MonotoneSplineBasis::at_quantiles(&x, 4, 2).unwrap();
    assert_eq!(basis.coefficients(), 2 + 1 + 1);
    let ends = MonotoneSplineBasis::at_quantiles(&[3.0, 3.0, 3.0, 4.0], 2, 1).unwrap();
    assert_eq!(ends.coefficients(), 2);
}

#[test]
fn weights_decide_between_points_at_one_place() {
    // At x = 1 the values 2 and 5 with weights 2 and 1: 3. At x = 0 the value 1.
    let basis = MonotoneSplineBasis::at_quantiles(&[0.0, 1.0], 0, 1).unwrap();
    let fitted = basis.fit(&[0.0, 1.0, 1.0], &[1.0, 2.0, 5.0], &[1.0, 2.0, 1.0]).unwrap();
    assert!((fitted.value(0.0) - 1.0).abs() < 1e-9 && (fitted.value(1.0) - 3.0).abs() < 1e-9);
}

#[test]
fn unusable_input_is_refused() {
    let of = MonotoneSplineBasis::at_quantiles;
    assert!(matches!(of(&[0.0, 1.0], 2, 0), Err(EmbedError::BadDegree)));
    assert!(matches!(of(&[], 2, 2), Err(EmbedError::NoRange { values: 0 })));
    assert!(matches!(of(&[1.0; 3], 2, 2), Err(EmbedError::NoRange { values: 3 })));
    let nan = of(&[0.0, f64::NAN], 2, 2);
    assert!(matches!(nan, Err(EmbedError::BadObservation { index: 1, .. })));
    let basis = of(&[0.0, 1.0], 0, 2).unwrap();
    assert!(matches!(basis.fit(&[0.0], &[0.0, 1.0], &[1.0]), Err(EmbedError::Lengths { .. })));
    assert!(matches!(basis.fit(&[f64::NAN], &[0.0], &[1.0]), Err(EmbedError::BadObservation { .. })));
    assert!(matches!(basis.fit(&[0.0], &[f64::NAN], &[1.0]), Err(EmbedError::BadObservation { .. })));
}
