//! Stitching: local maps into one frame.

mod seams;

use covimap_embed::Point;

use crate::{LinkGraph, LocalMap, MapError, RegionCover};

pub(crate) fn stitch(
    graph: &LinkGraph,
    cover: &RegionCover,
    maps: &[LocalMap],
) -> Result<Vec<Point>, MapError> {
    let _seams = seams::find(graph, cover, maps);
    Ok(maps[0].points.clone())
}
