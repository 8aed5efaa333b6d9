//! A global map in a planner's hands: what is where, how things lie to each other, which way to go.
//!
//! Everything here reads a finished [`covimap_map::GlobalMap`] and changes nothing.
//!
//! - [`MapIndex`]: the map with its landmarks found by ID and by place. Immutable, so that threads share
//!   one behind an `Arc`. It answers what is near, what is next to what, left or right, in which order.
//! - [`Roads`]: lines of sight as roads, and ways over them. [`SearchGraph`] and [`RouteSearch`] let other planners
//!   walk over them.
//! - [`align()`]: the map in the frame and unit of known positions, distances or turns.
//! - [`explain`]: what holds a landmark in its place, and what would help.
//! - [`Localiser`]: where a robot is that sees these landmarks; [`Tracker`]: the same on the move.

mod align;
mod charts;
mod confidence;
mod delaunay;
mod error;
mod explain;
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
pub use index::MapIndex;
pub use localise::{Localiser, Location, Look, Mode, TrackParams, Tracker};
pub use names::LandmarkRef;
pub use relations::{Orientation, Turn};
pub use roads::{Objective, RoadParams, Roads, Route, Waypoint};
pub use search::{AStar, RouteSearch, SearchGraph};
