//! covimap-sim
