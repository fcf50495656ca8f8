//! The largest triangle in a polygon, and its certificate.

mod check;
mod violation;

use serde::{Deserialize, Serialize};
use taut_points::{Monitor, PointSource, PointsHash};

use crate::json::{hash_from_hex, hash_to_hex};
use crate::{Answer, CheckError};

pub use violation::TriangleViolation;

/// A triangle in a polygon.
///
/// The rows of the source are the rings of the polygon, as for [`InscribedCircle`](crate::InscribedCircle).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "an inscribed triangle: an object with corners and area")]
pub struct InscribedTriangle {
    /// The corners, counterclockwise.
    pub corners: [[f64; 2]; 3],
    /// The area, up to rounding.
    pub area: f64,
}

/// The proof that no triangle in the polygon is much larger: a subdivision of all positions of the three corners into cells, each
/// with the reason why no triangle in it has a much larger area.
///
/// *Units.* The bounding box is shifted to the origin, and each axis is scaled by a power of two so that its extent is in [1, 2).
/// With a skew m ≠ 0 the second coordinate is then replaced by y + m·x, and shifted and scaled again. All triangles keep the ratios
/// of their areas.
///
/// *Cells.* A cell is a box for each corner of the triangle. Corners are counterclockwise, and corner 0 is a lowest one. A point is
/// *surely left* of a side if it is left of it for all positions of the two corners in their boxes.
///
/// *Bounds.* If a point w of an edge is surely left of two sides, it is not left of the third one, pq: (p − w) × (q − w) ≤ 0. A
/// half-plane that holds the part of the polygon in the box of a corner holds that corner. The doubled area plus such terms with
/// weights λ ≥ 0 is linear in each coordinate alone, so that it is largest where all corners are corners of their boxes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "the certificate of an inscribed triangle: an object with touching, skew, root, tree, leaves, gap and points_hash"
)]
pub struct TriangleCertificate {
    /// Edges that the triangle touches up to rounding and the gap, each by the row at which it begins, ascending.
    pub touching: Vec<u64>,
    /// The skew m of the units, −4 to 4.
    pub skew: f64,
    /// The lower and the upper corner of the box of each corner at the root of the tree, in units: the polygon lies in it.
    pub root: [[f64; 2]; 2],
    /// The subdivision, depth first, one letter for each node. `0` to `5`: the box of corner 0, 1, 2 is split in the middle, even
    /// digits along the first axis and odd ones along the second; the lower half follows, then the upper half. `a`: the boxes alone
    /// bound the area. `b`: the next entry of `leaves` bounds the area. `c`: the mean of the middles of the boxes is surely in the
    /// triangle and outside of the polygon. `e`: the next entry of `leaves` names a point of an edge that is surely in the triangle.
    /// `l`: corner 0 is not a lowest one. `o`: the box of some corner is outside.
    pub tree: String,
    /// For each `e` of the tree `[edge, t]`, the point at t/2¹⁶ of the way along the edge that begins at a row. For each `b`
    /// `[k, part, part, …]` with parts of four numbers `kind, x, y, w` and weights λ = w/2ᵏ, w ≥ 1. Kinds 0, 1, 2: the half-plane
    /// with the outer normal (x, y) that holds the part of the polygon in the box of that corner. Kinds 3, 4, 5: the point at y/2¹⁶ of
    /// the way along edge x, which is surely left of all sides but the one that begins at corner 0, 1, 2.
    pub leaves: Vec<Vec<i64>>,
    /// The gap claimed: largest area ≤ (1 + gap)·area. Accepted when the gap found is at most gap·(1 + 1e-9) + 4e-15.
    pub gap: f64,
    /// The hash of the rows this was made for.
    #[serde(serialize_with = "hash_to_hex", deserialize_with = "hash_from_hex")]
    pub points_hash: PointsHash,
}

/// What was proved of an inscribed triangle.
///
/// A point is inside when the edges wind around it an odd number of times (even-odd rule), as for a circle in a polygon.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct TriangleVerdict {
    /// The area of the answer, rounded down: its centroid is inside, and no edge enters the triangle.
    pub lower: f64,
    /// No triangle whose inner points are inside, and that no edge enters, has an area above this.
    pub upper: f64,
    /// `upper / lower − 1`, rounded up.
    pub gap: f64,
}

impl Answer for InscribedTriangle {
    type Certificate = TriangleCertificate;
    type Verdict = TriangleVerdict;
    const KIND: &'static str = "inscribed-triangle";

    fn check(
        &self,
        certificate: &TriangleCertificate,
        source: &dyn PointSource,
        monitor: &Monitor<'_>,
    ) -> Result<TriangleVerdict, CheckError> {
        check::check(self, certificate, source, monitor)
    }
}
