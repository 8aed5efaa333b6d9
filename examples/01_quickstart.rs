//! A real robot log becomes a map, which is compared with the survey and saved.
//!
//! `cargo run --release --example 01_quickstart`

use std::path::Path;

use covimap::evaluate::{self, EvaluateParams};
use covimap::{Mapper, MapperParams, SightingLog, Silent, Truth};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("crates/covimap-cli/data");
    let log = SightingLog::read(&[data.join("mrclam-1.jsonl")], None, &Silent)?;
    let map = Mapper::new(MapperParams::default())?.build(&log, &Silent)?;
    for (id, landmark) in map.names().iter().zip(map.landmarks()) {
        let [x, y] = landmark.position;
        println!("{id:>4} {x:8.3} {y:8.3}, seen {} times", landmark.sightings);
    }

    let truth = Truth::read(&data.join("mrclam-1.truth.csv"))?;
    let found = evaluate::against(&map, &truth, &EvaluateParams::default())?;
    println!("{:.2} m off the survey after the best fit", found.rmse);

    let path = std::env::temp_dir().join("quickstart.map.json");
    map.save(&path)?;
    println!("saved as {}", path.display());
    Ok(())
}
