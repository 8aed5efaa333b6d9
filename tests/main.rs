//! Tests of the whole: logs in, maps out.

mod golden;
