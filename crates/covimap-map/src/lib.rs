//! A log of which landmarks were seen together in, a global map out.

mod covisibility;
mod error;
mod global_map;
mod landmarks;
mod links;
mod params;
mod progress;
mod regions;
mod report;

pub use covisibility::CoVisibility;
pub use error::MapError;
pub use global_map::{GlobalMap, PlacedLandmark};
pub use landmarks::{LandmarkId, LandmarkNames};
pub use links::{Link, LinkGraph};
pub use params::{ClassicalParams, MapperParams, Method, Phi};
pub use progress::{Observer, Silent, Stage};
pub use regions::{Region, RegionCover};
pub use report::{BuildReport, ComponentReport, Warning};
