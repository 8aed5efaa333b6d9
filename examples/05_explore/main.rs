//! A robot that explores by what it has seen, against one that wanders, at equal steps.
//!
//! `cargo run --release --example 05_explore -- [WORLD LANDMARKS SEEDS]`; the worlds are those of `covimap simulate`, and
//! `room`, the room of the paper.
//!
//! Both robots start at the same places in the same worlds. Landmarks not seen yet count as guessed: a triangle with one of
//! them is wrong by half.

mod closed_loop;

use std::error::Error;

use closed_loop::{explored, map_of};
use covimap::Truth;
use covimap::evaluate::{self, EvaluateParams};
use covimap::plan::{ExploreParams, MapIndex, forecast};
use covimap_sim::{Floor, Motion, SimSpec, Simulation, World};

/// Steps after which the robots are compared.
const STEPS: [usize; 3] = [100, 300, 1000];
/// Those of an explorer that makes do with a quarter less.
const FEWER: [usize; 3] = [75, 225, 750];

fn main() -> Result<(), Box<dyn Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let text = |k: usize, default: &str| args.get(k).map_or(default, String::as_str).to_owned();
    let (world, landmarks, seeds) =
        (text(0, "office"), text(1, "400").parse()?, text(2, "2").parse::<u64>()?);
    let mut spec = match world.as_str() {
        "room" => SimSpec::paper_room(landmarks, 1.5, 1000),
        floor => SimSpec::large(floor.parse::<Floor>()?, landmarks, 40),
    };
    spec.run.motion = Motion::Wander {};
    spec.run.steps = *STEPS.last().expect("three (bug in covimap)") as u64;
    let runs = (1..=seeds).map(|seed| Run::new(&spec, seed)).collect::<Result<Vec<_>, _>>()?;

    println!("{world} of {landmarks}, {seeds} seeds: mean ± standard error");
    println!("steps  robot                 seen  triangles  near triangles  Delaunay edges");
    for (k, steps) in STEPS.into_iter().enumerate() {
        let row = |name: String, errors: &dyn Fn(&Run) -> Errors| {
            let column = |of: fn(&Errors) -> f64| Mean::of(runs.iter().map(|run| of(&errors(run))));
            println!(
                "{steps:5}  {name:20} {:5.0}  {}  {}  {}",
                column(|e| e.seen).mean,
                column(|e| e.triangles).text(),
                column(|e| e.near).text(),
                column(|e| e.edges).text()
            );
        };
        row("wanders".to_owned(), &|run| run.wanderer[k]);
        row("explores".to_owned(), &|run| run.explorer[k]);
        row(format!("explores, {} steps", FEWER[k]), &|run| run.thrifty[k]);
        row("  less than wandering".to_owned(), &|run| run.wanderer[k].less(&run.explorer[k]));
        row("  with fewer steps".to_owned(), &|run| run.wanderer[k].less(&run.thrifty[k]));
        let told = Mean::of(runs.iter().map(|run| run.explorer[k].told));
        println!("       near triangles that the explorer's map tells to be wrong: {}", told.text());
    }
    Ok(())
}

/// Both robots in one world.
struct Run {
    wanderer: [Errors; 3],
    explorer: [Errors; 3],
    thrifty: [Errors; 3],
}

impl Run {
    fn new(spec: &SimSpec, seed: u64) -> Result<Self, Box<dyn Error>> {
        let world = World::new(&spec.world, seed)?;
        let names = world.names();
        let ids: Vec<&str> = names.iter().collect();
        let mut truth = Vec::new();
        covimap_sim::write_truth(&world, &mut truth)?;
        let truth = Truth::parse(&truth, "truth")?;
        let walk = Simulation::new(&world, &spec.run, seed)?.record();
        let walk: Vec<Vec<u32>> = walk.steps().map(|step| step.seen.to_vec()).collect();
        let tour = explored(&world, &spec.run, walk.len(), seed)?;
        let after =
            |log: &[Vec<u32>], steps: [usize; 3]| steps.map(|steps| Errors::of(&log[..steps], &ids, &truth));
        Ok(Self {
            wanderer: after(&walk, STEPS),
            explorer: after(&tour, STEPS),
            thrifty: after(&tour, FEWER),
        })
    }
}

/// What is wrong with a map.
#[derive(Clone, Copy)]
struct Errors {
    seen: f64,
    /// Triangles that turn the wrong way, of all in the world.
    triangles: f64,
    /// Those of near landmarks, of all on the map.
    near: f64,
    /// Delaunay edges that differ, of all on the map.
    edges: f64,
    /// Near triangles that the map tells to be wrong.
    told: f64,
}

impl Errors {
    fn of(log: &[Vec<u32>], ids: &[&str], truth: &Truth) -> Self {
        let guessed = Self { seen: 0.0, triangles: 0.5, near: 0.5, edges: 1.0, told: 0.5 };
        let Some(map) = map_of(log, ids) else { return guessed };
        let Ok(found) = evaluate::against(&map, truth, &EvaluateParams::default()) else { return guessed };
        let count = |n: usize| (n * n.saturating_sub(1) * n.saturating_sub(2)) as f64;
        let known = count(found.n) / count(ids.len());
        let told =
            forecast(&MapIndex::new(map.into()), ExploreParams::default()).map_or(0.5, |told| told.error);
        Self {
            seen: found.n as f64,
            triangles: known * found.orientation_error.unwrap_or(0.5) + 0.5 * (1.0 - known),
            near: found.local_orientation_error.unwrap_or(0.5),
            edges: found.delaunay_error,
            told,
        }
    }

    fn less(&self, other: &Self) -> Self {
        Self {
            seen: other.seen - self.seen,
            triangles: other.triangles - self.triangles,
            near: other.near - self.near,
            edges: other.edges - self.edges,
            told: other.told - self.told,
        }
    }
}

/// A mean and its standard error.
struct Mean {
    mean: f64,
    error: f64,
}

impl Mean {
    fn of(values: impl Iterator<Item = f64>) -> Self {
        let values: Vec<f64> = values.collect();
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
        Self { mean, error: (squares / (n * (n - 1.0).max(1.0))).sqrt() }
    }

    fn text(&self) -> String {
        format!("{:8.4} ± {:.4}", self.mean, self.error)
    }
}
