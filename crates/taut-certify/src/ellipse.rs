//! The largest ellipse in a polygon, and its certificate.

mod check;
mod violation;

use serde::{Deserialize, Serialize};
use taut_points::{Monitor, PointSource, PointsHash};

use crate::json::{hash_from_hex, hash_to_hex};
use crate::{Answer, CheckError};

pub use violation::EllipseViolation;

/// An ellipse {c + Gz : |z| ≤ 1} in a polygon.
///
/// The rows of the source are the rings of the polygon, as for [`InscribedCircle`](crate::InscribedCircle).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "an inscribed ellipse: an object with center, axes and area"
)]
pub struct InscribedEllipse {
    /// The center c.
    pub center: [f64; 2],
    /// The rows of G, whose determinant is above 0.
    pub axes: [[f64; 2]; 2],
    /// π·det G, up to rounding.
    pub area: f64,
}

/// The proof that no ellipse in the polygon is much larger: a subdivision of all shapes and centers into cells, each with the
/// reason why no ellipse in it has a much larger area.
///
/// *Units.* The bounding box is shifted to the origin, and each axis is scaled by a power of two so that its extent is in [1, 2).
/// There the ellipse of shape (s, t), t > 0, with center c and size r is {p : |p − c| ≤ r} in the norm
/// |w|² = t·w₁² + (w₂ + s·w₁)²/t; its area is πr².
///
/// *Bounds.* An ellipse that no edge enters has at most the size Σ λᵢ·dist(c, eᵢ), for any edges and weights λᵢ ≥ 0 with
/// Σ λᵢ = 1, and distances in the norm of its shape. An ellipse in the polygon is at most as wide as the polygon in every
/// direction. A cell whose centers are all outside has no ellipse.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "the certificate of an inscribed ellipse: an object with touching, root, directions, tree, leaves, gap and points_hash"
)]
pub struct EllipseCertificate {
    /// Edges that the ellipse touches up to rounding and the gap, each by the row at which it begins, ascending.
    pub touching: Vec<u64>,
    /// Three exponents i, j, k of the root of the tree, −200 to 200: |s| ≤ 2ⁱ and 2ʲ ≤ t ≤ 2ᵏ.
    pub root: [i32; 3],
    /// Directions in which the width of the polygon bounds ellipses, besides the axes; at most 16, in units, their larger
    /// coordinate from ½ to 1 in size.
    pub directions: Vec<[f64; 2]>,
    /// The subdivision, depth first, one letter for each node. `s`, `t`, `x`, `y`: the cell is split, and the lower half follows,
    /// then the upper half. Ranges are split in the middle; that of t at a power of two while its ends are farther apart than
    /// a factor of two. `f`: the cell gets all centers; they have the coordinates x and y + m·x, m being the middle of the range of s.
    /// `n`: the widths bound the size. `o`: all centers are outside. `b`: the next entry of `leaves` bounds the size.
    pub tree: String,
    /// For each `b` of the tree, edges and weights: `[e₀, w₀, e₁, w₁, …]` with λᵢ = wᵢ/Σw and whole weights wᵢ ≥ 1. A weight
    /// that stands alone can be left out: `[e₀]`.
    pub leaves: Vec<Vec<u64>>,
    /// The gap claimed: largest area ≤ (1 + gap)·area. Accepted when the gap found is at most gap·(1 + 1e-9) + 4e-15.
    pub gap: f64,
    /// The hash of the rows this was made for.
    #[serde(serialize_with = "hash_to_hex", deserialize_with = "hash_from_hex")]
    pub points_hash: PointsHash,
}

/// What was proved of an inscribed ellipse.
///
/// A point is inside when the edges wind around it an odd number of times (even-odd rule), as for a circle in a polygon.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct EllipseVerdict {
    /// The area of the answer, rounded down: its center is inside, and no edge enters the ellipse.
    pub lower: f64,
    /// No ellipse with its center inside that no edge enters has an area above this.
    pub upper: f64,
    /// `upper / lower − 1`, rounded up.
    pub gap: f64,
}

impl Answer for InscribedEllipse {
    type Certificate = EllipseCertificate;
    type Verdict = EllipseVerdict;
    const KIND: &'static str = "inscribed-ellipse";

    fn check(
        &self,
        certificate: &EllipseCertificate,
        source: &dyn PointSource,
        monitor: &Monitor<'_>,
    ) -> Result<EllipseVerdict, CheckError> {
        check::check(self, certificate, source, monitor)
    }
}
