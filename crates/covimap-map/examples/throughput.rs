//! Measures the reader and the counting.
//!
//! ```text
//! cargo run --release -p covimap-map --example throughput -- local 10000 10000000
//! ```
//!
//! writes a log of that many sightings of that many landmarks, ten a step, to a temporary file,
//! reads it and counts it. `local`: the landmarks of a step are among 60 neighbours, and the next
//! step is close by; `random`: they are any. `RAYON_NUM_THREADS` sets the number of threads.

use std::error::Error;
use std::io;
use std::time::Instant;

use covimap_map::{CoVisibility, JsonlWriter, SightingLog, Silent};
use rand::{RngExt, SeedableRng};

const STEP: usize = 10;
const NEIGHBOURS: u32 = 60;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [kind, landmarks, sightings] = &arguments[..] else {
        return Err("usage: throughput local|random LANDMARKS SIGHTINGS".into());
    };
    let file = tempfile::Builder::new().suffix(".jsonl").tempfile()?;
    write(&file, kind == "local", landmarks.parse()?, sightings.parse()?)?;
    let megabytes = file.as_file().metadata()?.len() as f64 / 1e6;

    let start = Instant::now();
    let log = SightingLog::read(&[file.path()], None, &Silent)?;
    let seconds = start.elapsed().as_secs_f64();
    let rate = megabytes / seconds;
    println!("read    {:>10} sightings in {seconds:6.2} s, {rate:.0} MB/s{}", log.sightings(), peak());

    let start = Instant::now();
    let counts = CoVisibility::count(&log, &Silent)?;
    let seconds = start.elapsed().as_secs_f64();
    println!("counted {:>10} pairs     in {seconds:6.2} s{}", counts.pair_count(), peak());
    Ok(())
}

fn write(file: impl io::Write, local: bool, landmarks: u32, sightings: usize) -> io::Result<()> {
    let mut random = rand_chacha::ChaCha8Rng::seed_from_u64(1);
    let mut place = 0;
    let mut log = JsonlWriter::new(file);
    for t in 0..sightings / STEP {
        let step: Vec<u32> = if local {
            place += random.random_range(0..3);
            (0..STEP).map(|_| (place + random.random_range(0..NEIGHBOURS)) % landmarks).collect()
        } else {
            (0..STEP).map(|_| random.random_range(0..landmarks)).collect()
        };
        log.step(Some(t as f64), step.iter().map(|landmark| format!("L{landmark:06}")))?;
    }
    log.finish()?;
    Ok(())
}

/// Most memory the process ever had, where the system tells.
fn peak() -> String {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    line.map_or(String::new(), |line| format!(", peak memory {}", line.trim()))
}
