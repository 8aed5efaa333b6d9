//! Writes a log and its truth: `world WORLD --landmarks N --steps-per-landmark K --seed S -o DIR`.

use std::error::Error;
use std::fs::{self, File};
use std::io::BufWriter;
use std::path::PathBuf;
use std::time::Instant;

use covimap_sim::{Floor, LogWriter, RunSpec, Simulation, World, WorldSpec, write_truth};

struct Arguments {
    floor: Floor,
    landmarks: usize,
    steps_per_landmark: u64,
    seed: u64,
    folder: PathBuf,
}

fn arguments() -> Result<Arguments, Box<dyn Error>> {
    let mut words = std::env::args().skip(1);
    let name = words.next().ok_or("name a world first")?;
    let mut all = Arguments {
        floor: Floor::named(&name)?,
        landmarks: 800,
        steps_per_landmark: 40,
        seed: 1,
        folder: PathBuf::from(name),
    };
    while let Some(flag) = words.next() {
        let value = words.next().ok_or_else(|| format!("{flag} needs a value"))?;
        match flag.as_str() {
            "--landmarks" => all.landmarks = value.parse()?,
            "--steps-per-landmark" => all.steps_per_landmark = value.parse()?,
            "--seed" => all.seed = value.parse()?,
            "-o" => all.folder = PathBuf::from(value),
            _ => return Err(format!("unknown option {flag}").into()),
        }
    }
    Ok(all)
}

fn main() -> Result<(), Box<dyn Error>> {
    let Arguments { floor, landmarks, steps_per_landmark, seed, folder } = arguments()?;
    let started = Instant::now();
    let world = World::new(&WorldSpec::large(floor, landmarks), seed)?;
    fs::create_dir_all(&folder)?;
    write_truth(&world, BufWriter::new(File::create(folder.join("truth.csv"))?))?;
    let built = started.elapsed().as_secs_f64();
    let steps = steps_per_landmark * landmarks as u64;
    let mut simulation = Simulation::new(&world, &RunSpec::large(steps), seed)?;
    let log = BufWriter::with_capacity(1 << 16, File::create(folder.join("observations.jsonl"))?);
    let mut log = LogWriter::new(log, &world);
    let mut sightings = vec![0_u64; landmarks];
    while let Some(step) = simulation.next_step() {
        log.write(&step)?;
        for &number in step.seen {
            sightings[number as usize] += 1;
        }
    }
    log.finish()?;
    let seconds = started.elapsed().as_secs_f64();
    sightings.sort_unstable();
    let total: u64 = sightings.iter().sum();
    println!(
        "{}: {landmarks} landmarks, {steps} steps, {total} sightings, {:.2} a step; a landmark was seen {} / {} / {} \
         times (least, 5 %, median), {} never; world {built:.2} s, all {seconds:.2} s, {:.0} steps/s",
        floor.name(),
        total as f64 / steps as f64,
        sightings[0],
        sightings[landmarks / 20],
        sightings[landmarks / 2],
        sightings.iter().filter(|&&count| count == 0).count(),
        steps as f64 / seconds
    );
    Ok(())
}
