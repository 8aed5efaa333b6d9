//! A simulated robot that explores, and the map of what it has seen.

use covimap::plan::Explorer;
use covimap::{GlobalMap, Mapper, MapperParams, SightingLog, Silent};
use covimap_sim::{Angle, Rover, RunSpec, SimError, World};

/// The landmarks that each step of the exploration shows.
///
/// The robot may turn towards a landmark that it sees. Its steps are those of a wandering robot: of the same lengths, the
/// turn from the wanted direction at random within the same limits, and the same way round obstacles.
pub fn explored(world: &World, run: &RunSpec, steps: usize, seed: u64) -> Result<Vec<Vec<u32>>, SimError> {
    let names = world.names();
    let ids: Vec<&str> = names.iter().collect();
    let mut rover = Rover::new(world, run, seed)?;
    let mut explorer = Explorer::default();
    let mut log: Vec<Vec<u32>> = Vec::with_capacity(steps);
    while log.len() < steps {
        let seen = rover.look().to_vec();
        let next = explorer.next(seen.iter().map(|&number| ids[number as usize]));
        match seen.iter().copied().find(|&number| next == Some(ids[number as usize])) {
            Some(number) => _ = rover.approach(number),
            None => rover.head(Angle::from_rad(0.0)),
        }
        log.push(seen);
    }
    Ok(log)
}

/// The map of these steps; `None` if they show too little for any.
pub fn map_of(log: &[Vec<u32>], ids: &[&str]) -> Option<GlobalMap> {
    let look = |seen: &Vec<u32>| seen.iter().map(|&number| ids[number as usize]).collect::<Vec<_>>();
    let log = SightingLog::from_steps(log.iter().map(look));
    Mapper::new(MapperParams::default()).ok()?.build(&log, &Silent).ok()
}
