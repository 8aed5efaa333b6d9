//! How long scaling takes.
//!
//! `cargo bench -p covimap-embed` measures; `against_scikit_learn.py` beside this file compares with
//! scikit-learn in one run.

use std::hint::black_box;

use covimap_embed::{
    DissimilarityOrder, Point, Smacof, Steps, StopRule, Ties, Transformation, isotonic_regression,
    procrustes, random_starts, torgerson_start,
};
use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

mod problems;

use problems::{complete, neighbours, rising};

fn steps(max_iterations: usize) -> StopRule {
    StopRule { max_iterations, tolerance: 0.0 }
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
    for steps_taken in [Steps::Plain, Steps::Relaxed, Steps::QuasiNewton] {
        let how = Smacof { steps: steps_taken, stop: steps(100), ..Smacof::default() };
        group.bench_function(
            BenchmarkId::new("ten neighbours, 100000", format!("{steps_taken:?}")),
            |bencher| {
                bencher.iter(|| how.from_start(black_box(&pairs), &start).expect("a start that fits"));
            },
        );
    }
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
    let values = rising();
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
