//! The covimap command line.
fn main() {}
