//! A garden measured by tape and by paces: weights, missing pairs and bounds.
//!
//! `cargo run --release -p covimap-embed --example weighted`
//!
//! Pairs near each other were taped (3 cm off), farther ones paced (60 cm off), and of some only
//! so much is known that they are out of sight of each other, at least 5 m. A distance counts by
//! the inverse of its variance.

use covimap_embed::{
    Correspondence, EmbedError, Pair, PairBounds, PairDistances, Point, ProcrustesOptions, Smacof,
    Transformation, procrustes, torgerson_start,
};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

const TAPE: f64 = 0.03;
const PACES: f64 = 0.6;
const SIGHT: f64 = 5.0;

/// What is known of one pair: an estimate, its standard error, and bounds.
struct Known {
    pair: (u32, u32),
    estimate: f64,
    error: f64,
    bounds: [f64; 2],
}

fn measure(garden: &[Point]) -> Vec<Known> {
    let mut rng = ChaCha8Rng::seed_from_u64(7);
    let ends = (0..garden.len()).flat_map(|i| (i + 1..garden.len()).map(move |j| (i, j)));
    ends.map(|(i, j)| {
        let true_distance = (garden[i][0] - garden[j][0]).hypot(garden[i][1] - garden[j][1]);
        let pair = (i as u32, j as u32);
        if true_distance > SIGHT {
            let bounds = [SIGHT, f64::INFINITY];
            return Known { pair, estimate: SIGHT, error: PACES, bounds };
        }
        let error = if true_distance < 3.6 { TAPE } else { PACES };
        // Three uniform numbers: near enough to a normal one of variance 1.
        let noise = (0..3).map(|_| rng.random_range(-1.0..1.0)).sum::<f64>();
        let estimate = true_distance + error * noise;
        Known { pair, estimate, error, bounds: [estimate; 2] }
    })
    .collect()
}

fn list(known: &[&Known], weight: fn(&Known) -> f64, objects: usize) -> Result<PairDistances, EmbedError> {
    let pair = |known: &&Known| {
        let (i, j) = known.pair;
        Pair { i, j, distance: known.estimate, weight: weight(known) }
    };
    PairDistances::new(objects, known.iter().map(pair).collect())
}

/// Root mean square error in metres after the best turn and shift.
fn error_of(
    name: &str,
    known: &[&Known],
    weight: fn(&Known) -> f64,
    start: &[Point],
    garden: &[Point],
) -> Result<(), EmbedError> {
    let pairs = list(known, weight, garden.len())?;
    let bound = |end: usize| known.iter().map(|known| known.bounds[end]).collect();
    let transformation = Transformation::Bounds(PairBounds::new(bound(0), bound(1))?);
    let how = Smacof { transformation, ..Smacof::default() };
    let points = how.from_start(&pairs, start)?.embedding.points;
    let both = points.iter().zip(garden);
    let both: Vec<_> =
        both.map(|(&source, &target)| Correspondence { source, target, weight: 1.0 }).collect();
    let fit = procrustes(&both, ProcrustesOptions { scale: false, ..ProcrustesOptions::default() })?;
    println!("{name:<36}{:>6.3} m", fit.rmse);
    Ok(())
}

fn main() -> Result<(), EmbedError> {
    let garden: Vec<Point> = vec![
        [0.0, 0.0],
        [2.5, 0.5],
        [5.0, 0.0],
        [8.0, 1.0],
        [11.0, 0.5],
        [0.5, 3.0],
        [3.0, 3.5],
        [6.5, 3.0],
        [9.5, 4.0],
        [1.0, 6.5],
        [4.5, 6.0],
        [7.5, 7.0],
        [11.0, 6.5],
    ];
    let known = measure(&garden);
    let all: Vec<&Known> = known.iter().collect();
    let measured: Vec<&Known> = known.iter().filter(|known| known.bounds[1].is_finite()).collect();
    // A bound is no distance: the start must not take it for one.
    let start = torgerson_start(&list(&measured, |_| 1.0, garden.len())?)?;
    let inverse_variance = |known: &Known| known.error.powi(-2);
    println!("{:<36}root mean square error", "");
    error_of("measured pairs, equal weights", &measured, |_| 1.0, &start, &garden)?;
    error_of("measured pairs, weights", &measured, inverse_variance, &start, &garden)?;
    error_of("weights, and bounds of the others", &all, inverse_variance, &start, &garden)
}
