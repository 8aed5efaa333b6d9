//! Start configurations for solvers that only improve on one.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::{DistanceMatrix, EmbedError, PairDistances, Point, classical_scaling};

/// Torgerson's start: [classical scaling](classical_scaling) of the distances, where a distance
/// that is not listed is taken as the length of the shortest path over listed pairs.
///
/// `O(n^3)` time and `O(n^2)` memory; from some ten thousand objects on,
/// [`pivot_scaling`](crate::pivot_scaling) of [`ShortestPaths`](crate::ShortestPaths) is the
/// start to take.
///
/// # Errors
/// [`EmbedError::UnknownDistance`] if no path joins two objects: scale one component at a time.
pub fn torgerson_start(pairs: &PairDistances) -> Result<Vec<Point>, EmbedError> {
    let listed = DistanceMatrix::from_pairs(pairs);
    let filled = if pairs.is_complete() {
        listed
    } else {
        let paths = listed.clone().metric_closure();
        DistanceMatrix::from_fn(pairs.objects(), |i, j| {
            let known = listed.get(i, j);
            if known.is_finite() { known } else { paths.get(i, j) }
        })?
    };
    Ok(classical_scaling(&filled.map(|d| d * d)?)?.points)
}

/// `count` starts with points spread evenly over a square, whose mean squared distance is that of
/// the listed pairs (weighted), or 1 if none has any length.
#[must_use]
pub fn random_starts(pairs: &PairDistances, count: usize, seed: u64) -> Vec<Vec<Point>> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let (mut squares, mut weights) = (0.0, 0.0);
    for pair in pairs.pairs() {
        squares += pair.weight * pair.distance * pair.distance;
        weights += pair.weight;
    }
    let mean = if squares > 0.0 { squares / weights } else { 1.0 };
    // Two points of a square of side a are a^2 / 3 apart in the mean square.
    let half = 0.5 * (3.0 * mean).sqrt();
    let mut point = || [rng.random_range(-half..half), rng.random_range(-half..half)];
    (0..count).map(|_| (0..pairs.objects()).map(|_| point()).collect()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Pair, Smacof, StopRule};

    fn square(side: f64) -> PairDistances {
        let pair = |i, j, distance| Pair { i, j, distance, weight: 1.0 };
        let diagonal = side * 2f64.sqrt();
        let sides = [pair(0, 1, side), pair(0, 2, diagonal), pair(0, 3, side)];
        let more = [pair(1, 2, side), pair(1, 3, diagonal), pair(2, 3, side)];
        PairDistances::new(4, [sides, more].concat()).unwrap()
    }

    fn apart(points: &[Point], i: usize, j: usize) -> f64 {
        (points[i][0] - points[j][0]).hypot(points[i][1] - points[j][1])
    }

    #[test]
    fn torgersons_start_is_exact_for_a_plane() {
        let points = torgerson_start(&square(3.0)).unwrap();
        assert!((apart(&points, 0, 1) - 3.0).abs() < 1e-12);
        assert!((apart(&points, 0, 2) - 3.0 * 2f64.sqrt()).abs() < 1e-12);
    }

    #[test]
    fn torgersons_start_fills_gaps_and_nothing_else() {
        // 0 - 1 - 2 on a line with the long way round listed as 9: it stays 9, though 1 + 1 < 9.
        let pair = |i, j, distance| Pair { i, j, distance, weight: 1.0 };
        let listed = vec![pair(0, 1, 1.0), pair(0, 2, 9.0), pair(1, 2, 1.0), pair(2, 3, 2.0)];
        let points = torgerson_start(&PairDistances::new(4, listed).unwrap()).unwrap();
        // Pair (0, 3) becomes min(9 + 2, 1 + 1 + 2) = 4, pair (1, 3) becomes 3.
        let table = [0.0, 1.0, 9.0, 4.0, 1.0, 0.0, 1.0, 3.0, 9.0, 1.0, 0.0, 2.0, 4.0, 3.0, 2.0, 0.0];
        let squared = DistanceMatrix::from_rows(4, table.map(|d: f64| d * d).to_vec()).unwrap();
        assert_eq!(points, classical_scaling(&squared).unwrap().points);
        let apart = PairDistances::new(3, vec![pair(0, 1, 1.0)]).unwrap();
        assert!(matches!(torgerson_start(&apart), Err(EmbedError::UnknownDistance { i: 0, j: 2 })));
    }

    #[test]
    fn random_starts_have_the_size_of_the_distances_and_hang_on_the_seed() {
        let pairs = square(50.0);
        let starts = random_starts(&pairs, 2000, 1);
        // Mean square of the distances: (4 + 2 * 2) * 2500 / 6.
        let mean = starts.iter().map(|points| apart(points, 0, 1).powi(2)).sum::<f64>() / 2000.0;
        assert!((mean / (8.0 * 2500.0 / 6.0) - 1.0).abs() < 0.05, "{mean}");
        assert_eq!(random_starts(&pairs, 2, 1), starts[..2]);
        assert_ne!(random_starts(&pairs, 1, 2)[0], starts[0]);
        let no_length = PairDistances::new(2, vec![]).unwrap();
        assert!(random_starts(&no_length, 1, 1)[0].iter().flatten().any(|x| *x != 0.0));
    }

    #[test]
    fn the_best_of_several_starts_is_kept_with_the_stress_of_all() {
        // Unit distances between twelve objects fit no plane: starts end in different minima.
        let pair = |(i, j)| Pair { i, j, distance: 1.0, weight: 1.0 };
        let all = (0..12).flat_map(|i| (i + 1..12).map(move |j| (i, j))).map(pair);
        let pairs = PairDistances::new(12, all.collect()).unwrap();
        let starts = random_starts(&pairs, 8, 3);
        let how = Smacof::default();
        let compared = how.from_starts(&pairs, &starts).unwrap();
        for (start, &stress) in starts.iter().zip(&compared.stresses) {
            assert_eq!(how.from_start(&pairs, start).unwrap().embedding.stress, stress);
            assert!(stress >= compared.best.embedding.stress);
        }
        assert_eq!(how.from_start(&pairs, &starts[compared.best_start]).unwrap(), compared.best);
        assert!(compared.stresses.iter().any(|&stress| stress > 1.0001 * compared.best.embedding.stress));
    }

    #[test]
    fn no_start_and_starts_that_do_not_fit_are_refused() {
        let how = Smacof { stop: StopRule { max_iterations: 1, tolerance: 0.0 }, ..Smacof::default() };
        let error = how.from_starts(&square(1.0), &[]).unwrap_err();
        assert_eq!(
            error.to_string(),
            "start configuration: none is given - 0 points for 4 objects; give one finite point an object"
        );
        let short = how.from_starts(&square(1.0), &[vec![[0.0; 2]; 4], vec![[0.0; 2]; 3]]);
        assert!(matches!(short, Err(EmbedError::BadStart { found: 3, wanted: 4, .. })));
    }
}
