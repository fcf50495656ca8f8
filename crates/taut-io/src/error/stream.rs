//! The error of rows that come in a stream.

/// What comes in a stream is no row of as many numbers as are expected.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{place}: {problem}")]
pub struct StreamRowError {
    /// The stream and the place in it.
    pub place: String,
    /// What is there.
    pub problem: String,
}
