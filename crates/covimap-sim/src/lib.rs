//! Worlds with known truth: landmarks, walls, robots and sensors, and the logs they give.
//!
//! A [`WorldSpec`] and a seed make a [`World`]; a [`RunSpec`] and a seed send a robot through it. A
//! [`Simulation`] gives one [`Step`] after another, so that a log may be longer than memory;
//! a [`Rover`] goes where somebody else tells it to;
//! [`Simulation::record`] keeps a [`Recording`] instead, and [`write_files`] writes log and truth. The same
//! specifications and seeds give the same steps. Lengths are metres, angles [`Angle`]s.
//!
//! ```
//! use covimap_sim::{SimSpec, Simulation, World};
//!
//! let spec = SimSpec::paper_room(15, 1.5, 300);
//! let world = World::new(&spec.world, 7)?;
//! let recording = Simulation::new(&world, &spec.run, 7)?.record();
//! assert_eq!(recording.len(), 300);
//! # Ok::<(), covimap_sim::SimError>(())
//! ```

pub mod fixtures;

mod angle;
mod error;
mod files;
mod floor_plan;
mod geometry;
mod grid;
mod landmarks;
mod motion;
mod recording;
mod rover;
mod seed;
mod sensor;
mod simulation;
mod spec;
mod tally;
mod world;

pub use angle::Angle;
pub use error::SimError;
pub use files::{OBSERVATIONS, TRUTH, write_files, write_truth};
pub use floor_plan::{FloorPlan, Portal};
pub use geometry::{Point, Pose, Rect, Segment};
pub use recording::{Recording, Step};
pub use rover::Rover;
pub use simulation::Simulation;
pub use spec::{ErrorSpec, Floor, Motion, Recognition, RunSpec, SensorSpec, SimSpec, StepSpec, WorldSpec};
pub use tally::Summary;
pub use world::World;
