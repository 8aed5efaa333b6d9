//! A global map in a planner's hands: what is where, how things lie to each other, which way to go.
//!
//! Everything here reads a finished [`covimap_map::GlobalMap`] and changes nothing.
//!
//! - [`MapIndex`]: the map with its landmarks found by ID and by place. Immutable, so that threads share
//!   one behind an `Arc`. It answers what is near, what is next to what, left or right, in which order.
//! - [`Roads`]: lines of sight as roads, and ways over them. [`SearchGraph`] and [`RouteSearch`] let other planners
//!   walk over them.
//! - [`Localiser`]: where a robot is that sees these landmarks; [`Tracker`]: the same on the move.
//! - [`align()`]: the map in the frame and unit of known positions, distances or turns.
//! - [`explain`]: what holds a landmark in its place, and what would help.
//! - [`next_best`], [`forecast`], [`Explorer`]: where to go next so that the map gains most, and when to stop.
//!
//! # Example
//! ```
//! use std::sync::Arc;
//!
//! use covimap_map::{LogFormat, Mapper, MapperParams, SightingLog, Silent};
//! use covimap_plan::{MapIndex, RoadParams, Roads};
//!
//! // Four landmarks in a square; opposite corners are seldom seen together.
//! let text = "A B\nB C\nC D\nD A\nA B\nB C\nC D\nD A\nA B C\n";
//! let log = SightingLog::read_from(text.as_bytes(), "square", Some(LogFormat::Text), &Silent)?;
//! let index = MapIndex::new(Arc::new(Mapper::new(MapperParams::default())?.build(&log, &Silent)?));
//!
//! let near = index.nearest("B", 2)?;
//! assert!(near.iter().all(|near| ["A", "C"].contains(&index.name(near.landmark))));
//! // B and D are on different sides of the line from A to C.
//! assert_ne!(index.orientation("A", "C", "B")?.orientation, index.orientation("A", "C", "D")?.orientation);
//! // B was never seen with D: the way leads over a third.
//! let route = Roads::new(&index, RoadParams::default())?.route("B", "D")?;
//! assert_eq!(route.landmarks.len(), 3);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod align;
mod charts;
mod confidence;
mod delaunay;
mod error;
mod explain;
mod explore;
mod index;
mod localise;
mod names;
mod relations;
mod roads;
mod search;

#[cfg(test)]
mod fixtures;

pub use align::{Aligned, Known, KnownDistance, align};
pub use charts::Near;
pub use confidence::Covariance;
pub use error::PlanError;
pub use explain::{Advice, Explanation, Hold, explain};
pub use explore::{ExploreParams, Explorer, Forecast, Goal, Reason, forecast, next_best};
pub use index::MapIndex;
pub use localise::{Localiser, Location, Look, Mode, TrackParams, Tracker};
pub use names::LandmarkRef;
pub use relations::{Orientation, Turn};
pub use roads::{Objective, RoadParams, Roads, Route, Waypoint};
pub use search::{AStar, RouteSearch, SearchGraph};
