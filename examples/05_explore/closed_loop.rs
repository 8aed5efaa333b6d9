//! A simulated robot that explores by the map it makes, and by what it sees.

use std::error::Error;
use std::sync::Arc;

use covimap::plan::{Explorer, MapIndex};
use covimap::{DistanceChoice, GlobalMap, Mapper, MapperParams, SightingLog, Silent};
use covimap_sim::{Angle, Rover, RunSpec, World};

/// Steps before the first map.
const FIRST: usize = 20;
/// A new map when the log has grown by this share.
const GROWTH: f64 = 0.2;

/// The landmarks that each step of the exploration shows.
///
/// The robot knows its log, and may turn towards a landmark that it sees. Its steps are those of a wandering robot: of the
/// same lengths, the turn from the wanted direction at random within the same limits, and the same way round obstacles.
pub fn explored(
    world: &World,
    run: &RunSpec,
    steps: usize,
    seed: u64,
) -> Result<Vec<Vec<u32>>, Box<dyn Error>> {
    let names = world.names();
    let ids: Vec<&str> = names.iter().collect();
    let mut rover = Rover::new(world, run, seed)?;
    let mut log: Vec<Vec<u32>> = Vec::with_capacity(steps);
    let mut explorer: Option<(Arc<MapIndex>, Explorer)> = None;
    let mut mapped = 0;
    while log.len() < steps {
        let seen = rover.look().to_vec();
        let is_due = log.len() >= FIRST && log.len() as f64 >= (1.0 + GROWTH) * mapped as f64;
        let map = is_due.then(|| map_of(&log, &ids, steering())).flatten();
        if let Some(map) = map.filter(|map| map.sensing().is_some()) {
            mapped = log.len();
            let index = Arc::new(MapIndex::new(Arc::new(map)));
            let explorer_now = match explorer.take() {
                Some((_, mut explorer)) => {
                    explorer.adopt(Arc::clone(&index))?;
                    explorer
                }
                None => Explorer::new(Arc::clone(&index))?,
            };
            explorer = Some((index, explorer_now));
        }
        let next = explorer.as_mut().and_then(|(index, explorer)| {
            let id = explorer.next(seen.iter().map(|&number| ids[number as usize]))?;
            seen.iter().copied().find(|&number| ids[number as usize] == index.name(id))
        });
        match next {
            Some(number) => _ = rover.approach(number),
            None => rover.head(Angle::from_rad(0.0)),
        }
        log.push(seen);
    }
    Ok(log)
}

/// A map to steer by needs no last polish.
fn steering() -> MapperParams {
    let mut params = MapperParams::default();
    params.auto.refine_iterations = 0;
    params.auto.distance = DistanceChoice::FixedLog;
    params
}

/// The map of these steps; `None` if they show too little for any.
pub fn map_of(log: &[Vec<u32>], ids: &[&str], params: MapperParams) -> Option<GlobalMap> {
    let look = |seen: &Vec<u32>| seen.iter().map(|&number| ids[number as usize]).collect::<Vec<_>>();
    Mapper::new(params).ok()?.build(&SightingLog::from_steps(log.iter().map(look)), &Silent).ok()
}
