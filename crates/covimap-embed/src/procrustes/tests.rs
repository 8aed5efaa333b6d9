use proptest::prelude::*;

use super::*;

const FREE: ProcrustesOptions = ProcrustesOptions { scale: true, reflection: Reflection::Allow };
const RIGID: ProcrustesOptions = ProcrustesOptions { scale: false, reflection: Reflection::Allow };

fn paired(source: &[Point], target: &[Point]) -> Vec<Correspondence> {
    let pair = |(&source, &target)| Correspondence { source, target, weight: 1.0 };
    source.iter().zip(target).map(pair).collect()
}

fn carried(transform: &Similarity, source: &[Point]) -> Vec<Correspondence> {
    paired(source, &source.iter().map(|&s| transform.apply(s)).collect::<Vec<_>>())
}

fn angled(angle: f64, mirrored: bool, scale: f64, shift: Point) -> Similarity {
    Similarity { cos: angle.cos(), sin: angle.sin(), mirrored, scale, shift }
}

/// Points without symmetry, spread over a unit or so.
fn scattered(n: usize) -> Vec<Point> {
    (0..n).map(|k| [(1.3 * k as f64).sin() + 0.05 * k as f64, (0.7 * (k * k) as f64).cos()]).collect()
}

/// The sum (1) over a fine grid of angles, with the best shift and, if asked, the best scale.
fn grid_search(pairs: &[Correspondence], scale: bool, mirrored: bool) -> f64 {
    let weight: f64 = pairs.iter().map(|p| p.weight).sum();
    let mean =
        |of: &dyn Fn(&Correspondence) -> f64| pairs.iter().map(|p| p.weight * of(p)).sum::<f64>() / weight;
    let (sx, sy) = (mean(&|p| p.source[0]), mean(&|p| p.source[1]));
    let (tx, ty) = (mean(&|p| p.target[0]), mean(&|p| p.target[1]));
    let squares_at = |angle: f64| {
        let turn = angled(angle, mirrored, 1.0, [0.0; 2]);
        let (mut rr, mut rt, mut tt) = (0.0, 0.0, 0.0);
        for p in pairs {
            let r = turn.apply([p.source[0] - sx, p.source[1] - sy]);
            let t = [p.target[0] - tx, p.target[1] - ty];
            rr += p.weight * (r[0] * r[0] + r[1] * r[1]);
            rt += p.weight * (r[0] * t[0] + r[1] * t[1]);
            tt += p.weight * (t[0] * t[0] + t[1] * t[1]);
        }
        // |t - c r|^2 = tt - 2 c rt + c^2 rr, least at c = rt / rr, which must not be negative.
        let c = if scale { f64::max(rt / rr, 0.0) } else { 1.0 };
        tt - 2.0 * c * rt + c * c * rr
    };
    let squares = (0..3600).map(|k| squares_at(f64::from(k) * std::f64::consts::TAU / 3600.0));
    (squares.fold(f64::MAX, f64::min) / weight).sqrt()
}

proptest! {
    #[test]
    fn a_random_similarity_is_recovered(
        angle in -3.2..3.2, mirrored: bool, log_scale in -5.0..5.0, x in -1e3..1e3, y in -1e3..1e3,
        n in 3_usize..20,
    ) {
        let truth = angled(angle, mirrored, f64::exp(log_scale), [x, y]);
        let fit = procrustes(&carried(&truth, &scattered(n)), FREE).unwrap();
        let found = fit.target_from_source;
        prop_assert_eq!(found.mirrored, mirrored);
        prop_assert!((found.scale / truth.scale - 1.0).abs() < 1e-9);
        let linear = truth.inverse().after(&found);
        prop_assert!((linear.cos - 1.0).abs() < 1e-9 && linear.sin.abs() < 1e-9);
        prop_assert!((found.shift[0] - x).hypot(found.shift[1] - y) < 1e-9 * (1.0 + truth.scale));
        prop_assert!(fit.rmse < 1e-10 * (1.0 + truth.scale));
    }

    #[test]
    fn the_fit_is_an_isometry_when_the_scale_is_held(points in prop::collection::vec(-1.0..1.0_f64, 12)) {
        let points: Vec<Point> = points.chunks(2).map(|c| [c[0], c[1]]).collect();
        let pairs = paired(&scattered(6), &points);
        let fit = procrustes(&pairs, RIGID).unwrap().target_from_source;
        prop_assert!((fit.scale - 1.0).abs() < 1e-14 && (fit.cos.hypot(fit.sin) - 1.0).abs() < 1e-14);
    }

    #[test]
    fn no_angle_of_a_fine_grid_fits_better(
        points in prop::collection::vec(-1.0..1.0_f64, 12), weights in prop::collection::vec(0.1..3.0_f64, 6),
        scale: bool,
    ) {
        let points: Vec<Point> = points.chunks(2).map(|c| [c[0], c[1]]).collect();
        let mut pairs = paired(&scattered(6), &points);
        pairs.iter_mut().zip(weights).for_each(|(pair, weight)| pair.weight = weight);
        for (reflection, mirrored) in [(Reflection::Forbid, false), (Reflection::Require, true)] {
            let fit = procrustes(&pairs, ProcrustesOptions { scale, reflection }).unwrap();
            prop_assert_eq!(fit.target_from_source.mirrored, mirrored);
            for (rmse, handedness) in [(fit.rmse, mirrored), (fit.rmse_other, !mirrored)] {
                let searched = grid_search(&pairs, scale, handedness);
                // The grid misses the best angle by up to 0.9 mrad, which costs its square.
                prop_assert!(rmse <= searched + 1e-12 && searched < rmse + 1e-5, "{} {}", rmse, searched);
            }
        }
    }
}

#[test]
fn weights_decide_between_pairs_that_disagree() {
    // Scale held: source 0, 1, 2 on the x axis, the last target pulled to 2.9. With weights
    // 1, 1, 2 the best shift is the weighted mean of 0, 0, 0.9: 0.45.
    let mut pairs = paired(&[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]], &[[0.0, 0.0], [1.0, 0.0], [2.9, 0.0]]);
    pairs[2].weight = 2.0;
    let fit = procrustes(&pairs, RIGID).unwrap();
    assert!((fit.target_from_source.shift[0] - 0.45).abs() < 1e-14);
    // Residuals -0.45, -0.45, 0.45: their weighted mean square is 0.2025.
    assert!((fit.rmse - 0.45).abs() < 1e-14);
}

#[test]
fn the_condition_is_the_ratio_of_the_extents() {
    // A rectangle of 4 by 1.
    let rectangle = [[0.0, 0.0], [4.0, 0.0], [4.0, 1.0], [0.0, 1.0]];
    let fit = procrustes(&carried(&angled(0.4, false, 2.0, [1.0, 1.0]), &rectangle), FREE).unwrap();
    assert!((fit.condition - 0.25).abs() < 1e-14);
    assert!(fit.handedness_determined && fit.rmse_other > 0.1);
}

#[test]
fn points_on_a_line_leave_the_handedness_open() {
    let line = [[0.0, 0.0], [1.0, 1.0], [3.0, 3.0]];
    for mirrored in [false, true] {
        let fit = procrustes(&carried(&angled(2.0, mirrored, 0.5, [1.0, 2.0]), &line), FREE).unwrap();
        assert!(!fit.handedness_determined && !fit.target_from_source.mirrored);
        assert!(fit.rmse < 1e-14 && fit.rmse_other < 1e-14 && fit.condition < 1e-7);
    }
}

#[test]
fn two_points_fix_a_similarity_of_either_handedness() {
    let pairs = paired(&[[0.0, 0.0], [1.0, 0.0]], &[[5.0, 5.0], [5.0, 7.0]]);
    for reflection in [Reflection::Forbid, Reflection::Require] {
        let fit = procrustes(&pairs, ProcrustesOptions { scale: true, reflection }).unwrap();
        assert!(fit.rmse < 1e-14 && !fit.handedness_determined);
        assert!((fit.target_from_source.scale - 2.0).abs() < 1e-14);
    }
}

#[test]
fn coinciding_points_are_refused() {
    let apart = [[0.0, 0.0], [1.0, 0.0]];
    let same = [[0.1, 0.2], [0.1, 0.2]];
    for (source, target) in [(same, apart), (apart, same), (same, same)] {
        let error = procrustes(&paired(&source, &target), FREE).unwrap_err();
        assert!(matches!(error, EmbedError::CoincidingPoints { pairs: 2 }));
    }
    assert!(matches!(procrustes(&[], FREE), Err(EmbedError::CoincidingPoints { pairs: 0 })));
    let one = paired(&apart[..1], &apart[1..]);
    assert!(matches!(procrustes(&one, RIGID), Err(EmbedError::CoincidingPoints { pairs: 1 })));
}

#[test]
fn a_round_set_and_its_mirror_image_fix_no_rotation() {
    let square = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]];
    let pairs = carried(&angled(0.3, true, 1.0, [0.0; 2]), &square);
    for scale in [true, false] {
        let error =
            procrustes(&pairs, ProcrustesOptions { scale, reflection: Reflection::Forbid }).unwrap_err();
        assert!(matches!(error, EmbedError::UndeterminedRotation { pairs: 4 }));
        let fit = procrustes(&pairs, ProcrustesOptions { scale, reflection: Reflection::Allow }).unwrap();
        // The other fit shrinks the source to its mean, radius 1, or leaves it a random angle off.
        let other = if scale { 1.0 } else { f64::sqrt(2.0) };
        assert!(fit.rmse < 1e-15 && (fit.rmse_other - other).abs() < 1e-15);
    }
}

#[test]
fn numbers_out_of_range_are_refused_with_their_place() {
    let mut pairs = paired(&scattered(3), &scattered(3));
    for bad in [f64::NAN, f64::INFINITY, 2e100] {
        pairs[1].target[1] = bad;
        assert!(matches!(procrustes(&pairs, FREE), Err(EmbedError::BadCorrespondence { index: 1, .. })));
    }
    pairs[1].target[1] = 0.0;
    for bad in [f64::NAN, f64::INFINITY, 0.0, -1.0] {
        pairs[2].weight = bad;
        let error = robust_procrustes(&pairs, FREE).unwrap_err();
        assert!(matches!(error, EmbedError::BadCorrespondence { index: 2, .. }));
    }
}

#[test]
fn robust_and_plain_fit_agree_without_outliers() {
    let truth = angled(-2.0, true, 1.7, [3.0, -4.0]);
    let robust = robust_procrustes(&carried(&truth, &scattered(10)), FREE).unwrap();
    assert!(robust.fit.rmse < 1e-14 && robust.fit.target_from_source.mirrored);
    assert!(robust.trust.iter().all(|&trust| trust > 0.999));
}

#[test]
fn outliers_lose_their_weight() {
    let truth = angled(0.8, true, 1.3, [3.0, 2.0]);
    let mut pairs = carried(&truth, &scattered(25));
    for (k, pair) in pairs.iter_mut().enumerate() {
        // A little noise for all.
        pair.target[0] += 1e-3 * (5.0 * k as f64).sin();
        pair.target[1] += 1e-3 * (3.0 * k as f64).cos();
    }
    // Eleven of 25 are carried along by another transform: the plain start ends between the two.
    let wrong = angled(-1.5, false, 2.0, [-4.0, 1.0]);
    for pair in &mut pairs[..11] {
        pair.target = wrong.apply(pair.source);
    }
    let plain = procrustes(&pairs, FREE).unwrap();
    let robust = robust_procrustes(&pairs, FREE).unwrap();
    let found = robust.fit.target_from_source;
    assert!(plain.rmse > 0.5 && robust.fit.rmse < 2e-3);
    assert!((found.scale - 1.3).abs() < 2e-3 && found.mirrored);
    assert!(robust.trust[..11].iter().all(|&trust| trust < 1e-6));
    assert!(robust.trust[11..].iter().all(|&trust| trust > 0.05));
    assert!((3e-4..3e-3).contains(&robust.sigma));
}

#[test]
fn three_pairs_have_no_outlier() {
    let robust =
        robust_procrustes(&paired(&scattered(3), &[[0.0, 0.0], [1.0, 0.0], [5.0, 9.0]]), FREE).unwrap();
    assert_eq!(robust.trust, [1.0; 3]);
    assert!(robust.sigma > 0.0);
}

#[test]
fn an_outlier_among_points_that_coincide_keeps_the_start() {
    // Four of five points coincide; without the fifth nothing is left to fit.
    let mut source = [[1.0, 1.0]; 5];
    source[4] = [2.0, 3.0];
    let robust = robust_procrustes(&carried(&angled(0.5, false, 1.0, [0.0; 2]), &source), FREE).unwrap();
    assert!(robust.fit.rmse < 1e-14);
    assert!(matches!(
        robust_procrustes(&paired(&[[1.0, 1.0]; 5], &source), FREE),
        Err(EmbedError::CoincidingPoints { pairs: 5 })
    ));
}
