use proptest::prelude::*;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::*;
use crate::EmbedError;

const LOOKS: f64 = 400.0;

/// One curve of each family.
fn curves() -> [DistanceCurve; 6] {
    let log = StretchedExponential { nearest: 0.7, length: 0.6, exponent: 2.0 };
    let table = [(0.1, 0.3), (0.5, 0.9), (0.9, 2.5), (1.4, 3.5)];
    [
        DistanceCurve::Log(log),
        DistanceCurve::Inverse(InverseSquare { nearest: 0.6, length: 0.4 }),
        DistanceCurve::Lens(Lens { range: 0.8, detectability: 0.8 }),
        DistanceCurve::Power(StretchedExponential { exponent: 1.2, ..log }),
        DistanceCurve::Spline(Tabulated::through(&table).unwrap()),
        DistanceCurve::Isotonic(Tabulated::through(&table).unwrap()),
    ]
}

/// Pairs between 0.02 and `farthest`, each looked at 400 times.
fn observed(curve: &DistanceCurve, pairs: usize, farthest: f64, seed: u64) -> Vec<Observation> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let observe = |_| {
        let distance = rng.random_range(0.02..farthest);
        let f = curve.frequency(distance);
        let together = (0..LOOKS as u32).filter(|_| rng.random_bool(f)).count() as f64;
        Observation { distance, together, either: LOOKS }
    };
    (0..pairs).map(observe).collect()
}

fn likelihood(curve: &DistanceCurve, observations: &[Observation]) -> f64 {
    observations.iter().map(|observation| observation.log_likelihood(curve)).sum()
}

#[test]
fn every_curve_falls_and_is_undone_by_its_inverse() {
    for curve in curves() {
        let mut before = 1.0;
        for k in 0..150 {
            let distance = 0.01 * f64::from(k);
            let f = curve.frequency(distance);
            assert!(f > 0.0 && f <= before, "{curve:?} at {distance}");
            before = f;
            let back = curve.distance(f);
            assert!((back - distance).abs() < 1e-6, "{curve:?}: {distance} -> {f} -> {back}");
        }
        assert!(curve.distance(1.0 - 1e-12) < 1e-6);
        assert!(curve.distance(1e-9).is_finite());
    }
}

#[test]
fn scaling_stretches_distances_and_nothing_else() {
    for curve in curves() {
        let scaled = curve.clone().scaled(3.0);
        assert_eq!(scaled.family(), curve.family());
        for f in [0.01, 0.1, 0.3, 0.5] {
            assert!((scaled.distance(f) - 3.0 * curve.distance(f)).abs() < 1e-9, "{curve:?} at {f}");
        }
    }
}

#[test]
fn values_worked_by_hand() {
    // exp(-1) at d = a, 1/(1/0.5 + 4) = 1/6 at d = 2a.
    let log = StretchedExponential { nearest: 1.0, length: 0.3, exponent: 2.0 };
    assert!((log.frequency(0.3) - 0.367_879_441).abs() < 1e-9);
    let inverse = InverseSquare { nearest: 0.5, length: 0.3 };
    assert!((inverse.frequency(0.6) - 1.0 / 6.0).abs() < 1e-12);
    // u = 1/2: l = (2/pi)(pi/3 - sqrt(3)/4) = 2/3 - sqrt(3)/(2 pi) = 0.391002; f = l / (2 - l).
    let lens = Lens { range: 1.0, detectability: 1.0 };
    assert!((lens.frequency(1.0) - 0.243_010).abs() < 1e-6);
    assert_eq!((lens.frequency(2.0), lens.frequency(9.0)), (0.0, 0.0));
    // Between (0.1, 0.3) and (0.5, 0.9) the middle is (0.3, 0.6); to the origin (0.05, 0.15);
    // beyond (1.4, 3.5) with the slope from (0.5, 0.9), 2.6 / 0.9.
    let [.., DistanceCurve::Isotonic(table)] = curves() else { panic!("the isotonic curve is last") };
    assert!((table.frequency(0.3) + 0.0 - (-0.6_f64).exp()).abs() < 1e-12);
    assert!((table.frequency(0.05) - (-0.15_f64).exp()).abs() < 1e-12);
    assert!((table.frequency(1.5) - (-3.5 - 0.26 / 0.9_f64).exp()).abs() < 1e-12);
}

#[test]
fn each_family_recovers_its_own_parameters() {
    for (k, curve) in curves().into_iter().enumerate() {
        let fitted = curve.family().fit(&observed(&curve, 3000, 1.3, k as u64)).unwrap();
        assert_eq!(fitted.family(), curve.family());
        match (&fitted, &curve) {
            (DistanceCurve::Log(a), DistanceCurve::Log(b))
            | (DistanceCurve::Power(a), DistanceCurve::Power(b)) => {
                assert!((a.nearest / b.nearest - 1.0).abs() < 0.02, "{a:?}");
                assert!((a.length / b.length - 1.0).abs() < 0.02, "{a:?}");
                assert!((a.exponent / b.exponent - 1.0).abs() < 0.02, "{a:?}");
            }
            (DistanceCurve::Inverse(a), DistanceCurve::Inverse(b)) => {
                assert!((a.nearest / b.nearest - 1.0).abs() < 0.02, "{a:?}");
                assert!((a.length / b.length - 1.0).abs() < 0.02, "{a:?}");
            }
            (DistanceCurve::Lens(a), DistanceCurve::Lens(b)) => {
                assert!((a.detectability / b.detectability - 1.0).abs() < 0.02, "{a:?}");
                assert!((a.range / b.range - 1.0).abs() < 0.02, "{a:?}");
            }
            _ => {
                for distance in [0.2, 0.4, 0.7, 1.0, 1.2] {
                    let (found, wanted) = (fitted.frequency(distance), curve.frequency(distance));
                    assert!((found / wanted - 1.0).abs() < 0.1, "{fitted:?} at {distance}");
                }
            }
        }
    }
}

#[test]
fn no_curve_of_the_family_makes_the_counts_more_likely() {
    for (k, curve) in curves().into_iter().enumerate().take(4) {
        let observations = observed(&curve, 200, 1.2, 10 + k as u64);
        let best = likelihood(&curve.family().fit(&observations).unwrap(), &observations);
        // The generating curve is one of them; the difference is half a chi-square of 2 or 3.
        let truth = likelihood(&curve, &observations);
        assert!(best >= truth && best < truth + 10.0, "{curve:?}: {best} {truth}");
    }
}

#[test]
fn the_isotonic_fit_is_worked_by_hand() {
    // Twelve looks at four pairs a bin: 3 bins of 48 looks with 24, 30 and 6 found together. The first
    // two are out of order and pooled: (24.5/49 + 30.5/49) / 2 = 55/98.
    let bin = |distance: f64, together: f64| {
        (0..4).map(move |_| Observation { distance, together: together / 4.0, either: 12.0 })
    };
    let observations: Vec<_> = bin(1.0, 24.0).chain(bin(2.0, 30.0)).chain(bin(3.0, 6.0)).collect();
    let curve = DistanceFamily::Isotonic.fit(&observations).unwrap();
    assert!((curve.frequency(1.5) - 55.0 / 98.0).abs() < 1e-12);
    assert!((curve.frequency(3.0) - 6.5 / 49.0).abs() < 1e-12);
}

#[test]
fn unusable_observations_are_refused() {
    let good = Observation { distance: 1.0, together: 3.0, either: 9.0 };
    for family in DistanceFamily::ALL {
        for too_few in [vec![], vec![good], vec![good; 40]] {
            let refusal = family.fit(&too_few).unwrap_err();
            assert!(
                matches!(refusal, EmbedError::NoRange { values } if values == too_few.len()),
                "{refusal}"
            );
        }
        for bad in [
            Observation { distance: f64::NAN, ..good },
            Observation { distance: -1.0, ..good },
            Observation { together: 10.0, ..good },
            Observation { together: -1.0, ..good },
            Observation { either: 0.0, together: 0.0, ..good },
            Observation { either: f64::INFINITY, ..good },
        ] {
            let refusal = family.fit(&[good, bad]).unwrap_err();
            assert!(matches!(refusal, EmbedError::BadObservation { index: 1, .. }), "{bad:?}");
        }
    }
}

#[test]
fn counts_that_do_not_fall_still_give_finite_curves_or_a_refusal() {
    // Always together, never together, all alike, and rising with the distance.
    let counts: [fn(usize) -> f64; 4] = [|_| 50.0, |_| 0.0, |_| 20.0, |k| k as f64];
    for of in counts {
        let observe = |k| Observation { distance: 0.1 * k as f64, together: of(k), either: 50.0 };
        let observations: Vec<_> = (0..40).map(observe).collect();
        for family in DistanceFamily::ALL {
            match family.fit(&observations) {
                Ok(curve) => {
                    let distances = [1e-3, 0.2, 0.9].map(|f| curve.distance(f));
                    assert!(distances.iter().all(|d| *d >= 0.0 && d.is_finite()), "{curve:?} {distances:?}");
                }
                Err(error) => assert!(matches!(error, EmbedError::NoRange { .. }), "{error}"),
            }
        }
    }
}

#[test]
fn a_curve_is_saved_with_the_name_of_its_family() {
    let names = DistanceFamily::ALL.map(DistanceFamily::name);
    assert_eq!(names, ["log", "inverse", "lens", "power", "spline", "isotonic"]);
    for curve in curves() {
        assert_eq!(DistanceFamily::ALL.iter().filter(|family| **family == curve.family()).count(), 1);
    }
}

proptest! {
    #[test]
    fn fitted_curves_fall_for_any_counts(
        pairs in prop::collection::vec((0.0..3.0_f64, 0_u32..60, 60_u32..90), 2..80),
    ) {
        let observations: Vec<_> = pairs
            .iter()
            .map(|&(distance, n, m)| Observation { distance, together: n.into(), either: m.into() })
            .collect();
        for family in DistanceFamily::ALL {
            if let Ok(curve) = family.fit(&observations) {
                let f: Vec<f64> = (0..40).map(|k| curve.frequency(0.1 * f64::from(k))).collect();
                prop_assert!(f.windows(2).all(|two| two[0] >= two[1]), "{curve:?} {f:?}");
                prop_assert!(f.iter().all(|f| (0.0..=1.0).contains(f)));
            }
        }
    }
}
