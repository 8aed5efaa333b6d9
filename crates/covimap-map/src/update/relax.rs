//! Least stress of what has changed, among what has not.

use covimap_embed::{Pair, PairDistances, Point, StopRule, Termination, anchored_while};
use rayon::prelude::*;

use super::draft::{Draft, NOWHERE};
use super::{Joined, MOST_FREE};
use crate::distances::{Law, PairCount};
use crate::progress::begin;
use crate::{Link, MapError, Observer, Stage};

/// Times that landmarks are freed because of others, at most.
const ROUNDS: usize = 20;
/// Push, in standard deviations, from which on a landmark is freed.
const PUSHED: f64 = 0.5;
/// Steps that gain little are many: a change spreads by a link a step.
const STOP: StopRule = StopRule { max_iterations: 300, tolerance: 1e-6 };

/// Frees what new evidence touches and brings it to least stress, and whatever it pushes too.
///
/// False if that would be half of the landmarks, or does not come to an end.
pub(super) fn relax(joined: &Joined, draft: &mut Draft, observer: &dyn Observer) -> Result<bool, MapError> {
    begin(Stage::Polish, None, observer)?;
    draft.origin.clone_from(&draft.polished);
    for landmark in 0..joined.landmarks() as u32 {
        let component = joined.component_of[landmark as usize] as usize;
        draft.free[landmark as usize] |= draft.base[component].is_some() && joined.is_touched(landmark);
    }
    for _ in 0..ROUNDS {
        let free = draft.free.iter().filter(|free| **free).count();
        if free as f64 >= MOST_FREE * joined.landmarks() as f64 {
            return Ok(false);
        }
        minimise(joined, draft, observer)?;
        let pushed = pushed(joined, draft);
        if pushed.is_empty() {
            observer.finished(Stage::Polish);
            return Ok(true);
        }
        pushed.iter().for_each(|&landmark| draft.free[landmark as usize] = true);
    }
    Ok(false)
}

/// Least stress of what is free among what it is linked to.
fn minimise(joined: &Joined, draft: &mut Draft, observer: &dyn Observer) -> Result<(), MapError> {
    let linked = |landmark: &u32| joined.graph.of(*landmark).iter().map(|link| link.to);
    let free = (0..joined.landmarks() as u32).filter(|&landmark| draft.free[landmark as usize]);
    let mut takes_part = draft.free.clone();
    free.flat_map(|landmark| linked(&landmark)).for_each(|to| takes_part[to as usize] = true);
    let scope: Vec<u32> = (0..joined.landmarks() as u32).filter(|&l| takes_part[l as usize]).collect();
    let mut place = vec![NOWHERE; joined.landmarks()];
    (0..).zip(&scope).for_each(|(at, &landmark)| place[landmark as usize] = at);

    let rows: Vec<Vec<Pair>> = scope
        .par_iter()
        .map(|&a| {
            let matters =
                |link: &Link| link.to > a && (draft.free[a as usize] || draft.free[link.to as usize]);
            let pair = |(link, count): (&Link, PairCount)| {
                let (distance, weight) = draft.measure(a, link, count);
                Pair { i: place[a as usize], j: place[link.to as usize], distance, weight }
            };
            joined.counted_links(a).filter(|(link, _)| matters(link)).map(pair).collect()
        })
        .collect();
    let pairs = PairDistances::new(scope.len(), rows.concat())?;
    let start: Vec<Point> = scope.iter().map(|&landmark| draft.polished[landmark as usize]).collect();
    let held: Vec<bool> = scope.iter().map(|&landmark| !draft.free[landmark as usize]).collect();
    let solved = anchored_while(&pairs, &start, &held, STOP, || {
        observer.advanced(1);
        !observer.interrupted()
    })?;
    if solved.termination == Termination::Interrupted {
        return Err(MapError::Interrupted);
    }
    for (&landmark, point) in scope.iter().zip(solved.points) {
        draft.polished[landmark as usize] = point;
    }
    Ok(())
}

/// The landmarks that what is free now pushes further than they are known.
fn pushed(joined: &Joined, draft: &Draft) -> Vec<u32> {
    let mut beside: Vec<bool> = vec![false; joined.landmarks()];
    for landmark in (0..joined.landmarks() as u32).filter(|&landmark| draft.free[landmark as usize]) {
        joined.graph.of(landmark).iter().for_each(|link| beside[link.to as usize] = true);
    }
    let is_pushed = |&landmark: &u32| {
        beside[landmark as usize]
            && !draft.free[landmark as usize]
            && push(joined, draft, landmark)
                > PUSHED * draft.sensed[landmark as usize].map_or(0.0, |sensed| sensed.deviation)
    };
    (0..joined.landmarks() as u32).into_par_iter().filter(is_pushed).collect()
}

/// How far a held landmark would go, all others staying, because of what those that are free have done: the
/// change of the gradient over the Gauss-Newton block.
fn push(joined: &Joined, draft: &Draft, landmark: u32) -> f64 {
    let here = draft.polished[landmark as usize];
    let mut change = [0.0; 2];
    let [mut xx, mut xy, mut yy] = [0.0; 3];
    for (link, count) in joined.counted_links(landmark) {
        let (distance, weight) = draft.measure(landmark, link, count);
        let to = link.to as usize;
        let force = |there: Point| {
            let d = [here[0] - there[0], here[1] - there[1]];
            let r = d[0].hypot(d[1]);
            (d, r, if r > 0.0 { weight * (1.0 - distance / r) } else { 0.0 })
        };
        let (d, r, pull) = force(draft.polished[to]);
        if r > 0.0 {
            let across = weight * (1.0 - distance / r).max(0.0);
            let along = (weight - across) / (r * r);
            xx += along * d[0] * d[0] + across;
            xy += along * d[0] * d[1];
            yy += along * d[1] * d[1] + across;
        }
        if draft.free[to] {
            change = [change[0] + pull * d[0], change[1] + pull * d[1]];
            if draft.chart_of[to] != NOWHERE {
                let (d, _, pull) = force(draft.origin[to]);
                change = [change[0] - pull * d[0], change[1] - pull * d[1]];
            }
        }
    }
    let determinant = xx * yy - xy * xy;
    let step = [yy * change[0] - xy * change[1], xx * change[1] - xy * change[0]];
    // Without a second direction it is held by nothing across the first.
    if determinant > 1e-9 * (xx + yy).powi(2) { step[0].hypot(step[1]) / determinant } else { 0.0 }
}

impl Draft<'_> {
    /// Distance and weight of a link of a landmark, by the rules of its component.
    pub fn measure(&self, landmark: u32, link: &Link, count: PairCount) -> (f64, f64) {
        match self.law(landmark) {
            Some(law) => {
                let [a, b] = [landmark, link.to].map(|end| self.origin[end as usize]);
                let (distance, weight, _) = law.measure(count, (a[0] - b[0]).hypot(a[1] - b[1]));
                (distance, weight)
            }
            None => (link.distance, link.weight),
        }
    }

    fn law(&self, landmark: u32) -> Option<&Law> {
        let component = self.joined.component_of[landmark as usize];
        let base = self.base[component as usize]?;
        self.joined.old.ground.rules[base as usize].law.as_ref()
    }
}

impl Joined<'_> {
    /// The links of a landmark, with the counts of each.
    pub fn counted_links(&self, landmark: u32) -> impl Iterator<Item = (&Link, PairCount)> {
        let (partners, together) = self.counts.row(crate::LandmarkId(landmark));
        let own = self.counts.sightings()[landmark as usize];
        let mut at = 0;
        self.graph.of(landmark).iter().map(move |link| {
            // Both lists ascend: walk them together.
            at += partners[at..].partition_point(|&partner| partner < link.to);
            let both = together[at];
            let either = own - both + self.counts.sightings()[link.to as usize];
            (link, PairCount { together: both, either })
        })
    }
}
