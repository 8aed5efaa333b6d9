//! Writes a log and its truth: `world WORLD --landmarks N --steps-per-landmark K --seed S -o DIR`.

use std::error::Error;
use std::path::PathBuf;
use std::time::Instant;

use covimap_sim::{Floor, Motion, SimSpec, Simulation, World, write_files};

struct Arguments {
    spec: SimSpec,
    seed: u64,
    folder: PathBuf,
}

fn arguments() -> Result<Arguments, Box<dyn Error>> {
    let mut words = std::env::args().skip(1);
    let name = words.next().ok_or("name a world first")?;
    let floor: Floor = name.parse()?;
    let (mut landmarks, mut steps_per_landmark, mut seed) = (800, 40, 1);
    let (mut motion, mut folder) = (floor.motion(), PathBuf::from(name));
    while let Some(flag) = words.next() {
        let value = words.next().ok_or_else(|| format!("{flag} needs a value"))?;
        match flag.as_str() {
            "--landmarks" => landmarks = value.parse()?,
            "--steps-per-landmark" => steps_per_landmark = value.parse()?,
            "--motion" => motion = value.parse::<Motion>()?,
            "--seed" => seed = value.parse()?,
            "-o" => folder = PathBuf::from(value),
            _ => return Err(format!("unknown option {flag}").into()),
        }
    }
    let mut spec = SimSpec::large(floor, landmarks, steps_per_landmark);
    spec.run.motion = motion;
    Ok(Arguments { spec, seed, folder })
}

fn main() -> Result<(), Box<dyn Error>> {
    let Arguments { spec, seed, folder } = arguments()?;
    let started = Instant::now();
    let world = World::new(&spec.world, seed)?;
    let simulation = Simulation::new(&world, &spec.run, seed)?;
    let built = started.elapsed().as_secs_f64();
    let summary = write_files(&world, simulation, &folder, |steps| eprint!("\r{steps} steps"))?;
    let seconds = started.elapsed().as_secs_f64();
    println!("\r{summary:?}");
    println!(
        "ready after {built:.2} s, done after {seconds:.2} s: {:.0} steps/s",
        summary.steps as f64 / seconds
    );
    Ok(())
}
