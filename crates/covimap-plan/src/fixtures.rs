//! Small maps, for unit tests.
