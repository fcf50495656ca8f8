//! What can be wrong with a ball of a kernel.

use crate::Fault;

/// Why a ball of a kernel or its certificate is wrong.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum KernelBallViolation {
    /// A parameter of the kernel is out of its range.
    #[error("{name} of the kernel is {value:?}: expected {expected}")]
    Parameter {
        /// The parameter.
        name: &'static str,
        /// Its value.
        value: f64,
        /// The values that would have been accepted.
        expected: &'static str,
    },
    /// A precomputed kernel is no square matrix.
    #[error(
        "{rows} rows of {columns} columns are no precomputed kernel: it has one column for each row"
    )]
    NotSquare {
        /// Rows.
        rows: u64,
        /// Columns.
        columns: usize,
    },
    /// A precomputed kernel is not symmetric.
    #[error(
        "entry ({row}, {column}) of the precomputed kernel is {value:?}, but entry ({column}, {row}) is {other:?}"
    )]
    NotSymmetric {
        /// Row, from 0.
        row: u64,
        /// Column, from 0.
        column: u64,
        /// Its value.
        value: f64,
        /// The value of the entry across the diagonal.
        other: f64,
    },
    /// A precomputed kernel is no matrix of scalar products: K(x, x) + K(y, y) − 2K(x, y) is below 0 by more than rounding explains.
    #[error(
        "the precomputed kernel is not positive semidefinite: by it rows {row} and {column} have the squared distance {value:?}"
    )]
    Indefinite {
        /// Row, from 0.
        row: u64,
        /// The other row, from 0.
        column: u64,
        /// The squared distance.
        value: f64,
    },
    /// A number on the way to a distance exceeds the largest `f64`.
    #[error(
        "the squared distance of point {row} in the feature space is no number: scale the coordinates towards 1"
    )]
    Range {
        /// The row, from 0.
        row: u64,
    },
    /// A point is not proved to be inside.
    #[error(
        "point {row} lies at a squared distance of up to {squared_distance:?} from the center, outside the squared radius {squared_radius:?}"
    )]
    Outside {
        /// The row, from 0.
        row: u64,
        /// The squared distance, with all errors of rounding added.
        squared_distance: f64,
        /// R² as claimed.
        squared_radius: f64,
    },
}

impl KernelBallViolation {
    /// Returns what this violation blames.
    pub(crate) fn fault(&self) -> Fault {
        match *self {
            KernelBallViolation::Parameter { .. } => Fault::Answer,
            KernelBallViolation::NotSquare { .. } => Fault::Points,
            KernelBallViolation::NotSymmetric { row, .. }
            | KernelBallViolation::Indefinite { row, .. }
            | KernelBallViolation::Range { row }
            | KernelBallViolation::Outside { row, .. } => Fault::Row(row),
        }
    }
}
