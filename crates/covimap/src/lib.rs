//! covimap
