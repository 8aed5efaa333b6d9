//! What a build says about the map it made. Part of the map file, so it holds nothing that
//! changes from run to run (times go to the [`crate::Observer`]).

mod seams;
mod update;
mod warnings;

use serde::{Deserialize, Serialize};

use crate::{DistanceReport, RangeReport};
pub(crate) use seams::joined_seams;
pub use seams::{Hinge, SeamReport, SeamsReport};
pub use update::UpdateReport;
pub(crate) use warnings::{aliases_warning, carried_warning, warnings};

use crate::HonestyReport;

/// A finding that a reader of the map should know of.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Warning {
    /// Stable name of the kind, such as `seen_once`; explained in `docs/warnings.md`.
    pub kind: String,
    /// How many landmarks (or pairs, or regions) it is about.
    pub count: u64,
    /// String IDs of the first few of them.
    pub examples: Vec<String>,
    /// One sentence: what it means and what would help.
    pub message: String,
}

/// One connected part of the co-visibility graph: a chart of its own.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct ComponentReport {
    /// Number of landmarks.
    pub landmarks: u64,
    /// Number of regions.
    pub regions: u64,
    /// Number of linked pairs.
    pub pairs: u64,
    /// Kruskal's stress-1 of the final positions over those pairs; 0 is perfect.
    pub stress1: f64,
    /// Newton steps of the polish.
    pub iterations: u64,
    /// Whether the polish met its tolerance.
    pub converged: bool,
    /// Frequencies and distances; none of the classical method, and of components with fewer than
    /// three pairs a landmark.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub distances: Option<DistanceReport>,
    /// Weight of path lengths against links, 0 where links alone made the map. Where landmarks have few
    /// links and most sides are guesses, path lengths keep the map open.
    #[serde(default)]
    pub path_pull: f64,
    /// Whether its links fit no distances in a plane, so that paths by the odds against being seen together made
    /// the map.
    #[serde(default)]
    pub network: bool,
    /// What its ranges came to; none if the log has too few. Then positions are in metres.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ranges: Option<RangeReport>,
    /// How its regions hang together.
    #[serde(default)]
    pub seams: SeamsReport,
}

/// What was read, what was built, and how good it is.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct BuildReport {
    /// Steps of the log, empty ones included.
    pub steps: u64,
    /// Sightings of the log, duplicates within a step counted once.
    pub sightings: u64,
    /// Landmarks seen at least once.
    pub landmarks: u64,
    /// Pairs that are linked: seen together, and not set aside.
    pub pairs: u64,
    /// What the log says of recognition errors.
    #[serde(default)]
    pub honesty: HonestyReport,
    /// Regions over all components.
    pub regions: u64,
    /// Stress-1 over all components.
    pub stress1: f64,
    /// The components, largest first.
    pub components: Vec<ComponentReport>,
    /// What the last update did, if there was one since the build.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub update: Option<UpdateReport>,
    /// What the reader should know.
    pub warnings: Vec<Warning>,
}
