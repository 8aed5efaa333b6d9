//! The command line from outside: exit codes, messages, files.

mod bad_input;
mod build;
mod check;
mod demo;
mod evaluate;
mod export;
mod info;
mod interrupt;
mod output;
mod scratch;
mod streams;
mod usage;
