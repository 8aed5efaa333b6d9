//! Who is next to whom: the Delaunay neighbours of every landmark.

use covimap_embed::Point;
use covimap_map::{GlobalMap, LandmarkId, delaunay_edges};
use rayon::prelude::*;

use crate::charts::Chart;

/// One ascending row of neighbours a landmark.
#[derive(Debug, Clone)]
pub(crate) struct Neighbours {
    starts: Vec<usize>,
    neighbours: Vec<LandmarkId>,
}

impl Neighbours {
    /// Triangulates every component. `O(n log n)`.
    pub fn new(map: &GlobalMap, charts: &[Chart]) -> Self {
        let edges_of = |chart: &Chart| {
            let points: Vec<Point> =
                chart.members.iter().map(|id| map.landmarks()[id.index()].position).collect();
            let edges = delaunay_edges(&points).expect("positions of a map are finite (bug in covimap)");
            edges.into_iter().map(|(a, b)| [a, b].map(|i| chart.members[i as usize])).collect::<Vec<_>>()
        };
        let edges: Vec<Vec<_>> = charts.par_iter().map(edges_of).collect();
        let mut ends: Vec<(LandmarkId, LandmarkId)> =
            edges.into_iter().flatten().flat_map(|[a, b]| [(a, b), (b, a)]).collect();
        ends.par_sort_unstable();
        let mut starts = vec![0; map.len() + 1];
        for (from, _) in &ends {
            starts[from.index() + 1] += 1;
        }
        for i in 0..map.len() {
            starts[i + 1] += starts[i];
        }
        Self { starts, neighbours: ends.into_iter().map(|(_, to)| to).collect() }
    }

    pub fn of(&self, id: LandmarkId) -> &[LandmarkId] {
        &self.neighbours[self.starts[id.index()]..self.starts[id.index() + 1]]
    }
}
