//! Errors of points that are kept by a box or a grid.

/// Why no points are kept of a file.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FilterError {
    /// A box or a grid does not fit the points.
    #[error("{path}: option `{option}`: expected {expected}")]
    Option {
        /// The file.
        path: String,
        /// `bounds` or `thin`.
        option: &'static str,
        /// What it must be.
        expected: String,
    },
    /// A coordinate is not finite, so that no box or cell holds the point.
    #[error("{path}: row {row}: coordinate {column} is {value}: all coordinates must be finite")]
    Value {
        /// The file.
        path: String,
        /// The row, from 1.
        row: u64,
        /// The coordinate, from 0.
        column: usize,
        /// The value as shown.
        value: String,
    },
    /// The table of the cells of a grid takes more than the memory that was allowed.
    #[error(
        "{path}: at row {row} the cells of the grid take more than {memory} bytes: allow more memory, or larger cells"
    )]
    Memory {
        /// The file.
        path: String,
        /// The row, from 1.
        row: u64,
        /// Bytes that are allowed.
        memory: u64,
    },
    /// No point of a file is within the box.
    #[error("{path}: no point is within the bounds: choose others")]
    NothingKept {
        /// The file.
        path: String,
    },
    /// Rows that lack a value are left out, and that leaves none.
    #[error(
        "{path}: each of its {rows} rows lacks a value, so that none is left: choose the columns that are coordinates"
    )]
    NoCompleteRows {
        /// The file.
        path: String,
        /// The number of rows.
        rows: u64,
    },
    /// No point of a laser scan has one of the classes that are wanted.
    #[error(
        "{path}: no point is of class {}: the classes of its points are {}", listed(.wanted), listed(.found)
    )]
    NothingOfClasses {
        /// The file.
        path: String,
        /// The classes that are wanted.
        wanted: Vec<u8>,
        /// The classes of its points, ascending.
        found: Vec<u8>,
    },
}

/// Classes as the command line takes them.
fn listed(classes: &[u8]) -> String {
    classes.iter().map(u8::to_string).collect::<Vec<_>>().join(",")
}
