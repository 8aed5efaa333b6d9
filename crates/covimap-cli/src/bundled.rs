//! Logs that are built in; where they are from stands in `data/README.md`.

/// Five camera robots among 15 barcoded posts, JSONL.
pub const ROBOT_LOG: &[u8] = include_bytes!("../data/mrclam-1.jsonl");
/// Where the posts stand, CSV.
pub const ROBOT_TRUTH: &[u8] = include_bytes!("../data/mrclam-1.truth.csv");
/// Ten lists of coloured cylinders, table V (a) of the CoviMap paper, JSONL.
pub const PAPER_TRIAL: &[u8] = include_bytes!("../data/paper-trial-1.jsonl");
