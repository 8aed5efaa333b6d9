//! What is free is refined by the steps that tell of it.

use covimap_embed::Point;

use super::Joined;
use super::draft::{Draft, NOWHERE};
use crate::places::{Again, Model, SeenSets, refine_some};
use crate::progress::begin;
use crate::{LinkGraph, MapError, Observer, Sensed, Stage};

/// Moves free landmarks to where the log is most likely, and learns how well each is known and how often missed.
pub(super) fn refine(joined: &Joined, draft: &mut Draft, observer: &dyn Observer) -> Result<(), MapError> {
    follow_the_polish(&joined.graph, draft);
    let iterations = joined.params().auto.refine_iterations;
    begin(Stage::Refine, Some(iterations as u64), observer)?;
    let (components, steps) = telling_steps(joined, draft);
    for (component, steps) in components.into_iter().zip(steps) {
        refine_component(joined, draft, component, steps, iterations, observer)?;
    }
    observer.finished(Stage::Refine);
    Ok(())
}

/// Carries refined places along with the polish. A landmark without one takes the mean way from polished to
/// refined places of those that it is linked to: the refinement bends the map as a whole, too.
fn follow_the_polish(graph: &LinkGraph, draft: &mut Draft) {
    let mut left = Vec::new();
    for landmark in 0..draft.free.len() {
        if !draft.free[landmark] {
            continue;
        }
        if draft.chart_of[landmark] == NOWHERE {
            left.push(landmark as u32);
        } else {
            let (to, from) = (draft.polished[landmark], draft.origin[landmark]);
            let point = &mut draft.points[landmark];
            *point = [point[0] + to[0] - from[0], point[1] + to[1] - from[1]];
        }
    }
    let mut known: Vec<bool> = draft.chart_of.iter().map(|&chart| chart != NOWHERE).collect();
    while !left.is_empty() {
        let way = |&landmark: &u32| {
            let mut sum = [0.0; 3];
            for to in graph.of(landmark).iter().map(|link| link.to as usize).filter(|&to| known[to]) {
                for (axis, sum) in sum.iter_mut().take(2).enumerate() {
                    *sum += draft.points[to][axis] - draft.polished[to][axis];
                }
                sum[2] += 1.0;
            }
            (sum[2] > 0.0).then(|| (landmark as usize, [sum[0] / sum[2], sum[1] / sum[2]]))
        };
        let ways: Vec<(usize, Point)> = left.iter().filter_map(way).collect();
        for (landmark, way) in ways {
            let polished = draft.polished[landmark];
            draft.points[landmark] = [polished[0] + way[0], polished[1] + way[1]];
            known[landmark] = true;
        }
        left.retain(|&landmark| !known[landmark as usize]);
    }
}

/// The components with free landmarks, and of each the steps that tell of one: by showing it, or by missing it
/// while at least half of what they show is linked to one.
fn telling_steps(joined: &Joined, draft: &Draft) -> (Vec<u32>, Vec<Vec<usize>>) {
    let mut near = draft.free.clone();
    let mut has_free = vec![false; joined.components.len()];
    for landmark in (0..joined.landmarks()).filter(|&landmark| draft.free[landmark]) {
        has_free[joined.component_of[landmark] as usize] = true;
        joined.graph.of(landmark as u32).iter().for_each(|link| near[link.to as usize] = true);
    }
    let components: Vec<u32> =
        (0..joined.components.len() as u32).filter(|&component| has_free[component as usize]).collect();
    let mut steps = vec![Vec::new(); components.len()];
    for (number, seen) in joined.log.iter().enumerate() {
        let near = seen.iter().filter(|&&landmark| near[landmark as usize]);
        let mut of: Vec<u32> = near.map(|&landmark| joined.component_of[landmark as usize]).collect();
        of.sort_unstable();
        for same in of.chunk_by(|a, b| a == b) {
            let shown = || seen.iter().filter(|&&l| joined.component_of[l as usize] == same[0]);
            let tells = 2 * same.len() >= shown().count() || shown().any(|&l| draft.free[l as usize]);
            if tells && shown().nth(1).is_some() {
                let place =
                    components.binary_search(&same[0]).expect("it has free landmarks (bug in covimap)");
                steps[place].push(number);
            }
        }
    }
    (components, steps)
}

fn refine_component(
    joined: &Joined,
    draft: &mut Draft,
    component: u32,
    steps: Vec<usize>,
    iterations: usize,
    observer: &dyn Observer,
) -> Result<(), MapError> {
    let base = draft.base[component as usize].expect("only what has a base is free (bug in covimap)");
    let Some(sensor) = joined.old.ground.rules[base as usize].sensor else { return Ok(()) };
    let scope = scope(joined, component, &steps);
    let mut place = vec![(usize::MAX, 0); joined.landmarks()];
    (0..).zip(&scope).for_each(|(at, &landmark)| place[landmark as usize] = (0, at));
    let sets = SeenSets::of_steps(&joined.log, 0, steps, &place);
    let free: Vec<bool> = scope.iter().map(|&landmark| draft.free[landmark as usize]).collect();
    let detectability = |&landmark: &u32| {
        draft.sensed[landmark as usize].map_or(sensor.detectability, |sensed| sensed.detectability)
    };
    let model = Model {
        points: scope.iter().map(|&landmark| draft.points[landmark as usize]).collect(),
        detectability: scope.iter().map(detectability).collect(),
        sensor,
    };
    let graph = joined.graph.restricted_to(&scope);
    let Again { points, detectability, deviation } =
        refine_some(&graph, &sets, model, &free, iterations, observer)?;
    for (at, &landmark) in scope.iter().enumerate().filter(|&(at, _)| free[at]) {
        draft.points[landmark as usize] = points[at];
        let warp = draft.sensed[landmark as usize].map_or(0.0, |sensed| sensed.warp);
        let (detectability, deviation) = (detectability[at], deviation[at]);
        draft.sensed[landmark as usize] = Some(Sensed { detectability, deviation, warp });
    }
    Ok(())
}

/// The landmarks of a component that steps show, and those linked to one of them; ascending.
fn scope(joined: &Joined, component: u32, steps: &[usize]) -> Vec<u32> {
    let mut takes_part = vec![false; joined.landmarks()];
    let seen = steps.iter().flat_map(|&step| joined.log.step(step)).copied();
    let own = |landmark: &u32| joined.component_of[*landmark as usize] == component;
    seen.filter(own).for_each(|landmark| takes_part[landmark as usize] = true);
    let shown: Vec<u32> = (0..).zip(&takes_part).filter(|(_, shown)| **shown).map(|shown| shown.0).collect();
    for link in shown.iter().flat_map(|&landmark| joined.graph.of(landmark)) {
        takes_part[link.to as usize] = true;
    }
    (0..).zip(&takes_part).filter(|(_, part)| **part).map(|part| part.0).collect()
}
