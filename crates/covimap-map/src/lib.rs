//! A log of which landmarks were seen together in, a global map out.

mod covisibility;
mod delaunay;
mod error;
pub mod evaluate;
mod global_map;
mod landmarks;
mod links;
mod map_file;
pub mod output;
mod params;
mod progress;
mod regions;
mod report;
mod truth;
mod sightings;

pub use covisibility::CoVisibility;
pub use delaunay::delaunay_edges;
pub use error::MapError;
pub use global_map::{GlobalMap, PlacedLandmark};
pub use landmarks::{LandmarkId, LandmarkNames};
pub use links::{Link, LinkGraph};
pub use params::{ClassicalParams, MapperParams, Method, Phi};
pub use progress::{Observer, Silent, Stage};
pub use regions::{Region, RegionCover};
pub use report::{BuildReport, ComponentReport, Warning};
pub use truth::Truth;
pub use sightings::{
    JsonlWriter, LogCheck, LogFormat, LogProblem, LogSummary, MAX_ID_BYTES, MAX_LINE_BYTES, SightingLog,
};
