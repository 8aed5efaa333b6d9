//! A log of which landmarks were seen together in, a global map out.

mod covisibility;
mod error;
mod global_map;
mod landmarks;
mod params;
mod progress;
mod report;
mod sightings;

pub use covisibility::CoVisibility;
pub use error::MapError;
pub use global_map::{GlobalMap, PlacedLandmark};
pub use landmarks::{LandmarkId, LandmarkNames};
pub use params::{ClassicalParams, MapperParams, Method, Phi};
pub use progress::{Observer, Silent, Stage};
pub use report::{BuildReport, ComponentReport, Warning};
pub use sightings::{
    JsonlWriter, LogCheck, LogFormat, LogProblem, LogSummary, MAX_ID_BYTES, MAX_LINE_BYTES, SightingLog,
};
