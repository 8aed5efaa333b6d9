//! A global map in a planner's hands: what is where, how things lie to each other, which way to go.
//!
//! Everything here reads a finished [`covimap_map::GlobalMap`] and changes nothing.
//!
//! - [`MapIndex`]: the map with its landmarks found by ID. Immutable, so that threads share one
//!   behind an `Arc`.
//! - [`Localiser`]: where a robot is that sees these landmarks.

mod error;
mod index;
mod localise;
mod names;

pub use error::PlanError;
pub use index::{LandmarkRef, MapIndex};
pub use localise::{Localiser, Location, Look, Mode};
