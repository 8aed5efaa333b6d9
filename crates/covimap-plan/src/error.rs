//! What can go wrong between a map and an answer.

/// Why a question could not be answered.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PlanError {
    /// An ID that the map does not have.
    #[error("the map has no landmark {id:?}{}", hint(.nearest))]
    UnknownLandmark {
        /// The ID asked for.
        id: String,
        /// The most similar ID of the map, if one is similar.
        nearest: Option<String>,
    },
    /// A number that no landmark of the map has.
    #[error("the map has no landmark number {number}, it has {landmarks}; numbers count from 0")]
    UnknownNumber {
        /// The number asked for.
        number: u32,
        /// Landmarks of the map.
        landmarks: usize,
    },
    /// A map that does not know from where its landmarks are seen.
    #[error(
        "the map of {landmarks} landmarks does not know its sensor, so that no place can be told; build it again, from \
         a log with three or more landmarks in one component"
    )]
    NoSensor {
        /// Landmarks of the map.
        landmarks: usize,
    },
}

fn hint(nearest: &Option<String>) -> String {
    match nearest {
        Some(nearest) => format!("; did you mean {nearest:?}?"),
        None => "; `covimap export --to csv` lists the IDs".to_owned(),
    }
}
