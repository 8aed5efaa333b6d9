//! A map of Europe from a table of road distances.
//!
//! `cargo run --release -p covimap-embed --example cities`

use covimap_embed::{Pair, PairDistances, Smacof, StopRule, torgerson_start};

/// Road distances between 21 cities in kilometres; see `tests/golden/README.md` for the source.
const ROADS: &str = include_str!("../tests/golden/problems/eurodist/pairs.csv");
const NAMES: &str = include_str!("../tests/golden/problems/eurodist/names.txt");

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let names: Vec<&str> = NAMES.lines().collect();
    let mut pairs = Vec::new();
    for line in ROADS.lines().skip(1) {
        let fields: Vec<&str> = line.split(',').collect();
        let (i, j) = (fields[0].parse()?, fields[1].parse()?);
        pairs.push(Pair { i, j, distance: fields[2].parse()?, weight: 1.0 });
    }
    let pairs = PairDistances::new(names.len(), pairs)?;

    let how = Smacof { stop: StopRule { max_iterations: 1000, tolerance: 1e-12 }, ..Smacof::default() };
    let scaling = how.from_start(&pairs, &torgerson_start(&pairs)?)?;
    let embedding = &scaling.embedding;
    println!(
        "stress-1 {:.4} after {} steps, {:?}",
        embedding.stress1, embedding.iterations, embedding.termination
    );

    println!("\n{:<16}{:>9}{:>9}{:>12}", "", "x / km", "y / km", "misfit / %");
    let misfit = scaling.stress_per_point(&pairs);
    for ((name, [x, y]), misfit) in names.iter().zip(&embedding.points).zip(&misfit) {
        println!("{name:<16}{x:>9.0}{y:>9.0}{:>12.1}", 100.0 * misfit / embedding.stress);
    }

    // Where the table and any map disagree most: ferries that it takes for roads, and likely misprints.
    let mut diagram = scaling.shepard(&pairs);
    diagram.sort_by(|a, b| (b.distance - b.disparity).abs().total_cmp(&(a.distance - a.disparity).abs()));
    println!("\nworst pairs: road and map / km");
    for pair in &diagram[..5] {
        let ends = format!("{} - {}", names[pair.i as usize], names[pair.j as usize]);
        println!("{ends:<28}{:>6.0}{:>6.0}", pair.disparity, pair.distance);
    }
    Ok(())
}
