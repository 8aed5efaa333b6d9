//! What can go wrong between distances and coordinates.

/// Why an embedding could not be computed.
///
/// Not converging is no error: it is a value of the result.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum EmbedError {
    /// A pair of the list is not usable.
    #[error("pair ({i}, {j}) of {n} objects: {what}")]
    BadPair {
        /// First object.
        i: u32,
        /// Second object.
        j: u32,
        /// Number of objects.
        n: usize,
        /// What is wrong and what is asked.
        what: &'static str,
    },
}
