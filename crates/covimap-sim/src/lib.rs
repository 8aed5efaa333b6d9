//! Worlds with known truth: landmarks, walls, robots and sensors, and the logs they give.

mod error;
mod floor_plan;
mod geometry;
mod grid;
mod landmarks;
mod log_writer;
mod motion;
mod seed;
mod sensor;
mod simulation;
mod spec;
mod world;

pub use error::SimError;
pub use floor_plan::{FloorPlan, Portal};
pub use geometry::{Point, Pose, Rect, Segment};
pub use log_writer::{LogWriter, write_truth};
pub use simulation::{Simulation, Step};
pub use spec::{Floor, RangeSpec, RunSpec, StepSpec, WorldSpec};
pub use world::World;
