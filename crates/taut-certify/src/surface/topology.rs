//! The topology of triangles, in numbers.

use serde::{Deserialize, Serialize};

/// The triangles of a surface without their coordinates.
///
/// - An *edge* is a pair of rows that are two corners of a triangle. It is a *boundary* edge if it is so for one triangle,
///   *non-manifold* if for more than two.
/// - The *link* of a vertex is the graph on its neighbors that has an edge for the opposite side of each triangle at the vertex. A
///   vertex of a surface has one path or one cycle for a link; all others are *non-manifold*, among them the ends of each
///   non-manifold edge.
/// - A *component* is a largest set of triangles that one can walk through over edges. Two components can share vertices.
/// - A *boundary loop* is a largest set of boundary edges that one can walk through over vertices.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "the topology of a surface: an object with vertices, edges, boundary_edges, boundary_loops, non_manifold_edges, non_manifold_vertices, inconsistent_edges, euler_characteristic, genus and components"
)]
pub struct SurfaceTopology {
    /// Rows that are corners of triangles.
    pub vertices: u64,
    /// Distinct edges.
    pub edges: u64,
    /// Edges of one triangle; 0 of a closed surface.
    pub boundary_edges: u64,
    /// The loops that these form, over the whole surface.
    pub boundary_loops: u64,
    /// Edges of more than two triangles.
    pub non_manifold_edges: u64,
    /// Vertices whose link is not one path or one cycle.
    pub non_manifold_vertices: u64,
    /// Edges of just two triangles, which both run along it in the same direction; 0 of an oriented surface.
    pub inconsistent_edges: u64,
    /// Vertices − edges + triangles.
    pub euler_characteristic: i64,
    /// Handles of all components together; `None` if one of them is not a surface with two sides.
    // A field that may be null is still a field.
    #[serde(deserialize_with = "Option::deserialize")]
    pub genus: Option<u64>,
    /// The components, by the first triangle of each.
    pub components: Vec<SurfaceComponent>,
}

/// Triangles that hang together by edges, seen on their own: what another component does to a common vertex does not count.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "a component of a surface: an object with first_triangle, vertices, edges, triangles, boundary_loops, orientable and genus"
)]
pub struct SurfaceComponent {
    /// Its first triangle.
    pub first_triangle: u32,
    /// Its vertices.
    pub vertices: u64,
    /// Its edges.
    pub edges: u64,
    /// Its triangles.
    pub triangles: u64,
    /// Its boundary loops.
    pub boundary_loops: u64,
    /// True if all triangles can be turned such that the two of an edge run along it in opposite directions; edges of more than
    /// two triangles ask for nothing.
    pub orientable: bool,
    /// With ℓ boundary loops and χ = vertices − edges + triangles, the number of handles (2 − ℓ − χ)/2 if orientable, that of
    /// cross-caps 2 − ℓ − χ if not (1 for a Möbius band, 2 for a Klein bottle); `None` if it is not a surface.
    // A field that may be null is still a field.
    #[serde(deserialize_with = "Option::deserialize")]
    pub genus: Option<u64>,
}

impl SurfaceTopology {
    /// Returns true if no edge has one triangle only.
    pub fn is_closed(&self) -> bool {
        self.boundary_edges == 0
    }

    /// Tests whether it is a surface, with or without a boundary: no vertex, and so no edge, is non-manifold.
    pub fn is_manifold(&self) -> bool {
        self.non_manifold_edges == 0 && self.non_manifold_vertices == 0
    }

    /// Returns true if the two triangles of each edge run along it in opposite directions.
    pub fn is_oriented(&self) -> bool {
        self.inconsistent_edges == 0
    }
}
