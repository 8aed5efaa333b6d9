//! How long scaling takes.
//!
//! `cargo bench -p covimap-embed` measures; `scikit_learn.py` beside this file compares with
//! scikit-learn in one run.

use std::hint::black_box;

use covimap_embed::{
    DissimilarityOrder, Pair, PairDistances, Point, Smacof, StopRule, Ties, Transformation,
    isotonic_regression, procrustes, random_starts, torgerson_start,
};
use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use rand::seq::SliceRandom;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

fn steps(max_iterations: usize) -> StopRule {
    StopRule { max_iterations, tolerance: 0.0 }
}

/// All distances of `n` points of a cube, which fit no plane.
fn complete(n: u32, weighted: bool) -> PairDistances {
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    let points: Vec<[f64; 3]> = (0..n).map(|_| [rng.random(), rng.random(), rng.random()]).collect();
    let pair = |(i, j): (u32, u32)| {
        let (a, b) = (points[i as usize], points[j as usize]);
        let distance = (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f64>().sqrt();
        Pair { i, j, distance, weight: if weighted { 1.0 / distance } else { 1.0 } }
    };
    let pairs = (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j))).map(pair).collect();
    PairDistances::new(n as usize, pairs).expect("distances of points (bug in covimap)")
}

/// 100 000 objects on a shaken lattice, numbered at random, each with ten neighbours, and a start near
/// the truth.
fn neighbours() -> (PairDistances, Vec<Point>) {
    const WIDTH: i32 = 400;
    const HEIGHT: i32 = 250;
    let mut rng = ChaCha8Rng::seed_from_u64(2);
    let mut number: Vec<u32> = (0..(WIDTH * HEIGHT) as u32).collect();
    number.shuffle(&mut rng);
    let mut truth = vec![[0.0; 2]; number.len()];
    for (place, &object) in number.iter().enumerate() {
        let (x, y) = (place as i32 % WIDTH, place as i32 / WIDTH);
        truth[object as usize] = [x, y].map(|k| f64::from(k) + rng.random_range(-0.3..0.3));
    }
    let mut pairs = Vec::new();
    for (x, y) in (0..HEIGHT).flat_map(|y| (0..WIDTH).map(move |x| (x, y))) {
        for (dx, dy) in [(1, 0), (2, 0), (-1, 1), (0, 1), (1, 1)] {
            let (u, v) = (x + dx, y + dy);
            if (0..WIDTH).contains(&u) && v < HEIGHT {
                let [a, b] = [(x, y), (u, v)].map(|(x, y)| number[(y * WIDTH + x) as usize]);
                let [p, q] = [a, b].map(|object| truth[object as usize]);
                let distance = (p[0] - q[0]).hypot(p[1] - q[1]) * rng.random_range(0.9..1.1);
                pairs.push(Pair { i: a.min(b), j: a.max(b), distance, weight: 1.0 / distance });
            }
        }
    }
    pairs.sort_by_key(|pair| (pair.i, pair.j));
    let start = truth.iter().map(|p| p.map(|x| x + rng.random_range(-0.5..0.5))).collect();
    (PairDistances::new(number.len(), pairs).expect("a lattice (bug in covimap)"), start)
}

fn majorisation(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("100 steps");
    group.sample_size(10);
    for n in [300, 1000] {
        for (name, weighted, transformation) in [
            ("equal weights", false, Transformation::Ratio),
            ("weighted", true, Transformation::Ratio),
            ("interval", false, Transformation::Interval),
            ("ordinal", false, Transformation::Ordinal(Ties::Primary)),
        ] {
            let pairs = complete(n, weighted);
            let start = random_starts(&pairs, 1, 1).remove(0);
            let how = Smacof { transformation, stop: steps(100), ..Smacof::default() };
            group.bench_function(BenchmarkId::new(name, n), |bencher| {
                bencher.iter(|| how.from_start(black_box(&pairs), &start).expect("a start that fits"));
            });
        }
    }
    let (pairs, start) = neighbours();
    let how = Smacof { stop: steps(100), ..Smacof::default() };
    group.bench_function("ten neighbours/100000", |bencher| {
        bencher.iter(|| how.from_start(black_box(&pairs), &start).expect("a start that fits"));
    });
}

fn starts(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("torgerson start");
    group.sample_size(10);
    for n in [300, 1000] {
        let pairs = complete(n, false);
        group.bench_function(BenchmarkId::from_parameter(n), |bencher| {
            bencher.iter(|| torgerson_start(black_box(&pairs)).expect("a complete list"));
        });
    }
}

fn monotone_regression(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("monotone regression");
    group.sample_size(10);
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    let values: Vec<f64> = (0..10_000_000).map(|k| 1e-6 * f64::from(k) + rng.random::<f64>()).collect();
    let weights = vec![1.0; values.len()];
    group.bench_function("10000000 values", |bencher| {
        bencher.iter(|| isotonic_regression(black_box(&values), &weights).expect("numbers"));
    });
    let given: Vec<f64> = values[..500_000].iter().map(|value| (value * 1000.0).floor()).collect();
    let order = DissimilarityOrder::new(&given).expect("numbers");
    group.bench_function("500000 disparities", |bencher| {
        let fit = || order.disparities(black_box(&values[..500_000]), &weights[..500_000], Ties::Primary);
        bencher.iter(|| fit().expect("numbers"));
    });
}

fn fits(criterion: &mut Criterion) {
    let mut rng = ChaCha8Rng::seed_from_u64(4);
    let mut pair = || {
        let source: Point = [rng.random(), rng.random()];
        let target = [3.0 - 2.0 * source[1] + 0.1 * rng.random::<f64>(), 1.0 + 2.0 * source[0]];
        covimap_embed::Correspondence { source, target, weight: 1.0 }
    };
    let pairs: Vec<_> = (0..100_000).map(|_| pair()).collect();
    criterion.bench_function("procrustes/100000", |bencher| {
        bencher.iter(|| procrustes(black_box(&pairs), Default::default()).expect("points"));
    });
}

criterion_group!(scaling, majorisation, starts, monotone_regression, fits);
criterion_main!(scaling);
