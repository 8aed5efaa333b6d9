//! The components of a map, each with its landmarks and a tree to find them by place.
//!
//! Components have frames of their own, so a place is always a place in one of them.

use covimap_embed::Point;
use covimap_map::{GlobalMap, LandmarkId};
use rayon::prelude::*;
use rstar::RTree;
use rstar::primitives::GeomWithData;

/// A landmark at a distance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Near {
    /// The landmark.
    pub landmark: LandmarkId,
    /// How far it is, in the units of the map.
    pub distance: f64,
}

/// A component.
#[derive(Debug, Clone)]
pub(crate) struct Chart {
    pub component: u32,
    /// Ascending.
    pub members: Vec<LandmarkId>,
    tree: RTree<GeomWithData<Point, LandmarkId>>,
}

/// The components of a map, by number. `O(n log n)`.
pub(crate) fn charts(map: &GlobalMap) -> Vec<Chart> {
    let component = |id: &LandmarkId| map.landmarks()[id.index()].component;
    let mut landmarks: Vec<LandmarkId> = (0..map.len() as u32).map(LandmarkId).collect();
    landmarks.sort_by_key(component);
    let members: Vec<&[LandmarkId]> = landmarks.chunk_by(|a, b| component(a) == component(b)).collect();
    let chart = |members: &&[LandmarkId]| {
        let site = |&id: &LandmarkId| GeomWithData::new(map.landmarks()[id.index()].position, id);
        let tree = RTree::bulk_load(members.iter().map(site).collect());
        Chart { component: component(&members[0]), members: members.to_vec(), tree }
    };
    members.par_iter().map(chart).collect()
}

impl Chart {
    /// The `k` landmarks nearest to a place, nearest first, equally near ones by number.
    ///
    /// `O(k log n)` unless many are equally near.
    pub fn nearest(&self, place: Point, k: usize, is_wanted: impl Fn(LandmarkId) -> bool) -> Vec<Near> {
        let all =
            self.tree.nearest_neighbor_iter_with_distance_2(place).filter(|(site, _)| is_wanted(site.data));
        let mut found: Vec<Near> = Vec::with_capacity(k.min(self.members.len()));
        for (site, squared) in all {
            let distance = squared.sqrt();
            // All that are as near as the last one compete for its place.
            if found.len() >= k && found.last().is_none_or(|last| distance > last.distance) {
                break;
            }
            found.push(Near { landmark: site.data, distance });
        }
        in_order(&mut found);
        found.truncate(k);
        found
    }

    /// All landmarks within a radius of a place, nearest first, equally near ones by number.
    pub fn within(&self, place: Point, radius: f64) -> Vec<Near> {
        let sites = self.tree.locate_within_distance(place, radius * radius);
        let near = |site: &GeomWithData<Point, LandmarkId>| {
            let [x, y] = site.geom();
            Near { landmark: site.data, distance: (x - place[0]).hypot(y - place[1]) }
        };
        let mut found: Vec<Near> = sites.map(near).collect();
        in_order(&mut found);
        found
    }
}

fn in_order(found: &mut [Near]) {
    found.sort_unstable_by(|a, b| a.distance.total_cmp(&b.distance).then(a.landmark.cmp(&b.landmark)));
}
