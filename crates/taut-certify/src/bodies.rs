//! Convex bodies inside a triangle mesh, and their certificate.

mod check;
mod violation;

use serde::{Deserialize, Serialize};
use taut_points::{Monitor, PointSource, PointsHash};

use crate::json::{hash_from_hex, hash_to_hex};
use crate::{Answer, CheckError};

pub(crate) use check::volume;
pub use violation::BodiesViolation;

/// Convex bodies inside a triangle mesh.
///
/// The rows of the source are the triangles of the mesh, of dimension 9: the coordinates of the first corner, the second and
/// the third. Corners with equal coordinates are one vertex, and a row of three such corners is a point that no body contains.
/// With the caps, which close its holes, the mesh is closed: each edge
/// belongs to an even number of triangles and caps. A point is inside when a ray from it crosses an odd number of triangles (even-odd
/// rule), however the triangles are turned.
///
/// Rows of dimension 10 have the number of a surface as their last one: 0 for the mesh, 1, 2, … for solids, −1 for walls and points. Each
/// solid is closed as the mesh is, and bodies are outside of it by the same rule. Walls and points have no inside; no body contains any part
/// of them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "inscribed bodies: an object with exponent, origin, disjoint, caps, at and bodies"
)]
pub struct InscribedBodies {
    /// The unit of the grid is 2^`exponent`, from −300 to 310.
    pub exponent: i32,
    /// The origin of the grid, in units.
    pub origin: [i64; 3],
    /// Whether no two bodies have an interior point in common.
    pub disjoint: bool,
    /// The triangles that close the mesh, if it has holes: each corner is one of the mesh, with number 3·row + corner.
    pub caps: Vec<[u64; 3]>,
    /// Points that the first bodies contain, one each, in the coordinates of the mesh.
    pub at: Vec<[f64; 3]>,
    /// Other ends of segments that the first bodies contain, one for each point in `at`; or none, also where a file says nothing of them.
    #[serde(default)]
    pub ends: Vec<[f64; 3]>,
    /// The bodies, in the order in which they were found.
    pub bodies: Vec<ConvexBody>,
}

/// The intersection of half-spaces with whole numbers: all points (`origin` + y)·2^`exponent` with `normals`ⱼ·y ≤ `offsets`ⱼ.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "a convex body: an object with normals, offsets and volume"
)]
pub struct ConvexBody {
    /// The normals: no two are equal, each without common divisor, with entries of at most 2¹⁶.
    pub normals: Vec<[i64; 3]>,
    /// The offsets, of at most 2⁴⁸, one for each normal.
    pub offsets: Vec<i64>,
    /// The volume, in the cube of the unit of the mesh. Accepted within 1e-9 of the volume found, relatively.
    pub volume: f64,
}

/// The proof that each body lies inside the mesh.
///
/// A body is the part of space where all `normals`ⱼ·y < `offsets`ⱼ hold. For weights λⱼ ≥ 0, not all 0, no point with
/// Σ λⱼ·(`normals`ⱼ·y − `offsets`ⱼ) ≥ 0 is in it. Where this holds at the three corners of a triangle it holds in all of the
/// triangle. One facet alone separates most triangles from a body; the checker finds these facets itself.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "the certificate of inscribed bodies: an object with proofs, pairs and points_hash"
)]
pub struct BodiesCertificate {
    /// One proof for each body.
    pub proofs: Vec<BodyProof>,
    /// If the bodies are disjoint, facets and weights for the pairs (0, 1), (0, 2), …, (1, 2), …: `[j₀, λ₀, j₁, λ₁, …]` with
    /// Σ λ·normal = 0 and Σ λ·offset ≤ 0. The facets of the second body of the pair count on from those of the first. Else empty.
    pub pairs: Vec<Vec<u64>>,
    /// The hash of the rows this was made for.
    #[serde(serialize_with = "hash_to_hex", deserialize_with = "hash_from_hex")]
    pub points_hash: PointsHash,
}

/// The proof that one body lies inside the mesh.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, expecting = "the proof of a body: an object with inside and combined")]
pub struct BodyProof {
    /// A point of the grid in the interior of the body, which is inside the mesh.
    pub inside: [i64; 3],
    /// Weights for each triangle that no facet alone separates from the body, by ascending rows: `[row, j₀, λ₀, j₁, λ₁, …]`
    /// with at most 4 facets and weights of 1 to 2⁵⁷. Caps count on from the rows.
    pub combined: Vec<Vec<u64>>,
}

/// What was proved of inscribed bodies: each lies inside the mesh with its caps, by the even-odd rule, outside of all solids, and no
/// triangle or point meets its interior.
///
/// Nothing is claimed about how large such bodies can be.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct BodiesVerdict {
    /// How many bodies there are.
    pub bodies: u64,
    /// Whether they are disjoint, which then was proved.
    pub disjoint: bool,
    /// How many caps close the mesh.
    pub caps: u64,
    /// How many rows are triangles of the mesh.
    pub triangles: u64,
    /// How many rows are points, which no body contains.
    pub points: u64,
    /// How many closed obstacles there are, which bodies are outside of.
    pub solids: u64,
    /// How many rows are triangles of obstacles that are not closed, which no body meets.
    pub walls: u64,
    /// How many points or segments given are in a body, the first in the first body and so on.
    pub at: u64,
    /// The sum of the volumes of the bodies is at least this.
    pub volume_lower: f64,
    /// The sum of the volumes of the bodies is at most this.
    pub volume_upper: f64,
    /// The volume of the largest body is at least this.
    pub largest: f64,
}

impl InscribedBodies {
    /// The half-spaces a·x ≤ b of a body in the coordinates of the mesh, as a and b in turn, with b rounded down. The body of
    /// these half-spaces lies in the body that was proved.
    ///
    /// ```
    /// use taut_certify::{ConvexBody, InscribedBodies};
    /// let body = ConvexBody { normals: vec![[1, 0, 0]], offsets: vec![3], volume: 0.0 };
    /// let answer = InscribedBodies { exponent: -1, origin: [5, 0, 0], disjoint: false, caps: vec![], at: vec![],
    ///     ends: vec![], bodies: vec![body] };
    /// assert_eq!(answer.half_spaces(&answer.bodies[0]), [([1.0, 0.0, 0.0], 4.0)]);
    /// ```
    pub fn half_spaces(&self, body: &ConvexBody) -> Vec<([f64; 3], f64)> {
        let unit = 2f64.powi(self.exponent);
        let of_facet = |(normal, &offset): (&[i64; 3], &i64)| {
            let shift =
                normal.iter().zip(&self.origin).map(|(&n, &o)| i128::from(n) * i128::from(o));
            let whole = i128::from(offset) + shift.sum::<i128>();
            let rounded = whole as f64;
            let is_above = rounded as i128 > whole;
            let rounded = if is_above { rounded.next_down() } else { rounded };
            (normal.map(|n| n as f64), rounded * unit)
        };
        body.normals.iter().zip(&body.offsets).map(of_facet).collect()
    }

    /// The vertices of a body in the coordinates of the mesh, each rounded to the nearest numbers; none for what is no body.
    pub fn vertices(&self, body: &ConvexBody) -> Vec<[f64; 3]> {
        check::volume::vertices(body).into_iter().map(|y| self.place(y)).collect()
    }

    /// The facets of a body as polygons in the coordinates of the mesh, rounded as the vertices are: counter-clockwise from
    /// outside, and empty for a facet that the others make redundant.
    pub fn polygons(&self, body: &ConvexBody) -> Vec<Vec<[f64; 3]>> {
        let placed = |polygon: Vec<_>| polygon.into_iter().map(|y| self.place(y)).collect();
        check::volume::polygons(body).into_iter().map(placed).collect()
    }

    fn place(&self, y: [f64; 3]) -> [f64; 3] {
        let unit = 2f64.powi(self.exponent);
        [0, 1, 2].map(|c| (self.origin[c] as f64 + y[c]) * unit)
    }
}

impl Answer for InscribedBodies {
    type Certificate = BodiesCertificate;
    type Verdict = BodiesVerdict;
    const KIND: &'static str = "inscribed-bodies";

    fn check(
        &self,
        certificate: &BodiesCertificate,
        source: &dyn PointSource,
        monitor: &Monitor<'_>,
    ) -> Result<BodiesVerdict, CheckError> {
        check::check(self, certificate, source, monitor)
    }
}
