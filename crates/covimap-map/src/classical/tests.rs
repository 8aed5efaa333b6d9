use super::*;
use crate::SightingLog;
use crate::fixtures::counts_of;

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-7
}

#[test]
fn distance_functions_computed_by_hand() {
    let phi1 = ClassicalParams { phi: Phi::Phi1, ..ClassicalParams::default() };
    // 0.05 (1/f - 1): 0.05 at 1/2, below lo = 0.1; 0.45 at 1/10; 4.95 at 1/100, above hi = 2.
    let wanted = [(1.0, 0.1), (0.5, 0.1), (0.1, 0.45), (0.01, 2.0), (0.0, 2.0)];
    assert!(wanted.iter().all(|&(f, squared)| close(phi1.squared_distance(f), squared)));
    let phi2 = ClassicalParams::default();
    // -0.3 ln f: 0 at 1, 0.2079442 at 1/2, 0.6907755 at 1/10, 2.07 at 1/1000.
    let wanted = [(1.0, 0.1), (0.5, 0.207_944_2), (0.1, 0.690_775_5), (0.001, 2.0), (0.0, 2.0)];
    assert!(wanted.iter().all(|&(f, squared)| close(phi2.squared_distance(f), squared)));
}

#[test]
fn the_factor_is_the_one_set_or_that_of_the_paper() {
    let of = |phi, alpha| ClassicalParams { phi, alpha, ..ClassicalParams::default() }.factor();
    assert_eq!([of(Phi::Phi1, None), of(Phi::Phi2, None), of(Phi::Phi2, Some(0.7))], [0.05, 0.3, 0.7]);
    let own = ClassicalParams { alpha: Some(1.0), lo: 0.0, hi: 9.0, ..ClassicalParams::default() };
    // -ln(1/e) = 1, and clamps that do not bite.
    assert!(close(own.squared_distance((-1.0f64).exp()), 1.0) && close(own.squared_distance(1.0), 0.0));
    assert!(close(own.squared_distance(0.0), 9.0));
}

#[test]
fn parameters_out_of_range_are_refused() {
    let default = ClassicalParams::default();
    assert!(default.check().is_ok());
    let refusal = |params: ClassicalParams| match params.check().unwrap_err() {
        MapError::BadParameter { name, .. } => name,
        other => panic!("{other}"),
    };
    for alpha in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(refusal(ClassicalParams { alpha: Some(alpha), ..default.clone() }), "classical.alpha");
    }
    for lo in [-0.1, f64::NAN, f64::INFINITY] {
        assert_eq!(refusal(ClassicalParams { lo, ..default.clone() }), "classical.lo");
    }
    for hi in [0.05, f64::NAN, f64::INFINITY] {
        assert_eq!(refusal(ClassicalParams { hi, ..default.clone() }), "classical.hi");
    }
    assert_eq!(refusal(ClassicalParams { lo: 0.0, hi: 0.0, ..default.clone() }), "classical.hi");
    assert_eq!(
        ClassicalParams { lo: -0.5, ..default }.check().unwrap_err().to_string(),
        "setting classical.lo is -0.5; give a number that is not negative"
    );
}

#[test]
fn the_constraint_takes_the_way_over_a_common_neighbour() {
    // A and C are never together: f_AB = f_BC = 1 / (1 + 2 - 1) = 1/2, squared 0.3 ln 2 = 0.2079442.
    let counts = counts_of(&SightingLog::from_steps([["A", "B"], ["B", "C"]]));
    let squared = |tic| {
        let params = ClassicalParams { tic, ..ClassicalParams::default() };
        squared_distances(&counts, &[0, 1, 2], &params).unwrap()
    };
    assert!(close(squared(false).get(0, 1), 0.207_944_2) && close(squared(false).get(0, 2), 2.0));
    // (2 * 0.4560090)^2 = 0.8317766, which is shorter than sqrt 2.
    assert!(close(squared(true).get(0, 2), 0.831_776_6) && close(squared(true).get(0, 1), 0.207_944_2));
}

#[test]
fn members_are_taken_in_their_own_order() {
    let counts = counts_of(&SightingLog::from_steps([vec!["A", "B"], vec!["B", "C"], vec!["D"]]));
    let params = ClassicalParams { tic: false, ..ClassicalParams::default() };
    let table = squared_distances(&counts, &[2, 1], &params).unwrap();
    assert_eq!(
        (table.objects(), table.get(0, 1)),
        (2, squared_distances(&counts, &[1, 2], &params).unwrap().get(0, 1))
    );
    assert_eq!(solve(&counts, &[3], &params).unwrap().points, [[0.0, 0.0]]);
}

#[test]
fn a_component_too_large_for_a_table_is_refused_before_there_is_one() {
    let landmarks = CLASSICAL_LIMIT as u32 + 1;
    let pairs = (1..landmarks).map(|i| (LandmarkId(i - 1), LandmarkId(i), 1));
    let counts = CoVisibility::from_counts(9, vec![3; landmarks as usize], pairs).unwrap();
    let members: Vec<u32> = (0..landmarks).collect();
    let error = solve(&counts, &members, &ClassicalParams::default()).unwrap_err();
    assert!(matches!(error, MapError::TooLargeForClassical { landmarks: 3001, limit: 3000 }));
    assert_eq!(
        error.to_string(),
        "the classical method is dense and takes at most 3000 landmarks, here are 3001; use --method auto"
    );
}
