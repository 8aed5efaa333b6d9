//! A component as a graph: its landmarks and who is next to whom.

use std::collections::BTreeMap;

use covimap_embed::Point;

use crate::{GlobalMap, LandmarkId, delaunay_edges};

/// The landmarks of one component and the Delaunay edges between them.
pub(super) struct ComponentGraph {
    pub component: u32,
    /// Ascending.
    pub landmarks: Vec<LandmarkId>,
    /// Positions of `landmarks`.
    pub points: Vec<Point>,
    /// Between indices into `landmarks`, ascending.
    pub edges: Vec<(u32, u32)>,
}

impl ComponentGraph {
    /// All components of a map, by number.
    pub fn all(map: &GlobalMap) -> Vec<Self> {
        let mut members = BTreeMap::<u32, Vec<LandmarkId>>::new();
        for (id, placed) in (0..).map(LandmarkId).zip(map.landmarks()) {
            members.entry(placed.component).or_default().push(id);
        }
        let graph = |(component, landmarks): (u32, Vec<LandmarkId>)| {
            let points: Vec<Point> =
                landmarks.iter().map(|id| map.landmarks()[id.index()].position).collect();
            let edges = delaunay_edges(&points).expect("positions of a map are finite (bug in covimap)");
            Self { component, landmarks, points, edges }
        };
        members.into_iter().map(graph).collect()
    }

    /// The Delaunay edges between landmarks of the map.
    pub fn landmark_edges(&self) -> impl Iterator<Item = (LandmarkId, LandmarkId)> {
        self.edges.iter().map(|&(a, b)| (self.landmarks[a as usize], self.landmarks[b as usize]))
    }
}
