//! The largest rectangle along the axes in a polygon, and its certificate.

mod check;
mod violation;

use serde::{Deserialize, Serialize};
use taut_points::{Monitor, PointSource, PointsHash};

use crate::json::{hash_from_hex, hash_to_hex};
use crate::{Answer, CheckError};

pub use violation::RectangleViolation;

/// A rectangle with sides along the axes in a polygon.
///
/// The rows of the source are the rings of the polygon, as for [`InscribedCircle`](crate::InscribedCircle).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "an inscribed rectangle: an object with low, high and area"
)]
pub struct InscribedRectangle {
    /// The lower left corner.
    pub low: [f64; 2],
    /// The upper right corner.
    pub high: [f64; 2],
    /// The area, up to rounding.
    pub area: f64,
}

/// The proof that no rectangle along the axes is much larger: a subdivision of all pairs of a lower left and an upper right corner into
/// cells, each with the reason why no rectangle in it is inside and much larger.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "the certificate of an inscribed rectangle: an object with tree, edges, gap and points_hash"
)]
pub struct RectangleCertificate {
    /// The subdivision, depth first, one letter for each node. At the root both corners are anywhere in the bounding box.
    /// `l`, `b`, `r`, `t`: the range of the left, bottom, right or top side is split in the middle; the lower half follows, then the upper half.
    /// `m`: the area of the hull, which all rectangles of the cell lie in, is the bound. `e`: the next entry of `edges`
    /// enters the core, which they all contain. `1` to `4`: that corner, counterclockwise from the lower left, is outside.
    pub tree: String,
    /// For each `e` of the tree, the row at which the edge begins.
    pub edges: Vec<u64>,
    /// The gap claimed: largest area ≤ (1 + gap)·area. Accepted when the gap found is at most gap·(1 + 1e-9) + 4e-15.
    pub gap: f64,
    /// The hash of the rows this was made for.
    #[serde(serialize_with = "hash_to_hex", deserialize_with = "hash_from_hex")]
    pub points_hash: PointsHash,
}

/// What was proved of an inscribed rectangle.
///
/// A point is inside when the edges wind around it an odd number of times (even-odd rule), as for a circle in a polygon.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RectangleVerdict {
    /// The area of the answer, rounded down: it is inside, and no edge enters it.
    pub lower: f64,
    /// No rectangle along the axes inside has an area above this.
    pub upper: f64,
    /// `upper / lower − 1`, rounded up.
    pub gap: f64,
}

impl Answer for InscribedRectangle {
    type Certificate = RectangleCertificate;
    type Verdict = RectangleVerdict;
    const KIND: &'static str = "inscribed-rectangle";

    fn check(
        &self,
        certificate: &RectangleCertificate,
        source: &dyn PointSource,
        monitor: &Monitor<'_>,
    ) -> Result<RectangleVerdict, CheckError> {
        check::check(self, certificate, source, monitor)
    }
}
