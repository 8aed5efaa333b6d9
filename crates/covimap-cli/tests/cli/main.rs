//! The command line from outside: exit codes, messages, files.

// Clippy takes only functions marked as tests for tests.
#![allow(clippy::unwrap_used)]

mod bad_input;
mod build;
mod check;
mod demo;
mod evaluate;
mod export;
mod info;
mod interrupt;
mod output;
mod questions;
mod readme;
mod reproduce;
mod scratch;
mod simulate;
mod streams;
mod update;
mod usage;
