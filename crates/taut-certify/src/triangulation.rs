//! The Delaunay triangulation of points in the plane or in space, and its certificate.

mod check;
mod fingerprint;
mod json;
mod violation;

use serde::{Deserialize, Serialize};
use taut_points::{Monitor, PointSource, PointsHash};

use crate::{Answer, CheckError};

pub(crate) use check::{
    Gabriel, Geometry, Input, Lifted, Signs, Tetrahedra, UNDERFLOW, cross, turn,
};
pub use check::{
    TilesError, TilesOptions, TilesVerdict, TilesViolation, check_simplices, check_tiles,
    check_tiles_disk,
};
pub use fingerprint::{Fingerprint, FingerprintFormError, SiteHash, fingerprint};
pub use violation::MeshViolation;

/// In [`TriangulationCertificate::neighbors`]: there is no neighbor, the facet lies on the hull.
pub const NO_NEIGHBOR: u32 = u32::MAX;

/// The Delaunay triangulation of the points of a set in the plane or in space.
///
/// Ids are row numbers of the input, from 0. Of equal rows the smallest stands for all; the others are in
/// [`duplicates`](Triangulation::duplicates). Where more than d + 1 points lie on one sphere, the triangulation is the
/// one in which |p|² is raised by an infinitesimal amount at each point p, infinitely more at the lexicographically
/// larger of two points: so it is a function of the point set alone.
///
/// | `hull_dimension` | the points | `simplices`, rows of | `hull`, rows of |
/// |---|---|---|---|
/// | `None` | there are none | – | – |
/// | 0 | all equal | 1: that point | – |
/// | 1 | on a line | 2: the edges of the chain, in lexicographic order, each from its smaller end | 1: the ends |
/// | 2, in the plane | | 3: triangles, counter-clockwise | 2: edges, the points to their left |
/// | 2, in space | on a plane | 3: triangles, counter-clockwise where the plane is projected to xy; to xz, to yz where it stands upright | 2: edges, likewise |
/// | 3 | | 4: a, b, c, d with det(b − a, c − a, d − a) > 0 | 3: triangles, counter-clockwise from outside |
///
/// The order of rows and the place at which a row of `simplices` or `hull` begins mean nothing, except in the chain and
/// in its two ends, the smaller of which is first.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(try_from = "json::TriangulationDocument")]
pub struct Triangulation {
    /// Dimension of the points: 2 or 3.
    pub dimension: u8,
    /// Dimension of the affine hull of the points; `None` when there are no points.
    pub hull_dimension: Option<u8>,
    /// The simplices: rows of hull dimension + 1 ids, one after another.
    pub simplices: Vec<u32>,
    /// The facets of the convex hull: rows of hull dimension ids, one after another.
    pub hull: Vec<u32>,
    /// Each row that equals an earlier one, with the first row that it equals; ascending.
    pub duplicates: Vec<[u32; 2]>,
}

impl Triangulation {
    /// Ids in a row of `simplices`: hull dimension + 1, and 0 when there are no points.
    pub fn vertices_per_simplex(&self) -> usize {
        self.hull_dimension.map_or(0, |dimension| usize::from(dimension) + 1)
    }

    /// Number of simplices.
    pub fn len(&self) -> usize {
        self.simplices.len().checked_div(self.vertices_per_simplex()).unwrap_or(0)
    }

    /// Returns true if there is no simplex, which is so for no points alone.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The rows of `simplices`.
    pub fn rows(&self) -> std::slice::ChunksExact<'_, u32> {
        self.simplices.chunks_exact(self.vertices_per_simplex().max(1))
    }
}

/// The data that make the check of a [`Triangulation`] one linear pass, and tie it to its points.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(try_from = "json::CertificateDocument")]
pub struct TriangulationCertificate {
    /// For each vertex of each simplex the number of the simplex across the facet opposite that vertex, in rows like
    /// those of [`Triangulation::simplices`]; [`NO_NEIGHBOR`] on the hull, −1 in JSON. May be empty: then the checker
    /// pairs the facets by sorting them, which costs as much again.
    pub neighbors: Vec<u32>,
    /// The [`fingerprint`] of the simplices.
    pub fingerprint: Fingerprint,
    /// The hash of the rows this was made for.
    pub points_hash: PointsHash,
    /// The counts of the triangulation.
    pub counts: TriangulationCounts,
}

/// The sizes of a triangulation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "the counts of a triangulation: an object with sites, simplices and hull"
)]
pub struct TriangulationCounts {
    /// Distinct points.
    pub sites: u64,
    /// Simplices.
    pub simplices: u64,
    /// Facets of the convex hull.
    pub hull: u64,
}

/// The proved facts about a triangulation: it is the Delaunay triangulation of these points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct TriangulationVerdict {
    /// The counts of the triangulation.
    pub counts: TriangulationCounts,
    /// The fingerprint of the simplices.
    pub fingerprint: Fingerprint,
    /// Facets whose two simplices lie on one sphere, so that the perturbation decided between them.
    pub ties: u64,
    /// Signs that plain `f64` arithmetic with its bound left open.
    pub refined: u64,
}

impl Answer for Triangulation {
    type Certificate = TriangulationCertificate;
    type Verdict = TriangulationVerdict;
    const KIND: &'static str = "delaunay";

    fn check(
        &self,
        certificate: &TriangulationCertificate,
        source: &dyn PointSource,
        monitor: &Monitor<'_>,
    ) -> Result<TriangulationVerdict, CheckError> {
        check::check(self, certificate, source, monitor)
    }
}
