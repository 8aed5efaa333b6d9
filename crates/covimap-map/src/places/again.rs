//! Refinement of some landmarks among others whose places are settled.

use covimap_embed::Point;

use super::posterior::Neighbours;
use super::{Model, STILL, SeenSets, landmark_scores};
use crate::{LinkGraph, MapError, Observer};

/// Landmarks after a refinement of some; the entries of the others are as they were given.
pub(crate) struct Again {
    pub points: Vec<Point>,
    pub detectability: Vec<f64>,
    /// Standard deviation of a coordinate against the neighbours; of the free landmarks only.
    pub deviation: Vec<f64>,
}

/// Moves the `free` landmarks of a graph to where the log is most likely; the sensor and all other landmarks
/// stay as they are.
///
/// `sets` need only be those that tell of a free landmark, by showing it or by missing it; the graph must hold all
/// that they show and all that is linked to that.
pub(crate) fn refine_some(
    graph: &LinkGraph,
    sets: &SeenSets,
    mut model: Model,
    free: &[bool],
    iterations: usize,
    observer: &dyn Observer,
) -> Result<Again, MapError> {
    let neighbours = Neighbours::new(graph);
    let mut scores = landmark_scores(&neighbours, sets, &model, |_| (), observer)?;
    for _ in 0..iterations {
        let moved = model.move_landmarks(&scores, |landmark| free[landmark]);
        observer.advanced(1);
        if moved < STILL {
            break;
        }
        scores = landmark_scores(&neighbours, sets, &model, |_| (), observer)?;
    }
    let deviation = scores.iter().map(|scores| scores.deviation(model.sensor.range)).collect();
    Ok(Again { points: model.points, detectability: model.detectability, deviation })
}
