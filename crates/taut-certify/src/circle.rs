//! The largest circle in a polygon, and its certificate.

mod check;
mod violation;

use serde::{Deserialize, Serialize};
use taut_points::{Monitor, PointSource, PointsHash};

use crate::json::{hash_from_hex, hash_to_hex};
use crate::{Answer, CheckError};

pub use violation::CircleViolation;

/// A circle in a polygon.
///
/// The rows (x, y) of the source are the vertices of one ring in order; rows (x, y, r) are those of several rings, r being the
/// number of the ring: 0 in the first row, then that of the row before or one more. Edge i leads from row i to the next row of its
/// ring, from the last one to the first. A row may repeat the one before it, and the last row of a ring its first.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "an inscribed circle: an object with center and radius")]
pub struct InscribedCircle {
    /// The center.
    pub center: [f64; 2],
    /// The radius, above 0.
    pub radius: f64,
}

/// The proof that no circle in the polygon is much larger: a subdivision of the bounding box into cells, each with the reason
/// why no center in it has a much larger clearance.
///
/// The clearance of a point is its distance to the nearest edge. For any edges eᵢ and weights λᵢ ≥ 0 with Σ λᵢ = 1 the clearance
/// of q is at most Σ λᵢ·dist(q, eᵢ). That sum is a convex function of q, so that over a cell it is largest at a corner. A cell
/// that no edge meets and that has a corner outside the polygon holds no center at all.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "the certificate of an inscribed circle: an object with touching, tree, leaves, gap and points_hash"
)]
pub struct CircleCertificate {
    /// Edges that the circle touches up to rounding, each by the row at which it begins, ascending.
    pub touching: Vec<u64>,
    /// The subdivision, depth first, one letter for each node. `x`, `y`: the cell is split at the middle of its extent in x or
    /// y; the lower half follows, then the upper half. `o`: no edge meets the cell, which is outside. `b`: the next entry of
    /// `leaves` bounds the clearance. The root is the bounding box of the vertices.
    pub tree: String,
    /// For each `b` of the tree, edges and weights: `[e₀, w₀, e₁, w₁, …]` with λᵢ = wᵢ/Σw and whole weights wᵢ ≥ 1. A weight
    /// that stands alone can be left out: `[e₀]`.
    pub leaves: Vec<Vec<u64>>,
    /// The gap claimed: largest radius ≤ (1 + gap)·`radius`. Accepted when the gap found is at most gap·(1 + 1e-9) + 4e-15.
    pub gap: f64,
    /// The hash of the rows this was made for.
    #[serde(serialize_with = "hash_to_hex", deserialize_with = "hash_from_hex")]
    pub points_hash: PointsHash,
}

/// The proved facts about an inscribed circle.
///
/// A point is inside when the edges wind around it an odd number of times (even-odd rule). For rings that neither meet nor
/// touch, these are the points inside the polygon, holes being outside; the checker does not prove that they are such rings.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct CircleVerdict {
    /// The radius of the answer: its center is inside, and no edge enters the circle.
    pub lower: f64,
    /// No circle with its center inside that no edge enters has a radius above this.
    pub upper: f64,
    /// `upper / lower − 1`, rounded up.
    pub gap: f64,
}

impl Answer for InscribedCircle {
    type Certificate = CircleCertificate;
    type Verdict = CircleVerdict;
    const KIND: &'static str = "inscribed-circle";

    fn check(
        &self,
        certificate: &CircleCertificate,
        source: &dyn PointSource,
        monitor: &Monitor<'_>,
    ) -> Result<CircleVerdict, CheckError> {
        check::check(self, certificate, source, monitor)
    }
}
