//! What can go wrong between a log and a map.

use std::path::PathBuf;

use covimap_embed::{EmbedError, Point};

/// Why a log could not be read or a map not be built, read or written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MapError {
    /// A range to a landmark that its step does not show, or that is no length.
    #[error(
        "the range of step {step} to landmark {landmark} is {metres}; give metres above 0, to landmarks that the step \
         shows"
    )]
    BadRange {
        /// Step, counted from 0.
        step: usize,
        /// Number of the landmark.
        landmark: u32,
        /// The range.
        metres: f64,
    },
    /// A line of an input file does not say what its format asks.
    #[error("{file}:{line}: {what}")]
    BadLine {
        /// File as the user named it, `<stdin>` for standard input.
        file: String,
        /// Line, counted from 1.
        line: u64,
        /// What is wrong; what to do.
        what: String,
    },
    /// An input file could not be opened or read.
    #[error("{}: {what}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What was tried and what to do.
        what: String,
        /// The system's own words.
        #[source]
        source: std::io::Error,
    },
    /// An output file could not be written.
    #[error("{}: cannot be written: {what}", path.display())]
    Unwritable {
        /// The file; `-` for standard output.
        path: PathBuf,
        /// Why, and what to do.
        what: String,
        /// The system's own words.
        #[source]
        source: std::io::Error,
    },
    /// A map file of a format that this build cannot read.
    #[error(
        "{file}: map file is format {found}, this build reads {known}; use the covimap that wrote it or build \
         the map again"
    )]
    MapFormat {
        /// File as the user named it.
        file: String,
        /// Format number of the file.
        found: u64,
        /// Format number that this build reads.
        known: u64,
    },
    /// A binary map file that is not as it was written.
    #[error("{file}: the map file is damaged, {what}; copy it again or build the map again")]
    DamagedMap {
        /// File as the user named it.
        file: String,
        /// What is wrong with it.
        what: String,
    },
    /// A state of a format that this build cannot read.
    #[error(
        "{file}: state is format {found}, this build reads {known}; use the covimap that wrote it or build again \
         with --state"
    )]
    StateFormat {
        /// File as the user named it.
        file: String,
        /// Format number of the file.
        found: u32,
        /// Format number that this build reads.
        known: u32,
    },
    /// A file that is no state, or a state that is not as it was written.
    #[error("{file}: no whole state, {what}; give one that `covimap build --state` wrote, or build again")]
    DamagedState {
        /// File as the user named it.
        file: String,
        /// What is wrong with it.
        what: String,
    },
    /// A component without a road makes no route graph.
    #[error(
        "component {component} of the map has no line of sight, so there is no route in it; give another component, or \
         build a map that holds none at all again from its log"
    )]
    NoRouteGraph {
        /// The component.
        component: u32,
    },
    /// Parts of a map that contradict each other.
    #[error("{what}")]
    InvalidMap {
        /// Which landmark or setting is wrong; what to do.
        what: String,
    },
    /// A point that is nowhere.
    #[error("point {index} is at ({}, {}), positions must be finite; leave it out", position[0], position[1])]
    NotFinite {
        /// Index of the point in its list.
        index: usize,
        /// Its coordinates.
        position: Point,
    },
    /// Neither the name nor the first bytes of a log tell its format.
    #[error(
        "{file}: cannot tell the log format from the name or the first line; \
         name it (--format jsonl, csv or text)"
    )]
    UnknownFormat {
        /// File as the user named it, `<stdin>` for standard input.
        file: String,
    },
    /// A log was read to its end without a step.
    #[error("{sources}: no step in the log; a step is a line like {{\"t\": 12.5, \"seen\": [\"A\", \"B\"]}}")]
    NoSteps {
        /// The files read, as the user named them.
        sources: String,
    },
    /// A log has more steps than can be counted.
    #[error("the log has {steps} steps, at most {limit} can be counted; split it", limit = u32::MAX)]
    TooManySteps {
        /// Steps of the log.
        steps: usize,
    },
    /// Counts given by the caller contradict each other.
    #[error("{what}")]
    BadCounts {
        /// Which, and what is asked.
        what: String,
    },
    /// The caller's [`crate::Observer`] asked to stop.
    #[error("interrupted")]
    Interrupted,
    /// A setting is out of its range.
    #[error("setting {name} is {value}; give {wanted}")]
    BadParameter {
        /// Name of the setting, as in the map file.
        name: &'static str,
        /// Its value.
        value: f64,
        /// What is accepted.
        wanted: &'static str,
    },
    /// No two landmarks were ever seen together.
    #[error(
        "no step shows two landmarks - {landmarks} landmarks in {steps} steps; pool several sightings of a slow \
         or narrow sensor into one step"
    )]
    NothingTogether {
        /// Steps of the log.
        steps: u64,
        /// Landmarks of the log.
        landmarks: usize,
    },
    /// All landmarks are always seen together: nothing tells where they are.
    #[error(
        "all {landmarks} landmarks are seen in the same {steps} steps, so nothing tells how far apart they are; \
         limit the range of the sensor or move the robot further"
    )]
    NoInformation {
        /// Landmarks of the log.
        landmarks: usize,
        /// Steps that show them.
        steps: u32,
    },
    /// A component is too large for the dense method.
    #[error(
        "the classical method is dense and takes at most {limit} landmarks, here are {landmarks}; use --method auto"
    )]
    TooLargeForClassical {
        /// Landmarks of the component.
        landmarks: usize,
        /// Most that the method takes.
        limit: usize,
    },
    /// A map and a truth without a landmark in common.
    #[error(
        "no landmark of the map is in the truth: the map has {} such as {:?}, the truth {} such as {:?}; give both \
         the same IDs", map.0, map.1, truth.0, truth.1
    )]
    NoCommonLandmarks {
        /// Landmarks of the map, and the first ID.
        map: (usize, String),
        /// Landmarks of the truth, and the first ID.
        truth: (usize, String),
    },
    /// Too few landmarks in common for any measure.
    #[error(
        "map and truth share {common} landmarks, but no component of the map has {fewest} of them; survey more \
         landmarks of one component"
    )]
    TooFewCommon {
        /// Landmarks in both.
        common: usize,
        /// Fewest that a component needs.
        fewest: usize,
    },
    /// A build is expected to take more memory than it may.
    #[error(
        "the build may take {} MB of memory, {} MB are allowed - {landmarks} landmarks, about {pairs} pairs; \
         allow more or map parts of the log", needed.div_ceil(1_000_000), allowed / 1_000_000
    )]
    TooLittleMemory {
        /// Bytes expected at the peak.
        needed: u64,
        /// Bytes allowed.
        allowed: u64,
        /// Landmarks of the log.
        landmarks: u64,
        /// Pairs seen together, estimated.
        pairs: u64,
    },
    /// A log that a map was not made of.
    #[error(
        "the map was not made of this log: {id:?} is in one of the two only, the map has {map} landmarks and the \
         log {log}; give the log that the map was made of"
    )]
    OtherLog {
        /// A landmark that one of the two lacks.
        id: String,
        /// Landmarks of the map.
        map: usize,
        /// Landmarks of the log.
        log: usize,
    },
    /// A fit or an embedding that the numbers do not allow.
    #[error(transparent)]
    Embed(#[from] EmbedError),
}
