//! Compares the probabilities of turns with how often the turns are right.
//!
//! ```text
//! cargo run --release -p covimap-plan --example calibration -- DIR...
//! ```
//!
//! Every folder holds a simulated run: `observations.jsonl` and `truth.csv`. Each log is mapped; then triples of
//! near landmarks, and any triples of a component, are put into classes by the probability that the map gives
//! for their turn, and the share of right ones is printed beside the mean probability of the class.

use std::collections::HashMap;
use std::error::Error;
use std::path::Path;
use std::sync::Arc;

use covimap_map::{LandmarkId, Mapper, MapperParams, SightingLog, Silent, Truth};
use covimap_plan::{MapIndex, Turn};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// Upper ends of the classes.
const CLASSES: [f64; 7] = [0.6, 0.75, 0.9, 0.97, 0.99, 0.999, 1.0];
const TRIPLES: usize = 50_000;

#[derive(Default, Clone, Copy)]
struct Class {
    triples: usize,
    right: usize,
    probability: f64,
}

fn main() -> Result<(), Box<dyn Error>> {
    let mut tables = [("near", [Class::default(); 7]), ("any", [Class::default(); 7])];
    for folder in std::env::args().skip(1) {
        let folder = Path::new(&folder);
        let log = SightingLog::read(&[folder.join("observations.jsonl")], None, &Silent)?;
        let map = Mapper::new(MapperParams::default())?.build(&log, &Silent)?;
        let truth = Truth::read(&folder.join("truth.csv"))?;
        let index = MapIndex::new(Arc::new(map));
        for (near, (_, table)) in [true, false].into_iter().zip(&mut tables) {
            let mut found = turns(&index, &truth, near)?;
            // The map may be a mirror image.
            if found.iter().filter(|(right, _)| *right).count() * 2 < found.len() {
                found.iter_mut().for_each(|(right, _)| *right = !*right);
            }
            let wrong = found.iter().filter(|(right, _)| !right).count() as f64 / found.len() as f64;
            let told = found.iter().map(|(_, p)| 1.0 - p).sum::<f64>() / found.len() as f64;
            println!(
                "{} {}: wrong {wrong:.4}, told {told:.4}",
                folder.display(),
                if near { "near" } else { "any" }
            );
            for (right, probability) in found {
                let class = &mut table[CLASSES.iter().position(|&end| probability <= end).unwrap_or(6)];
                class.triples += 1;
                class.right += usize::from(right);
                class.probability += probability;
            }
        }
    }
    for (name, table) in tables {
        println!("\n{name} triples\n  told   right  triples");
        for class in table.iter().filter(|class| class.triples > 0) {
            let share = |sum: f64| sum / class.triples as f64;
            println!(
                "{:.4}  {:.4}  {:>7}",
                share(class.probability),
                share(class.right as f64),
                class.triples
            );
        }
    }
    Ok(())
}

/// Whether the turns of random triples are right, and how likely the map says that is.
fn turns(index: &MapIndex, truth: &Truth, near: bool) -> Result<Vec<(bool, f64)>, Box<dyn Error>> {
    let places: HashMap<&str, [f64; 2]> =
        truth.names().iter().zip(truth.positions().iter().copied()).collect();
    let members = index.component(0)?;
    let mut random = ChaCha8Rng::seed_from_u64(3);
    let mut found = Vec::with_capacity(TRIPLES);
    while found.len() < TRIPLES {
        let a = members[random.random_range(0..members.len())];
        let pool: Vec<LandmarkId> = if near {
            index.nearest(a, 8)?.iter().map(|near| near.landmark).collect()
        } else {
            members.to_vec()
        };
        let [b, c] = [0, 1].map(|_| pool[random.random_range(0..pool.len())]);
        if a == b || b == c || a == c {
            continue;
        }
        let told = index.orientation(a, b, c)?;
        let [a, b, c] = [a, b, c].map(|id| places[index.name(id)]);
        let left = (b[0] - a[0]) * (c[1] - a[1]) > (b[1] - a[1]) * (c[0] - a[0]);
        found.push((left == (told.orientation == Turn::Left), told.probability));
    }
    Ok(found)
}
