//! The errors of drawing.

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
        /// The object that does not fit.
        what: &'static str,
        /// The number that the answer speaks of.
        expected: u64,
        /// The value that the points have.
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
        /// The value that was given.
        value: String,
        /// The values that would have been accepted.
        expected: &'static str,
    },
    /// The picture could not be made into pixels.
    #[error("the picture could not be made into PNG: {reason}")]
    Png {
        /// The message of the renderer.
        reason: String,
    },
    /// The points could not be read.
    #[error(transparent)]
    Read(#[from] ReadError),
}
