//! A simulated robot that explores by the map it makes, and by what it sees.

use std::error::Error;
use std::sync::Arc;

use covimap::plan::{Explorer, Localiser, Look, MapIndex};
use covimap::{DistanceChoice, GlobalMap, Mapper, MapperParams, SightingLog, Silent};
use covimap_sim::{Rover, RunSpec, World};

/// Steps before the first map.
const FIRST: usize = 10;
/// A new map when the log has grown by this share.
const GROWTH: f64 = 0.2;
/// A new map also when a landmark that it lacks was seen so often.
const UNMAPPED: u32 = 5;

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
    let mut sightings = vec![0u32; ids.len()];
    let mut explorer: Option<(Arc<Localiser>, Explorer)> = None;
    let mut mapped = 0;
    while log.len() < steps {
        let seen = rover.look().to_vec();
        seen.iter().for_each(|&number| sightings[number as usize] += 1);
        log.push(seen.clone());
        let seen_ids = || seen.iter().map(|&number| ids[number as usize]);
        let lacks = |localiser: &Localiser| {
            let is_due = |&number: &u32| sightings[number as usize].is_multiple_of(UNMAPPED);
            let due = seen.iter().filter(|number| is_due(number)).map(|&number| ids[number as usize]);
            !localiser.look(due).unknown.is_empty()
        };
        let grown = log.len() as f64 >= (1.0 + GROWTH) * mapped as f64;
        if log.len() >= FIRST && (grown || explorer.as_ref().is_some_and(|(localiser, _)| lacks(localiser))) {
            mapped = log.len();
            explorer = updated(explorer, &log, &ids)?;
        }
        let next = match &mut explorer {
            Some((localiser, explorer)) => {
                let look: Look = localiser.look(seen_ids());
                let here = explorer.note(&look);
                explorer.next(&look, &here)
            }
            // Without a map, on to what was seen least.
            None => seen.iter().min_by_key(|&&n| sightings[n as usize]).map(|&n| ids[n as usize].to_owned()),
        };
        match next.and_then(|id| seen.iter().find(|&&number| ids[number as usize] == id)) {
            Some(&number) => _ = rover.approach(number),
            None => rover.wander(),
        }
    }
    Ok(log)
}

/// The explorer with a map of all that was seen; as it was where that makes no map to find places on.
fn updated(
    explorer: Option<(Arc<Localiser>, Explorer)>,
    log: &[Vec<u32>],
    ids: &[&str],
) -> Result<Option<(Arc<Localiser>, Explorer)>, Box<dyn Error>> {
    // A map to steer by needs no last polish.
    let mut params = MapperParams::default();
    params.auto.refine_iterations = 0;
    params.auto.distance = DistanceChoice::FixedLog;
    let Some(localiser) =
        map_of(log, ids, params).and_then(|map| Localiser::new(Arc::new(MapIndex::new(Arc::new(map)))).ok())
    else {
        return Ok(explorer);
    };
    let localiser = Arc::new(localiser);
    let explorer = match explorer {
        Some((_, mut explorer)) => {
            explorer.adopt(Arc::clone(&localiser));
            explorer
        }
        None => {
            let mut explorer = Explorer::new(Arc::clone(&localiser));
            for seen in &log[..log.len() - 1] {
                explorer.note(&localiser.look(seen.iter().map(|&number| ids[number as usize])));
            }
            explorer
        }
    };
    Ok(Some((localiser, explorer)))
}

/// The map of these steps; `None` if they show too little for any.
pub fn map_of(log: &[Vec<u32>], ids: &[&str], params: MapperParams) -> Option<GlobalMap> {
    let look = |seen: &Vec<u32>| seen.iter().map(|&number| ids[number as usize]).collect::<Vec<_>>();
    Mapper::new(params).ok()?.build(&SightingLog::from_steps(log.iter().map(look)), &Silent).ok()
}
