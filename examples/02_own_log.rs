//! A log made by the program itself, built while somebody watches, drawn as a picture.
//!
//! `cargo run --release --example 02_own_log`

use covimap::export::{self, SvgParams};
use covimap::{Mapper, MapperParams, Observer, SightingLog, Stage};

/// Says which stage begins.
struct Watcher;

impl Observer for Watcher {
    fn started(&self, stage: Stage, _total: Option<u64>) {
        eprintln!("{stage:?} ...");
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // A robot drives along the squares of a board and sees the squares around it.
    let mut steps = Vec::new();
    for row in 0..12_i32 {
        for column in 0..12_i32 {
            let around = (-1..=1).flat_map(|down| (-1..=1).map(move |right| (row + down, column + right)));
            let on_board = around.filter(|(r, c)| (0..12).contains(r) && (0..12).contains(c));
            steps.push(on_board.map(|(r, c)| format!("{r}-{c}")).collect::<Vec<_>>());
        }
    }
    let log = SightingLog::from_steps(steps);
    let map = Mapper::new(MapperParams::default())?.build(&log, &Watcher)?;
    println!("{} landmarks, stress-1 {:.3}", map.len(), map.report().stress1);

    let path = std::env::temp_dir().join("board.svg");
    let picture = export::svg(&map, &SvgParams::default())?;
    covimap::output::write_whole(&path, |out| out.write_all(picture.as_bytes()))?;
    println!("drawn as {}", path.display());
    Ok(())
}
