//! How a caller watches a build, and stops it.

use crate::MapError;

/// The stages of a build, in their order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Stage {
    /// Reading the log; counted in bytes.
    Read,
    /// Counting sightings and co-sightings; counted in landmarks.
    Count,
    /// Cutting the graph into overlapping regions; counted in steps, two a landmark.
    Regions,
    /// Solving each region; counted in regions.
    LocalMaps,
    /// Bringing the local maps into one frame; counted in steps, two a region.
    Stitch,
    /// Other layouts where hinges are many; counted in regions and in polishes of pieces.
    Variants,
    /// Taking twists out of the whole; counted in steps.
    Lift,
    /// Least stress over all links; counted in steps.
    Polish,
    /// Learning the distance function, and least stress again; counted in steps.
    Distances,
    /// Moving landmarks to where the log is most likely; counted in iterations.
    Refine,
    /// Fitting the ranges that the log tells; counted in rounds.
    Ranges,
    /// The paper's dense scaling.
    Classical,
    /// Learning the sensor that the finished map and the log imply; counted in sets of sightings, and in what takes as
    /// long.
    Sensor,
}

/// Is told how a build goes on. All methods may be called from several threads.
pub trait Observer: Sync {
    /// A stage starts; `total` is the amount of work in the stage's unit, where known.
    fn started(&self, stage: Stage, total: Option<u64>) {
        let _ = (stage, total);
    }
    /// `amount` more of the running stage's work is done.
    fn advanced(&self, amount: u64) {
        let _ = amount;
    }
    /// The running stage is done.
    fn finished(&self, stage: Stage) {
        let _ = stage;
    }
    /// Asked now and then: whether the build should stop with [`crate::MapError::Interrupted`].
    fn interrupted(&self) -> bool {
        false
    }
}

/// Watches nothing.
#[derive(Debug, Clone, Copy, Default)]
pub struct Silent;

impl Observer for Silent {}

/// Tells the observer of a stage, unless it asks to stop.
pub(crate) fn begin(stage: Stage, total: Option<u64>, observer: &dyn Observer) -> Result<(), MapError> {
    observer.started(stage, total);
    if observer.interrupted() { Err(MapError::Interrupted) } else { Ok(()) }
}
