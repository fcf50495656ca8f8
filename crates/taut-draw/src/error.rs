//! What drawing can refuse.

use taut_points::{ReadError, shown_number};

/// Why there is no picture.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// The points given are not those of the answer.
    #[error(
        "{what}: the answer has {expected}, the points have {found}; draw an answer with its own points"
    )]
    Mismatch {
        /// What does not fit.
        what: &'static str,
        /// What the answer speaks of.
        expected: u64,
        /// What the points have.
        found: u64,
    },
    /// A coordinate, a radius or a multiplier is NaN or infinite.
    #[error("{what} is {value}: only finite numbers can be drawn")]
    NonFinite {
        /// The number in question, with its place.
        what: String,
        /// Its value.
        value: f64,
    },
    /// A radius is below 0.
    #[error("{what} is {}: a radius is at least 0", shown_number(*value))]
    NegativeRadius {
        /// Which radius.
        what: String,
        /// Its value.
        value: f64,
    },
    /// An option is outside its range.
    #[error("option `{name}` is {value}: expected {expected}")]
    Option {
        /// The option.
        name: &'static str,
        /// What was given.
        value: String,
        /// What would have been accepted.
        expected: &'static str,
    },
    /// The picture could not be made into pixels.
    #[error("the picture could not be made into PNG: {reason}")]
    Png {
        /// What the renderer said.
        reason: String,
    },
    /// The points could not be read.
    #[error(transparent)]
    Read(#[from] ReadError),
}
