//! The largest rectangle of any direction in a polygon, and its certificate.

mod check;
mod violation;

use serde::{Deserialize, Serialize};
use taut_points::{Monitor, PointSource, PointsHash};

use crate::json::{hash_from_hex, hash_to_hex};
use crate::{Answer, CheckError};

pub use violation::OrientedRectangleViolation;

/// A rectangle of any direction in a polygon: all c + x·a + y·r·a⊥ with x and y from −1 to 1, where a⊥ = (−a₂, a₁).
///
/// The rows of the source are the rings of the polygon, as for [`InscribedCircle`](crate::InscribedCircle).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "an inscribed oriented rectangle: an object with center, axis, ratio and area"
)]
pub struct InscribedOrientedRectangle {
    /// The center c.
    pub center: [f64; 2],
    /// Half of a longer side as a vector: a, from the center to the middle of a shorter side.
    pub axis: [f64; 2],
    /// The shorter side over the longer one: r, above 0 and at most 1.
    pub ratio: f64,
    /// The area 4·r·|a|², up to rounding.
    pub area: f64,
}

impl InscribedOrientedRectangle {
    /// Returns the four corners, counterclockwise and rounded.
    pub fn corners(&self) -> [[f64; 2]; 4] {
        let ([cx, cy], [ax, ay]) = (self.center, self.axis);
        let (bx, by) = (-self.ratio * ay, self.ratio * ax);
        [
            [cx - ax - bx, cy - ay - by],
            [cx + ax - bx, cy + ay - by],
            [cx + ax + bx, cy + ay + by],
            [cx - ax + bx, cy - ay + by],
        ]
    }
}

/// The proof that no rectangle is much larger: a subdivision of all rectangles into cells, each with the reason why no rectangle in it
/// has an area above (1 + gap)·area.
///
/// *Units.* Points are scaled by one power of two, so that the larger extent of the bounding box is in [1, 2), and shifted so that the
/// lower corner of the box is the origin; then `pivot` is subtracted.
///
/// *Cells.* A rectangle is {q : uₖ·q ≤ sₖ for k = 0, 1, 2, 3} with u₀ = (1, m), each next uₖ a quarter turn further, and a slope m in
/// [−1, 1]. A cell has ranges of m and of the four offsets sₖ. At the root these are [−1, 1] and [−2.25, 2.25]. Ranges of offsets are
/// contracted to what rectangles of more than the bound can have, none of whose sides is beyond the polygon. The *height* of a
/// point above side k is uₖ·q. A point is *surely below* a side if it is below it for all rectangles of the cell.
///
/// *Bounds.* If a point w of an edge is surely below all sides but side k, then uₖ·w ≥ sₖ. If a connected part of the boundary leads
/// around corner p, below the two sides that do not meet there, from beyond one side to beyond the other, then p is in each
/// half-plane n·p ≤ h that holds the part and whose normal n points away from the rectangle. The product
/// (s₀ + s₂)(s₁ + s₃) − U(1 + m²), where U is the bound, plus such terms with weights λ ≥ 0 is linear in each offset alone.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "the certificate of an inscribed oriented rectangle: an object with pivot, tree, leaves, gap and points_hash"
)]
pub struct OrientedRectangleCertificate {
    /// The point, in units, about which heights are measured; both coordinates are from 0 to 2.
    pub pivot: [f64; 2],
    /// The subdivision, depth first, one letter for each node. `0` to `3`: the range of that offset is split in the middle, `m`: that
    /// of the slope; the lower half follows, then the upper half. `s`: the ranges are empty. `b`: the next entry of `leaves`
    /// bounds the area. `e`: the next entry of `leaves` names a point of an edge that is surely below all sides. `w`, `x`, `y`, `z`:
    /// the corner between sides 0 and 1, 1 and 2, 2 and 3, or 3 and 0 is outside, `c`: the center is.
    pub tree: String,
    /// For each `e` of the tree `[edge, t]`, the point at t/2¹⁶ of the way along the edge that begins at a row. For each `b`
    /// `[k, part, part, …]`, each part with a weight λ = w/2ᵏ, w ≥ 1. `side, edge, t, w` with a side 0 to 3: the point is surely
    /// below all other sides. `4 + corner, edge, t, edge, t, x, y, w`: the part of the boundary from one point along the ring
    /// to another one, and a normal (x, y); corner k is between sides k and k + 1.
    pub leaves: Vec<Vec<i64>>,
    /// The gap proved: largest area ≤ (1 + gap)·area.
    pub gap: f64,
    /// The hash of the rows this was made for.
    #[serde(serialize_with = "hash_to_hex", deserialize_with = "hash_from_hex")]
    pub points_hash: PointsHash,
}

/// What was proved of an inscribed oriented rectangle.
///
/// A point is inside when the edges wind around it an odd number of times (even-odd rule), as for a circle in a polygon.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct OrientedRectangleVerdict {
    /// The area of the answer, rounded down: its center is inside, and no edge enters it.
    pub lower: f64,
    /// No rectangle whose inner points are inside, and that no edge enters, has an area above this.
    pub upper: f64,
    /// The gap of the certificate, for which all cells were checked.
    pub gap: f64,
}

impl Answer for InscribedOrientedRectangle {
    type Certificate = OrientedRectangleCertificate;
    type Verdict = OrientedRectangleVerdict;
    const KIND: &'static str = "inscribed-oriented-rectangle";

    fn check(
        &self,
        certificate: &OrientedRectangleCertificate,
        source: &dyn PointSource,
        monitor: &Monitor<'_>,
    ) -> Result<OrientedRectangleVerdict, CheckError> {
        check::check(self, certificate, source, monitor)
    }
}
