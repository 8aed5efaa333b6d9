//! Tests of the whole: logs in, maps out.

// Clippy takes only functions marked as tests for tests.
#![allow(clippy::unwrap_used)]

mod documents;
mod exploration;
mod golden;
mod localisation;
mod pipeline;
mod quality;
