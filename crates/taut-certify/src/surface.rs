//! Surfaces through points of space, and the certificate of what is known about them.

mod apex;
mod check;
mod confidence;
mod doubt;
mod topology;
mod violation;

use serde::{Deserialize, Serialize};
use taut_points::{Monitor, PointSource, PointsHash, choice};

use crate::json::{hash_from_hex, hash_to_hex};
use crate::{Answer, CheckError};

pub use apex::Apex;
pub use confidence::{TopologyDoubt, TopologyReason};
pub use doubt::SurfaceDoubt;
pub use topology::{SurfaceComponent, SurfaceTopology};
pub use violation::SurfaceViolation;

/// A surface through points of space: triangles, each of which names three rows of the input.
///
/// Triangles run counter-clockwise seen from outside. Of equal rows the first stands for all; the others are duplicates.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "a surface: an object with triangles, topology and unused"
)]
pub struct Surface {
    /// Where points were moved, the place of each row; else empty, and every vertex is where its row is.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub vertices: Vec<[f64; 3]>,
    /// The triangles, as rows.
    pub triangles: Vec<[u32; 3]>,
    /// The topology of the triangles.
    pub topology: SurfaceTopology,
    /// The rows that no triangle names.
    pub unused: Unused,
}

/// The rows that no triangle of a surface names, each in one list, with the reason. All lists are ascending.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "the unused rows of a surface: an object with duplicates, outliers, interior and unreferenced"
)]
pub struct Unused {
    /// Each row in the same place as an earlier one, with the first row there.
    pub duplicates: Vec<[u32; 2]>,
    /// Rows that were left out from the beginning: the balls of triangles may hold them.
    pub outliers: Vec<u32>,
    /// Rows inside the closed components, not on them.
    pub interior: Vec<u32>,
    /// All others, of which nothing is said.
    pub unreferenced: Vec<u32>,
}

/// By which method a surface was found. It does not change what is proved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SurfaceMethod {
    /// Cells labeled inside or outside by a signed spanning tree.
    #[default]
    Tree,
    /// The advancing front of the thesis.
    Thesis,
    /// An alpha shape.
    Alpha,
    /// The filtered facets of the triangulation, as they are.
    Hull,
}

choice! { "method", SurfaceMethod {
    Tree = "tree", "all space is inside or outside, by the strongest of what neighboring cells say";
    Thesis = "thesis", "a front that grows over facets with empty equatorial spheres";
    Alpha = "alpha", "the alpha shape";
    Hull = "hull", "all facets with empty equatorial spheres, without choosing";
}}

/// The properties that a surface promises. In JSON `"closed"`, `"open"` or `{"alpha": {"radius": 0.1}}`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum SurfaceMode {
    /// It has no boundary.
    #[default]
    Closed,
    /// It may have a boundary.
    Open,
    /// It may have a boundary, and no circle through the vertices of a triangle is larger than this.
    Alpha {
        /// The radius, in the unit of the coordinates.
        radius: f64,
    },
}

/// The claims about a surface, beside its topology. Claims of more than is so are refused; of less, those of `embedded` and `outward`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "the certificate of a surface: an object with method, mode, apexes, embedded, outward, displacement, doubts where there are any, and points_hash"
)]
pub struct SurfaceCertificate {
    /// The way in which it was found, for the record.
    pub method: SurfaceMethod,
    /// The properties that it promises.
    pub mode: SurfaceMode,
    /// For each triangle what shows that it is a Delaunay triangle: a ball with the three vertices on its sphere and no point but
    /// outliers strictly inside. Empty where that is not claimed.
    pub apexes: Vec<Apex>,
    /// True if any two triangles share their common vertices and edges and nothing else, and none is flat.
    pub embedded: bool,
    /// True if each closed component has the side that it bounds behind it: outer ones face outwards, those within an odd number of
    /// others inwards. True of a surface without closed components; claimed of embedded, oriented manifolds alone.
    pub outward: bool,
    /// The largest distance of a vertex from its row, 0 where points were not moved.
    pub displacement: f64,
    /// Reasons of the method to doubt that the topology is that of what was sampled: evidence, neither proved nor refuted.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub doubts: Vec<TopologyDoubt>,
    /// The hash of the rows this was made for.
    #[serde(serialize_with = "hash_to_hex", deserialize_with = "hash_from_hex")]
    pub points_hash: PointsHash,
}

/// The proved facts about a surface, and whether its method doubts its topology.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SurfaceVerdict {
    /// Rows there are.
    pub rows: u64,
    /// Triangles.
    pub triangles: u64,
    /// Rows that triangles name.
    pub vertices: u64,
    /// Components: largest sets of triangles that hang together by edges.
    pub components: u64,
    /// Boundary loops.
    pub boundary_loops: u64,
    /// Handles of all components together; `None` if one of them is not a surface with two sides.
    pub genus: Option<u64>,
    /// Rows that were left out as outliers, which the balls of triangles may hold.
    pub outliers: u64,
    /// True if it has no boundary.
    pub is_closed: bool,
    /// True if each edge has at most two triangles, and each vertex one fan of them.
    pub is_manifold: bool,
    /// True if the two triangles of each edge run along it in opposite directions.
    pub is_oriented: bool,
    /// True if the surface meets itself nowhere.
    pub is_embedded: bool,
    /// True if each triangle is a Delaunay triangle of the places of all rows but outliers.
    pub is_delaunay: bool,
    /// True if each closed component has the side that it bounds behind it.
    pub is_outward: bool,
    /// The largest distance of a vertex from its row, rounded up.
    pub displacement: f64,
    /// True if it is an oriented embedded manifold of Delaunay triangles that faces outwards: proved.
    pub is_sound: bool,
    /// True if the method names no doubt about its topology: evidence.
    pub is_confident: bool,
    /// True if it is sound and the method is confident.
    pub certified: bool,
    /// Where it is not, the first reason.
    pub doubt: Option<SurfaceDoubt>,
}

impl Answer for Surface {
    type Certificate = SurfaceCertificate;
    type Verdict = SurfaceVerdict;
    const KIND: &'static str = "surface";

    fn check(
        &self,
        certificate: &SurfaceCertificate,
        source: &dyn PointSource,
        monitor: &Monitor<'_>,
    ) -> Result<SurfaceVerdict, CheckError> {
        check::check(self, certificate, source, monitor)
    }
}
