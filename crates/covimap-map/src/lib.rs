//! A log of which landmarks were seen together in, a global map out.

mod covisibility;
mod delaunay;
mod error;
pub mod evaluate;
pub mod export;
mod global_map;
mod landmarks;
mod map_file;
pub mod output;
mod params;
mod progress;
mod report;
mod truth;

pub use covisibility::CoVisibility;
pub use delaunay::delaunay_edges;
pub use error::MapError;
pub use global_map::{GlobalMap, PlacedLandmark};
pub use landmarks::{LandmarkId, LandmarkNames};
pub use params::{ClassicalParams, MapperParams, Method, Phi};
pub use progress::{Observer, Silent, Stage};
pub use report::{BuildReport, ComponentReport, Warning};
pub use truth::Truth;
