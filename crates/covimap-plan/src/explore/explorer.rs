//! Steering by the map and by what is seen: always on to where the robot has been least.
//!
//! A robot that can turn towards a landmark it sees needs to know but which one. Of every landmark in sight the
//! explorer looks at the way there as far as three quarters of a range, and counts earlier looks around it:
//!
//! `V = sum_l sum_t exp(-|y_l - y_t|^2 / 2 h^2)`,  `h = 0.36 R`  (3)
//!
//! `y_l` being three places on the way and `y_t` those of all looks so far, as far as the map can tell. The least `V` wins.
//! What that gains: looks are spread evenly over the floor, new ground is entered in straight lines, and
//! nothing is seen twice from one place as long as there are others. Counts of sightings are a worse guide, for a
//! landmark in a corner that is seen seldom draws the robot there again and again, where it sees little else.
//!
//! A landmark that the map does not have yet is new ground, and comes before all others.

use std::collections::BTreeMap;
use std::sync::Arc;

use covimap_embed::{Correspondence, Point, ProcrustesOptions, Similarity, procrustes};
use covimap_map::LandmarkId;

use crate::{Localiser, Location, Look, MapIndex};

/// Width `h` of a place that has been looked from, in ranges.
const WIDTH: f64 = 0.36;
/// Places on the way to a landmark, in ranges.
const AHEAD: [f64; 3] = [0.25, 0.5, 0.75];

/// A look that was made.
#[derive(Debug, Clone)]
struct Visit {
    component: u32,
    place: Point,
    /// Landmarks of the component that it showed.
    seen: Vec<LandmarkId>,
}

/// Where the robot has looked from, and where to go on.
#[derive(Debug, Clone)]
pub struct Explorer {
    localiser: Arc<Localiser>,
    /// Every look that the map could place.
    visits: Vec<Visit>,
}

impl Explorer {
    /// Has not looked anywhere yet.
    #[must_use]
    pub fn new(localiser: Arc<Localiser>) -> Self {
        Self { localiser, visits: Vec::new() }
    }

    /// Goes on with a newer map of the same landmarks.
    ///
    /// A look stays where it was as against the landmarks that it showed: their mean moves with the new map, and
    /// the way from there to the place turns, and grows, as the component does as a whole. Looks of which the new map has
    /// no landmark are forgotten. `O(n log n + t)` for `n` landmarks and `t` looks.
    pub fn adopt(&mut self, localiser: Arc<Localiser>) {
        let [old, new] = [&self.localiser, &localiser].map(|localiser| localiser.index().as_ref());
        let kept: Vec<Option<LandmarkId>> = old.map().names().iter().map(|name| new.lookup(name)).collect();
        let frames = frames(old, new, &kept);
        let moved = |visit: &Visit| {
            let both = || visit.seen.iter().filter_map(|id| Some((*id, kept[id.index()]?)));
            let component = new.placed(both().next()?.1).component;
            let both: Vec<_> = both().filter(|(_, id)| new.placed(*id).component == component).collect();
            let [from, to] = [
                middle(both.iter().map(|(id, _)| old.placed(*id).position)),
                middle(both.iter().map(|(_, id)| new.placed(*id).position)),
            ];
            let frame = frames.get(&(visit.component, component)).copied().flatten();
            // As the frame carries the way; without one the place is the mean.
            let way = frame.map_or([0.0; 2], |frame| {
                let [tip, foot] = [visit.place, from].map(|point| frame.apply(point));
                [tip[0] - foot[0], tip[1] - foot[1]]
            });
            let place = [to[0] + way[0], to[1] + way[1]];
            Some(Visit { component, place, seen: both.into_iter().map(|(_, id)| id).collect() })
        };
        self.visits = self.visits.iter().filter_map(moved).collect();
        self.localiser = localiser;
    }

    /// Takes note of a look, and tells where it was made. `O(m)` for `m` landmarks near.
    pub fn note(&mut self, look: &Look) -> Location {
        let location = self.localiser.locate(look);
        if let Some(here) = location.best().filter(|_| !location.is_lost()) {
            let index = self.localiser.index();
            let seen = look.known.iter().copied().filter(|&id| index.placed(id).component == here.component);
            let (component, place) = (here.component, here.position);
            self.visits.push(Visit { component, place, seen: seen.collect() });
        }
        location
    }

    /// The ID of the landmark in the look towards which to go from there; `None` where the look shows none, or the robot is
    /// lost: then any way is as good. `O(k t)` for `k` landmarks in the look and `t` looks before.
    #[must_use]
    pub fn next(&self, look: &Look, from: &Location) -> Option<String> {
        if let Some(new) = look.unknown.first() {
            return Some(new.clone());
        }
        let here = from.best().filter(|_| !from.is_lost())?;
        let index = self.localiser.index();
        let placed = |id: &LandmarkId| index.placed(*id);
        let there = look.known.iter().filter(|id| placed(id).component == here.component);
        let ways =
            there.map(|id| (id, self.looked_along(here.component, here.position, placed(id).position)));
        let (best, _) = ways.min_by(|a, b| a.1.total_cmp(&b.1))?;
        Some(index.name(*best).to_owned())
    }

    /// Eq. (3).
    fn looked_along(&self, component: u32, from: Point, to: Point) -> f64 {
        let map = self.localiser.index().map();
        let range = map.sensing().map_or(1.0, |sensing| sensing.sensor(component).range);
        let way = [to[0] - from[0], to[1] - from[1]];
        let length = way[0].hypot(way[1]);
        let direction = if length > 0.0 { way.map(|c| c / length) } else { [0.0; 2] };
        let here = self.visits.iter().filter(|visit| visit.component == component);
        let at = |ahead: f64| [0, 1].map(|axis| from[axis] + ahead * range * direction[axis]);
        let near = |(place, visit): (Point, Point)| {
            let squared = (place[0] - visit[0]).powi(2) + (place[1] - visit[1]).powi(2);
            (-squared / (2.0 * (WIDTH * range).powi(2))).exp()
        };
        here.flat_map(|visit| AHEAD.map(|ahead| near((at(ahead), visit.place)))).sum()
    }
}

/// How every component of the old map lies in every component of the new one, where enough landmarks of the one went into
/// the other.
fn frames(
    old: &MapIndex,
    new: &MapIndex,
    kept: &[Option<LandmarkId>],
) -> BTreeMap<(u32, u32), Option<Similarity>> {
    let mut pairs: BTreeMap<(u32, u32), Vec<Correspondence>> = BTreeMap::new();
    for (before, after) in old.map().landmarks().iter().zip(kept) {
        if let Some(after) = after.map(|id| new.placed(id)) {
            let pair = Correspondence { source: before.position, target: after.position, weight: 1.0 };
            pairs.entry((before.component, after.component)).or_default().push(pair);
        }
    }
    let fit = |pairs: Vec<Correspondence>| procrustes(&pairs, ProcrustesOptions::default()).ok();
    pairs.into_iter().map(|(key, pairs)| (key, fit(pairs).map(|fit| fit.target_from_source))).collect()
}

fn middle(points: impl ExactSizeIterator<Item = Point>) -> Point {
    let count = points.len() as f64;
    let sum = points.fold([0.0; 2], |sum, point| [sum[0] + point[0], sum[1] + point[1]]);
    sum.map(|c| c / count)
}
