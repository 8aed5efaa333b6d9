//! A log of which landmarks were seen together in, a global map out.

mod aliases;
mod assembly;
mod bytes;
mod classical;
mod component;
mod covisibility;
mod delaunay;
mod distances;
mod error;
pub mod evaluate;
pub mod export;
#[cfg(test)]
mod fixtures;
mod global_map;
mod honesty;
mod landmarks;
mod layout;
mod likelihood;
mod links;
mod local_map;
mod map_file;
mod mapper;
mod memory;
mod network;
pub mod output;
mod params;
mod places;
mod progress;
mod ranges;
mod regions;
mod report;
mod sensing;
mod settle;
mod shape;
mod sight_lines;
mod sightings;
mod state;
mod stitch;
mod surveyor;
mod truth;
mod update;
mod variants;

pub use classical::{CLASSICAL_LIMIT, squared_distances};
pub use covisibility::CoVisibility;
pub use delaunay::delaunay_edges;
pub use distances::{DistanceReport, FamilyScore, ShepardRow};
pub use error::MapError;
pub use global_map::{ChartFit, GlobalMap, PlacedLandmark};
pub use honesty::{HonestLinks, HonestyReport};
pub use landmarks::{LandmarkId, LandmarkNames};
pub use links::{Link, LinkGraph};
pub use local_map::LocalMap;
pub use mapper::Mapper;
pub use memory::MemoryEstimate;
pub use params::{
    AutoParams, ClassicalParams, DistanceChoice, MapperParams, Method, Phi, RegionParams, StopParams,
};
pub use progress::{Observer, Silent, Stage};
pub use ranges::RangeReport;
pub use regions::{Region, RegionCover};
pub use report::{BuildReport, ComponentReport, Hinge, SeamReport, SeamsReport, UpdateReport, Warning};
pub use sensing::{Sensed, Sensing, SensorModel};
pub use sight_lines::{SightLine, SightLines};
pub use sightings::{
    JsonlWriter, LogCheck, LogFormat, LogProblem, LogSummary, MAX_ID_BYTES, MAX_LINE_BYTES, Range,
    SightingLog,
};
pub use state::MapState;
pub use truth::Truth;
