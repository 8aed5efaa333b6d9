//! Motions: how the robot goes from one observation to the next.

mod walker;
mod wander;

pub(crate) use walker::Walker;
pub(crate) use wander::Wander;
