//! SMACOF, monotone regression and Procrustes against independent implementations; see
//! `golden/README.md` for how the expected values were made.

#![allow(clippy::unwrap_used, reason = "a panic is how a test fails")]

use std::path::{Path, PathBuf};

use covimap_embed::{
    Correspondence, DissimilarityOrder, Embedding, Pair, PairBounds, PairDistances, Point, ProcrustesOptions,
    Smacof, Steps, StopRule, Ties, Transformation, procrustes, random_starts, torgerson_start,
};

/// Ours may be above theirs by this share.
const SLACK: f64 = 1e-6;

fn golden(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/golden").join(path)
}

/// The rows of a table, without its header, as text.
fn rows(path: &str) -> Vec<Vec<String>> {
    let text = std::fs::read_to_string(golden(path)).unwrap();
    text.lines().skip(1).map(|line| line.split(',').map(str::to_owned).collect()).collect()
}

fn number(text: &str) -> f64 {
    text.parse().unwrap()
}

struct Problem {
    pairs: PairDistances,
    bounds: Option<PairBounds>,
    starts: Vec<Vec<Point>>,
}

fn problem(name: &str) -> Problem {
    let listed = rows(&format!("problems/{name}/pairs.csv"));
    let pair = |row: &Vec<String>| Pair {
        i: row[0].parse().unwrap(),
        j: row[1].parse().unwrap(),
        distance: number(&row[2]),
        weight: number(&row[3]),
    };
    let pairs: Vec<Pair> = listed.iter().map(pair).collect();
    let n = 1 + pairs.iter().map(|pair| pair.j as usize).max().unwrap();
    let bounds = (listed[0].len() > 4).then(|| {
        let column = |k: usize| listed.iter().map(|row| number(&row[k])).collect();
        PairBounds::new(column(4), column(5)).unwrap()
    });
    let mut starts: Vec<Vec<Point>> = Vec::new();
    for row in rows(&format!("problems/{name}/starts.csv")) {
        let start: usize = row[0].parse().unwrap();
        starts.resize_with(starts.len().max(start + 1), Vec::new);
        starts[start].push([number(&row[2]), number(&row[3])]);
    }
    Problem { pairs: PairDistances::new(n, pairs).unwrap(), bounds, starts }
}

/// The stress that another program reports on a problem from each of its starts.
struct Rival {
    problem: String,
    /// Program and kind of scaling.
    method: String,
    stresses: Vec<f64>,
}

fn rivals() -> Vec<Rival> {
    let tables =
        ["scikit-learn", "R", "scipy"].map(|program| rows(&format!("expected/{program}.csv"))).concat();
    let by_method = tables.chunk_by(|a, b| a[..2] == b[..2]).map(|rows| Rival {
        problem: rows[0][0].clone(),
        method: rows[0][1].clone(),
        stresses: rows.iter().map(|row| number(&row[3])).collect(),
    });
    // On this problem monoMDS takes a line that makes some disparities negative.
    by_method
        .filter(|rival| (rival.problem.as_str(), rival.method.as_str()) != ("offset", "monoMDS interval"))
        .collect()
}

impl Rival {
    /// What the method does, in our words.
    fn transformation(&self, problem: &Problem) -> Transformation {
        match self.method.as_str() {
            "scikit-learn metric" => Transformation::Ratio,
            "scikit-learn nonmetric" | "monoMDS secondary" => Transformation::Ordinal(Ties::Secondary),
            "isoMDS primary" | "monoMDS primary" => Transformation::Ordinal(Ties::Primary),
            "monoMDS interval" => Transformation::Interval,
            "scipy BFGS" => problem.bounds.clone().map_or(Transformation::Ratio, Transformation::Bounds),
            other => panic!("no transformation is known for {other}"),
        }
    }

    /// The kind of stress that the method reports.
    fn measure(&self, embedding: &Embedding) -> f64 {
        match self.method.as_str() {
            "scikit-learn metric" | "scipy BFGS" => embedding.stress,
            "scikit-learn nonmetric" => embedding.stress1,
            _ => embedding.normalised_stress.sqrt(),
        }
    }
}

/// Ways to run from one start: the one by default, then those that may lead to other minima.
fn ways(transformation: &Transformation) -> Vec<Smacof> {
    let stop = StopRule { max_iterations: 100_000, tolerance: 1e-14 };
    let way = |(steps, warm)| {
        let transformation = transformation.clone();
        Smacof { transformation, steps, warm, relocations: 30, stop }
    };
    let kinds = [Steps::QuasiNewton, Steps::Relaxed, Steps::Plain];
    kinds.into_iter().flat_map(|steps| [(steps, false), (steps, true)]).map(way).collect()
}

#[test]
fn no_stress_is_above_theirs_from_the_same_start() {
    // Starts from which the first way ends in a poorer minimum than theirs, and another does not.
    let known = [
        ("five_dimensions", "scikit-learn nonmetric", 3),
        ("five_dimensions", "isoMDS primary", 8),
        ("five_dimensions", "monoMDS interval", 9),
        ("marks", "monoMDS interval", 4),
    ];
    println!("| problem | method | ours below | alike | ours above, first way | largest excess |");
    let mut compared = 0;
    for rival in rivals() {
        let problem = problem(&rival.problem);
        let ways = ways(&rival.transformation(&problem));
        let mut count = [0; 3];
        let mut excess = f64::NEG_INFINITY;
        for (start, (points, theirs)) in problem.starts.iter().zip(&rival.stresses).enumerate() {
            let ratio = |way: &Smacof| {
                let ours = rival.measure(&way.from_start(&problem.pairs, points).unwrap().embedding);
                ours / theirs - 1.0
            };
            let first = ratio(&ways[0]);
            count[usize::from(first > -SLACK) + usize::from(first > SLACK)] += 1;
            let least =
                ways[1..].iter().fold(first, |best, way| if best > SLACK { ratio(way) } else { best });
            excess = excess.max(least);
            let case = (rival.problem.as_str(), rival.method.as_str(), start);
            assert!(least <= SLACK, "{case:?}: {least} above");
            assert_eq!(first > SLACK, known.contains(&case), "{case:?}: {first} above");
            compared += 1;
        }
        let [below, alike, above] = count;
        println!("| {} | {} | {below} | {alike} | {above} | {excess:.0e} |", rival.problem, rival.method);
    }
    // Six complete problems by six methods, less one, and two others: 37 times 11 starts.
    assert_eq!(compared, 37 * 11);
}

#[test]
fn our_best_of_ten_starts_is_not_above_theirs() {
    let stop = StopRule { max_iterations: 100_000, tolerance: 1e-14 };
    for rival in rivals() {
        let problem = problem(&rival.problem);
        let pairs = &problem.pairs;
        let how = Smacof {
            transformation: rival.transformation(&problem),
            relocations: 5,
            stop,
            ..Smacof::default()
        };
        let mut starts = random_starts(pairs, 9, 1);
        starts.push(torgerson_start(pairs).unwrap());
        let ours = rival.measure(&how.from_starts(pairs, &starts).unwrap().best.embedding);
        let theirs = rival.stresses.iter().copied().fold(f64::INFINITY, f64::min);
        assert!(ours <= theirs * (1.0 + SLACK), "{} {}: {ours} {theirs}", rival.problem, rival.method);
    }
}

#[test]
fn plain_steps_are_those_of_scikit_learn() {
    let metric: Vec<_> =
        rows("expected/scikit-learn.csv").into_iter().filter(|row| row[1] == "scikit-learn metric").collect();
    assert_eq!(metric.len(), 6 * 11);
    for row in metric {
        let Problem { pairs, starts, .. } = problem(&row[0]);
        let stop = StopRule { max_iterations: row[5].parse().unwrap(), tolerance: 0.0 };
        let how = Smacof { steps: Steps::Plain, stop, ..Smacof::default() };
        let start: usize = row[2].parse().unwrap();
        let ours = how.from_start(&pairs, &starts[start]).unwrap().embedding;
        assert!((ours.stress / number(&row[3]) - 1.0).abs() < 1e-9, "{row:?}: {}", ours.stress);
        assert!((ours.stress1 / number(&row[4]) - 1.0).abs() < 1e-9, "{row:?}: {}", ours.stress1);
    }
}

#[test]
fn monotone_regression_is_that_of_scikit_learn() {
    let table = rows("expected/isotonic.csv");
    let cases: Vec<_> = table.chunk_by(|a, b| a[0] == b[0]).collect();
    assert_eq!(cases.len(), 5);
    for case in cases {
        let column = |k: usize| case.iter().map(|row| number(&row[k])).collect::<Vec<f64>>();
        let order = DissimilarityOrder::new(&column(1)).unwrap();
        let ours = order.disparities(&column(2), &column(3), Ties::Secondary).unwrap();
        for (ours, theirs) in ours.iter().zip(column(4)) {
            assert!((ours - theirs).abs() < 1e-12, "{ours} {theirs}");
        }
    }
}

#[test]
fn procrustes_is_that_of_scipy() {
    let table = rows("expected/procrustes.csv");
    let cases: Vec<_> = table.chunk_by(|a, b| a[0] == b[0]).collect();
    assert_eq!(cases.len(), 4);
    for case in cases {
        let point = |row: &[String], k: usize| [number(&row[k]), number(&row[k + 1])];
        let pair =
            |row: &Vec<String>| Correspondence { source: point(row, 1), target: point(row, 3), weight: 1.0 };
        let pairs: Vec<Correspondence> = case.iter().map(pair).collect();
        let fit = procrustes(&pairs, ProcrustesOptions::default()).unwrap();
        // Theirs is the residual sum of squares over that of the centred target.
        let n = pairs.len() as f64;
        let centre = [0, 1].map(|axis| pairs.iter().map(|pair| pair.target[axis]).sum::<f64>() / n);
        let spread: f64 = pairs
            .iter()
            .map(|pair| (0..2).map(|axis| (pair.target[axis] - centre[axis]).powi(2)).sum::<f64>())
            .sum();
        let ours = n * fit.rmse.powi(2) / spread;
        let theirs = number(&case[0][5]);
        assert!((ours - theirs).abs() < 1e-12 + 1e-9 * theirs, "{ours} {theirs}");
    }
}
