//! The map of one connected component, and the frame in which it is handed out.

use covimap_embed::{PairDistances, Point};

use crate::distances::{ComponentSteps, DistanceReport, Distances, Law};
use crate::layout::{Layout, lay_out};
use crate::places::{SeenSets, Sensor};
use crate::settle::{Start, settle};
use crate::shape::Shape;
use crate::stitch::Stitched;
use crate::surveyor::Surveyor;
use crate::{AutoParams, CoVisibility, LinkGraph, MapError, Observer, RangeReport, SeamsReport};

/// A mapped component.
pub(crate) struct ComponentMap {
    /// Positions, in the frame of [`put_in_frame`].
    pub points: Vec<Point>,
    /// Region of whose core each landmark is.
    pub region: Vec<u32>,
    pub regions: usize,
    /// Branch of each region.
    pub branch_of: Vec<u32>,
    pub seams: SeamsReport,
    pub path_pull: f64,
    /// Whether its links are no distances in a plane.
    pub network: bool,
    pub stress1: f64,
    pub iterations: usize,
    pub converged: bool,
    pub distances: Option<DistanceReport>,
    /// What ranges have made of the map, if the log tells any.
    pub ranges: Option<RangeReport>,
    pub basis: Basis,
}

/// What is needed to go on from a component's map.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Basis {
    /// Positions of least stress, before the refinement, in the frame of the map.
    pub polished: Vec<Point>,
    /// What turned counts into distances; `None` for the fixed logarithm.
    pub law: Option<Law>,
    /// The sensor of the refinement; `None` where nothing was refined.
    pub sensor: Option<Sensor>,
}

/// What is known of a connected component besides its links.
pub(crate) struct Evidence<'a> {
    pub counts: &'a CoVisibility,
    /// What the counts call landmark `k` of the component, ascending.
    pub members: &'a [u32],
    pub steps: &'a ComponentSteps<'a>,
    pub sets: &'a SeenSets,
}

/// Maps a connected component: regions, local maps, stitching, polish, refinement.
pub(crate) fn map_component(
    graph: &LinkGraph,
    evidence: &Evidence,
    params: &AutoParams,
    seed: u64,
    observer: &dyn Observer,
) -> Result<ComponentMap, MapError> {
    let fixed = graph.to_pairs();
    let distances = evidence.distances(graph, &fixed, seed);
    let surveyor = Surveyor { graph, distances: distances.as_ref(), params, seed, observer };
    let Layout { cover, stitched, untwisted } = lay_out(&surveyor)?;
    let shape = Shape::of(graph, &cover, &stitched);
    let Stitched { points, branch_of, seams } = stitched;
    let start = Start { points, shape, untwisted };
    let settled = settle(&surveyor, &fixed, evidence, start)?;
    let (region, regions) = (cover.core_of().to_vec(), cover.regions().len());
    Ok(ComponentMap { region, regions, branch_of, seams, ..settled })
}

impl Evidence<'_> {
    /// What the log tells of the links of the component, with the distances `fixed` of the logarithm.
    pub fn distances<'a>(
        &self,
        graph: &LinkGraph,
        fixed: &'a PairDistances,
        seed: u64,
    ) -> Option<Distances<'a>> {
        Distances::new(graph, fixed, self.counts, self.members, self.steps, seed)
    }
}

/// Brings the points of a component into the frame that all maps use: the centroid at the origin,
/// the x axis along the greatest spread, and the first point at `x >= 0` and `y >= 0`.
///
/// The last choice includes the handedness, which co-visibility cannot tell. `companions` go along and have no
/// say.
pub(crate) fn put_in_frame(points: &mut [Point], companions: &mut [Point]) {
    let n = points.len() as f64;
    let centre = [0, 1].map(|axis| points.iter().map(|point| point[axis]).sum::<f64>() / n);
    for point in points.iter_mut().chain(companions.iter_mut()) {
        *point = [point[0] - centre[0], point[1] - centre[1]];
    }
    // The direction of greatest spread is half the angle of the sum of (x + iy)^2.
    let real: f64 = points.iter().map(|[x, y]| x * x - y * y).sum();
    let imaginary: f64 = points.iter().map(|[x, y]| 2.0 * x * y).sum();
    let (sin, cos) = (0.5 * imaginary.atan2(real)).sin_cos();
    for point in points.iter_mut().chain(companions.iter_mut()) {
        *point = [cos * point[0] + sin * point[1], cos * point[1] - sin * point[0]];
    }
    let signs = points.first().map_or([1.0; 2], |first| first.map(|c| if c < 0.0 { -1.0 } else { 1.0 }));
    for point in points.iter_mut().chain(companions) {
        // Adding zero turns a negative zero into a positive one.
        *point = [signs[0] * point[0] + 0.0, signs[1] * point[1] + 0.0];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_frame_does_not_depend_on_where_the_map_was() {
        let shape = [[2.0, 1.0], [0.0, 0.0], [5.0, 0.5], [1.0, -1.0]];
        let mut wanted = shape;
        put_in_frame(&mut wanted, &mut []);
        assert!(wanted[0][0] >= 0.0 && wanted[0][1] >= 0.0);
        let (sin, cos) = 0.7f64.sin_cos();
        for mirror in [1.0, -1.0] {
            let mut moved =
                shape.map(|[x, y]| [cos * x - sin * mirror * y + 3.0, sin * x + cos * mirror * y - 8.0]);
            let mut companion = [moved[2]];
            put_in_frame(&mut moved, &mut companion);
            assert_eq!(companion[0], moved[2]);
            for (a, b) in moved.iter().zip(&wanted) {
                assert!((a[0] - b[0]).hypot(a[1] - b[1]) < 1e-12, "{moved:?} {wanted:?}");
            }
        }
    }

    #[test]
    fn the_frame_of_one_point_and_of_none() {
        let mut one = [[4.0, -2.0]];
        put_in_frame(&mut one, &mut []);
        assert_eq!(one, [[0.0, 0.0]]);
        put_in_frame(&mut [], &mut []);
    }
}
