//! Components in the frame in which they are drawn.

use covimap_embed::{Point, Similarity};

use super::ComponentGraph;
use crate::evaluate::{Matching, truth_from_map};
use crate::{GlobalMap, MapError, Truth};

/// A component, its points where they are drawn, up to a shift and a common scale.
pub(super) struct Chart {
    pub graph: ComponentGraph,
    /// Surveyed positions in the same frame, by index into the landmarks of the graph.
    pub surveyed: Vec<(usize, Point)>,
}

impl Chart {
    /// Smallest and largest coordinates of all that is drawn.
    pub fn bounds(&self) -> [Point; 2] {
        let all = self.graph.points.iter().chain(self.surveyed.iter().map(|(_, point)| point));
        let none = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        all.fold(none, |[low, high], &[x, y]| {
            [[low[0].min(x), low[1].min(y)], [high[0].max(x), high[1].max(y)]]
        })
    }
}

/// Components in their own frames, or in that of the truth.
pub(super) fn charts(
    map: &GlobalMap,
    graphs: Vec<ComponentGraph>,
    truth: Option<&Truth>,
) -> Result<Vec<Chart>, MapError> {
    let mut charts: Vec<Chart> =
        graphs.into_iter().map(|graph| Chart { graph, surveyed: Vec::new() }).collect();
    let Some(truth) = truth else { return Ok(charts) };
    let mut common_scale = None;
    for matched in Matching::of(map, truth)?.charts {
        let place = charts.binary_search_by_key(&matched.component, |chart| chart.graph.component);
        let chart = &mut charts[place.expect("components are those of the map (bug in covimap)")];
        let Some(truth_from_map) = truth_from_map(&matched)? else { continue };
        common_scale.get_or_insert(truth_from_map.scale);
        move_points(chart, &truth_from_map);
        let index_of = |id| chart.graph.landmarks.binary_search(id);
        let indices = matched.landmarks.iter().map(|id| index_of(id).expect("member (bug in covimap)"));
        chart.surveyed = indices.zip(matched.truth).collect();
    }
    // Components that the truth does not reach keep their frame but not their scale.
    let scale = Similarity { scale: common_scale.unwrap_or(1.0), ..Similarity::IDENTITY };
    charts.iter_mut().filter(|chart| chart.surveyed.is_empty()).for_each(|chart| move_points(chart, &scale));
    Ok(charts)
}

fn move_points(chart: &mut Chart, transform: &Similarity) {
    chart.graph.points.iter_mut().for_each(|point| *point = transform.apply(*point));
}
