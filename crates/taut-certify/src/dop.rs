//! The bounding k-dop of points of space, and its certificate.

mod check;
mod shape;
mod violation;

use serde::{Deserialize, Serialize};
use taut_points::{Monitor, PointSource, PointsHash};

use crate::json::{hash_from_hex, hash_to_hex};
use crate::{Answer, CheckError};

pub use violation::DopViolation;

/// The smallest intersection of half-spaces with given normals that holds all points: all x with `normals`ⱼ·x ≤ `offsets`ⱼ.
///
/// The rows of the source are points of space, such as the vertices of a mesh.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "a bounding dop: an object with normals, offsets, vertices and volume"
)]
pub struct BoundingDop {
    /// The normals, with entries of −1, 0 and 1: no two are equal, and the six of the axes are among them.
    pub normals: Vec<[i64; 3]>,
    /// For each normal the largest `normals`ⱼ·p over all points p, rounded up to the next number.
    pub offsets: Vec<f64>,
    /// The vertices, rounded, each at least once. Accepted within 1e-9 of the longest side and 1e-15 of the largest coordinate.
    pub vertices: Vec<[f64; 3]>,
    /// The volume; 0 where the points lie in a plane with one of the normals. Accepted within 1e-9 of the volume found, relatively.
    pub volume: f64,
}

/// The proof that no facet of a bounding dop can move inward.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "the certificate of a bounding dop: an object with touching and points_hash"
)]
pub struct DopCertificate {
    /// For each facet a row that it touches.
    pub touching: Vec<u64>,
    /// The hash of the rows this was made for.
    #[serde(serialize_with = "hash_to_hex", deserialize_with = "hash_from_hex")]
    pub points_hash: PointsHash,
}

/// The proved facts about a bounding dop: it holds all rows, and each facet touches one, so that no smaller one has its normals.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct DopVerdict {
    /// How many facets it has, redundant ones among them.
    pub facets: u64,
    /// Its volume is at least this.
    pub volume_lower: f64,
    /// Its volume is at most this.
    pub volume_upper: f64,
}

impl BoundingDop {
    /// The numbers of directions that have a name: those of the axes (6), with the diagonals of a cube (14), with those of its
    /// faces (18), with both (26).
    pub const DIRECTIONS: [usize; 4] = [6, 14, 18, 26];

    /// The normals for one of [`DIRECTIONS`](Self::DIRECTIONS), each followed by its opposite; none for other numbers.
    ///
    /// ```
    /// use taut_certify::BoundingDop;
    /// assert_eq!(BoundingDop::directions(18)[..3], [[1, 0, 0], [-1, 0, 0], [0, 1, 0]]);
    /// ```
    pub fn directions(k: usize) -> Vec<[i64; 3]> {
        if !Self::DIRECTIONS.contains(&k) {
            return vec![];
        }
        const AXES: [[i64; 3]; 3] = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
        const CORNERS: [[i64; 3]; 4] = [[1, 1, 1], [1, 1, -1], [1, -1, 1], [1, -1, -1]];
        const EDGES: [[i64; 3]; 6] =
            [[1, 1, 0], [1, -1, 0], [1, 0, 1], [1, 0, -1], [0, 1, 1], [0, 1, -1]];
        let edges: &[[i64; 3]] = if k >= 18 { &EDGES } else { &[] };
        let corners: &[[i64; 3]] = if k == 14 || k == 26 { &CORNERS } else { &[] };
        let all = AXES.iter().chain(edges).chain(corners);
        all.flat_map(|u| [*u, u.map(|n| -n)]).collect()
    }

    /// The dop of some half-spaces, with its vertices and its volume.
    ///
    /// # Errors
    /// [`DopViolation`] for normals that are not as said above, and for offsets that are not finite, leave nothing, or are out of
    /// range.
    pub fn of_half_spaces(normals: Vec<[i64; 3]>, offsets: Vec<f64>) -> Result<Self, DopViolation> {
        let shape = shape::Shape::of(&normals, &offsets)?;
        let [lower, upper] = shape.volume();
        let volume = if lower > 0.0 { lower / 2.0 + upper / 2.0 } else { 0.0 };
        let vertices = shape.vertices();
        Ok(BoundingDop { normals, offsets, vertices, volume })
    }

    /// The facets as polygons, rounded: counter-clockwise from outside, and empty for a facet that the others make redundant. None
    /// for a dop of volume 0.
    pub fn polygons(&self) -> Vec<Vec<[f64; 3]>> {
        match shape::Shape::of(&self.normals, &self.offsets) {
            Ok(shape) if self.volume > 0.0 => shape.polygons(),
            _ => vec![],
        }
    }
}

impl Answer for BoundingDop {
    type Certificate = DopCertificate;
    type Verdict = DopVerdict;
    const KIND: &'static str = "bounding-dop";

    fn check(
        &self,
        certificate: &DopCertificate,
        source: &dyn PointSource,
        monitor: &Monitor<'_>,
    ) -> Result<DopVerdict, CheckError> {
        check::check(self, certificate, source, monitor)
    }
}
