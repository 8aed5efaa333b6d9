//! Sensors: which landmarks are recognised from where.

mod range;

pub(crate) use range::RangeSensor;
