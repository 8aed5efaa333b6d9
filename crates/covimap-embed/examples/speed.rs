//! One measurement at a time, for `benches/against_scikit_learn.py`.
//!
//! ```sh
//! speed complete FILE STRESS REPEATS
//! speed neighbours plain|relaxed|quasi-newton REPEATS
//! speed isotonic REPEATS
//! ```
//!
//! `complete` scales the problem in FILE until its stress is at most STRESS: a line with
//! the coordinates of each object, from which all distances follow, and the two of its start.
//! Each prints what it did and the least wall-clock time of the repeats in seconds. None at all
//! leaves the preparation, whose cost a caller can take off that of the whole process.

use std::time::Instant;

use covimap_embed::{Pair, PairDistances, Point, Smacof, Steps, StopRule, isotonic_regression};

#[path = "../benches/problems/mod.rs"]
mod problems;

type Outcome = Result<(), Box<dyn std::error::Error>>;

fn main() -> Outcome {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match arguments[..] {
        ["complete", file, stress, repeats] => complete(file, stress.parse()?, repeats.parse()?),
        ["neighbours", steps, repeats] => neighbours(steps, repeats.parse()?),
        ["isotonic", repeats] => isotonic(repeats.parse()?),
        _ => Err("the head of this example says how it is called".into()),
    }
}

/// The least time of some runs.
fn least_time(repeats: usize, mut run: impl FnMut()) -> f64 {
    let time = |_| {
        let from = Instant::now();
        run();
        from.elapsed().as_secs_f64()
    };
    (0..repeats).map(time).fold(f64::INFINITY, f64::min)
}

fn complete(file: &str, stress: f64, repeats: usize) -> Outcome {
    let (pairs, start) = read(file)?;
    let whole = Smacof { stop: StopRule { max_iterations: 100_000, tolerance: 1e-13 }, ..Smacof::default() };
    let trace = whole.from_start(&pairs, &start)?.trace;
    let reached = trace.iter().position(|&reached| reached <= stress).ok_or("another minimum was found")?;
    // Every run ends with a plain step, which does not raise the stress.
    let steps = reached + 1;
    let how = Smacof { stop: StopRule { max_iterations: steps, tolerance: 0.0 }, ..Smacof::default() };
    let seconds = least_time(repeats, || {
        let found = how.from_start(&pairs, &start).expect("a start that fits").embedding.stress;
        assert!(found <= stress, "{found} {stress}");
    });
    println!("{steps} {seconds}");
    Ok(())
}

fn read(file: &str) -> Result<(PairDistances, Vec<Point>), Box<dyn std::error::Error>> {
    let mut objects = Vec::new();
    let mut start = Vec::new();
    for line in std::fs::read_to_string(file)?.lines() {
        let mut numbers = line.split_whitespace().map(str::parse).collect::<Result<Vec<f64>, _>>()?;
        let (Some(y), Some(x)) = (numbers.pop(), numbers.pop()) else { return Err("a short line".into()) };
        objects.push(numbers);
        start.push([x, y]);
    }
    let distance = |i: usize, j: usize| {
        let difference = objects[i].iter().zip(&objects[j]).map(|(a, b)| (a - b).powi(2));
        difference.sum::<f64>().sqrt()
    };
    let ends = (0..objects.len()).flat_map(|i| (i + 1..objects.len()).map(move |j| (i, j)));
    let pair = |(i, j)| Pair { i: i as u32, j: j as u32, distance: distance(i, j), weight: 1.0 };
    Ok((PairDistances::new(objects.len(), ends.map(pair).collect())?, start))
}

fn neighbours(steps: &str, repeats: usize) -> Outcome {
    let (pairs, start) = problems::neighbours();
    let steps = match steps {
        "plain" => Steps::Plain,
        "relaxed" => Steps::Relaxed,
        "quasi-newton" => Steps::QuasiNewton,
        _ => return Err("steps are plain, relaxed or quasi-newton".into()),
    };
    let stop = StopRule { max_iterations: 100, tolerance: 0.0 };
    let how = Smacof { steps, stop, ..Smacof::default() };
    let mut stress1 = 0.0;
    let seconds = least_time(repeats, || {
        stress1 = how.from_start(&pairs, &start).expect("a start that fits").embedding.stress1;
    });
    println!("{stress1:.6} {seconds}");
    Ok(())
}

fn isotonic(repeats: usize) -> Outcome {
    let values = problems::rising();
    let weights = vec![1.0; values.len()];
    let mut fitted = Vec::new();
    let seconds = least_time(repeats, || fitted = isotonic_regression(&values, &weights).expect("numbers"));
    println!("{} {seconds}", fitted.chunk_by(|a, b| a == b).count());
    Ok(())
}
