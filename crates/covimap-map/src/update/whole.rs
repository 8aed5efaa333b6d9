//! Everything solved again, and the result laid onto the old map.

use covimap_embed::{Correspondence, Point, ProcrustesOptions, Reflection, Similarity, robust_procrustes};
use rustc_hash::FxHashMap;

use crate::state::members;
use crate::{CoVisibility, GlobalMap, LandmarkId, MapError, MapState, Mapper, Observer, SightingLog};

/// Builds the map of the joined log with the settings of the old one, every component in the frame of the old
/// component that it shares most landmarks with. Lengths stay as they are.
pub(super) fn solve(
    old: &MapState,
    log: SightingLog,
    counts: CoVisibility,
    observer: &dyn Observer,
) -> Result<MapState, MapError> {
    let mapper = Mapper::new(old.map.params().clone())?;
    let built = mapper.build_known(&log, counts, observer)?;
    let mut state = MapState::new(log, built);
    let known: FxHashMap<&str, LandmarkId> =
        (0..).map(LandmarkId).zip(old.map.names().iter()).map(swap).collect();
    for members in members(&state.map) {
        let Some(frame) = old_from_new(&old.map, &state.map, &members, &known) else { continue };
        for &member in &members {
            let placed = &mut state.map.landmarks[member as usize];
            placed.position = frame.apply(placed.position);
            let polished = &mut state.ground.polished[member as usize];
            *polished = frame.apply(*polished);
        }
    }
    Ok(state)
}

fn swap<A, B>((a, b): (A, B)) -> (B, A) {
    (b, a)
}

/// Where a component of the new map lies in the old one; `None` if the two share no landmarks that tell.
fn old_from_new(
    old: &GlobalMap,
    new: &GlobalMap,
    members: &[u32],
    known: &FxHashMap<&str, LandmarkId>,
) -> Option<Similarity> {
    let position = |map: &GlobalMap, id: LandmarkId| -> Point { map.landmarks()[id.index()].position };
    let mut shared: Vec<(u32, Correspondence)> = members
        .iter()
        .filter_map(|&member| {
            let id = LandmarkId(member);
            let then = *known.get(new.names().name(id))?;
            let pair = Correspondence { source: position(new, id), target: position(old, then), weight: 1.0 };
            Some((old.landmarks()[then.index()].component, pair))
        })
        .collect();
    shared.sort_by_key(|pair| pair.0);
    // Of equals the first, which is the largest component.
    let most = shared.chunk_by(|a, b| a.0 == b.0).rev().max_by_key(|of_one| of_one.len())?;
    let pairs: Vec<Correspondence> = most.iter().map(|pair| pair.1).collect();
    let options = ProcrustesOptions { scale: false, reflection: Reflection::Allow };
    Some(robust_procrustes(&pairs, options).ok()?.fit.target_from_source)
}
