//! Points in the order of a curve, and its certificate.

mod cell;
mod check;

use serde::{Deserialize, Serialize};
use taut_points::{Monitor, PointSource, PointsHash, choice};

use crate::json::{hash_from_hex, hash_to_hex};
use crate::{Answer, CheckError};

/// A curve that visits the cells of a grid.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum OrderCurve {
    /// Cells that follow each other share a side.
    #[default]
    Hilbert,
    /// Z-order: the bits of the coordinates, interleaved.
    Morton,
}

choice! { "curve", OrderCurve {
    Hilbert = "hilbert", "steps are short: cells that follow each other share a side";
    Morton = "morton", "Z-order, the bits of coordinates interleaved: cells of a grid of any size are runs";
}}

/// The rows of a point set of the plane or of space in the order of a curve through them.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "an order: an object with curve and rows")]
pub struct Order {
    /// Which curve.
    pub curve: OrderCurve,
    /// The number of each row, from 0, in the order of the curve.
    pub rows: Vec<u64>,
}

/// The points that the order belongs to: it is a function of the points alone, and is proved from these.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the certificate of an order: an object with points_hash")]
pub struct OrderCertificate {
    /// The hash of the points this was made for.
    #[serde(serialize_with = "hash_to_hex", deserialize_with = "hash_from_hex")]
    pub points_hash: PointsHash,
}

/// The proved facts about an order: it is the one that the points have.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct OrderVerdict {
    /// Points.
    pub points: u64,
    /// Grids that were laid over the points and, within cells of many, again.
    pub grids: u64,
}

/// Why an order is wrong.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum OrderViolation {
    /// Points that are neither of the plane nor of space.
    #[error("orders are of the plane and of space, but points have dimension {dim}")]
    Dimension {
        /// Dimension of the points.
        dim: usize,
    },
    /// A row is missing, comes twice, or is none.
    #[error("place {place} of the order names row {row}: expected each of {points} rows once")]
    Row {
        /// The place, from 0.
        place: u64,
        /// The row that stands there.
        row: u64,
        /// The number of rows.
        points: u64,
    },
    /// A row comes too late.
    #[error("row {row} at place {place} belongs before the one it follows")]
    Descent {
        /// The place, from 0.
        place: u64,
        /// The row that stands there.
        row: u64,
    },
}

impl Answer for Order {
    type Certificate = OrderCertificate;
    type Verdict = OrderVerdict;
    const KIND: &'static str = "order";

    fn check(
        &self,
        certificate: &OrderCertificate,
        source: &dyn PointSource,
        monitor: &Monitor<'_>,
    ) -> Result<OrderVerdict, CheckError> {
        check::check(self, certificate, source, monitor)
    }
}
