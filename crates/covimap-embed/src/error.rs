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
    /// A matrix that should be positive definite is not, or its factor failed the check.
    #[error(
        "a linear system of {order} unknowns is singular to working precision; the weights differ too much in size"
    )]
    Singular {
        /// Number of unknowns.
        order: usize,
    },
    /// Memory ran out.
    #[error("out of memory while {what} of order {order}; use fewer pairs or a larger machine")]
    OutOfMemory {
        /// What was being done.
        what: &'static str,
        /// Order of the matrix.
        order: usize,
    },
    /// A start configuration does not fit the problem.
    #[error(
        "start configuration: {what} - {found} points for {wanted} objects; give one finite point an object"
    )]
    BadStart {
        /// What is wrong.
        what: &'static str,
        /// Points given.
        found: usize,
        /// Objects of the problem.
        wanted: usize,
    },
    /// An entry of a distance table is not usable.
    #[error("distance of objects ({i}, {j}) is {distance}: {what}")]
    BadDistance {
        /// Row of the entry.
        i: usize,
        /// Column of the entry.
        j: usize,
        /// The entry.
        distance: f64,
        /// What is wrong and what is asked.
        what: &'static str,
    },
    /// A table has not as many entries as its number of objects asks.
    #[error("{entries} entries are no table of {n} objects; give {n} rows of {n}")]
    NotSquare {
        /// Number of objects.
        n: usize,
        /// Number of entries given.
        entries: usize,
    },
    /// A method that needs every distance was given an unknown one.
    #[error("nothing is known of pair ({i}, {j}); take the metric closure of one connected component first")]
    UnknownDistance {
        /// First object.
        i: usize,
        /// Second object.
        j: usize,
    },
    /// A pair of points is not usable.
    #[error("pair of points {index}: {what}")]
    BadCorrespondence {
        /// Position in the list.
        index: usize,
        /// What is wrong and what is asked.
        what: &'static str,
    },
    /// A fit was asked of fewer than two distinct points.
    #[error("{pairs} pairs of points coincide in one frame; a fit needs two distinct points in both")]
    CoincidingPoints {
        /// Number of pairs.
        pairs: usize,
    },
    /// Every rotation fits equally well.
    #[error("{pairs} pairs of points favour no rotation; allow reflection or give more pairs")]
    UndeterminedRotation {
        /// Number of pairs.
        pairs: usize,
    },
    /// An edge between two frames is not usable.
    #[error("edge {index}, from frame {a} to {b} of {nodes}: {what}")]
    BadRelativeFrame {
        /// Position in the list.
        index: usize,
        /// First node.
        a: u32,
        /// Second node.
        b: u32,
        /// Number of nodes.
        nodes: usize,
        /// What is wrong and what is asked.
        what: &'static str,
    },
    /// An observation of a regression is not usable.
    #[error("observation {index}: {what}")]
    BadObservation {
        /// Position in the list.
        index: usize,
        /// What is wrong and what is asked.
        what: &'static str,
    },
    /// Two lists that belong together differ in length.
    #[error("lists of {first} and {second} entries belong together; give as many of each")]
    Lengths {
        /// Length of the first list.
        first: usize,
        /// Length of the second list.
        second: usize,
    },
    /// A curve was asked over a range without extent.
    #[error("{values} values without two different ones span no range for a curve; give more values")]
    NoRange {
        /// Number of values.
        values: usize,
    },
    /// A monotone spline of degree 0 is no curve.
    #[error("a monotone spline has degree 1 or more, not 0; 2 is usual")]
    BadDegree,
}
