//! Polylines of the plane and triangle meshes of space: what is wrong with them, and how far apart two are.
//!
//! | of polylines you want | call | cost, n edges |
//! |---|---|---|
//! | how good a found curve is beside the true one | [`compare`] | O(n) where edges are alike in length |
//! | where edges meet that should not | [`crossings`] | the same, and exact |
//! | which loops lie within which | [`parents`] | O(n log n), and for each loop the edges on its level; exact |
//! | how many of the true edges were found | [`edge_score`] | O(n log n) |
//!
//! | of a mesh you want | call | cost, n triangles |
//! |---|---|---|
//! | edges, borders, components, handles, and what is no surface | [`topology()`] | O(n log n) |
//! | where it meets itself | [`self_intersections`] | O(n log n) and O(log n) for each pair of boxes that meet; exact |
//! | how far it is from another one, and what they share | [`compare_surfaces`] | O(n log n) and O(log n) for each sample |
//!
//! ```
//! use taut_mesh::{Polyline, compare};
//! let truth = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
//! let found = [[0.0, 0.0], [1.0, 0.1], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
//! let quality = compare(
//!     &[Polyline { vertices: &truth, closed: true }],
//!     &[Polyline { vertices: &found, closed: true }],
//! );
//! assert!(quality.homeomorphic && quality.crossings == 0);
//! assert!((quality.vertex_max - 0.1).abs() < 1e-15);
//! ```
//!
//! ```
//! use taut_mesh::{TriangleMesh, self_intersections, topology};
//! let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
//! let mesh = TriangleMesh::new(&corners, &[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])?;
//! assert_eq!(topology(&mesh).genus, Some(0));
//! assert!(self_intersections(&mesh).is_embedded());
//! # Ok::<(), taut_mesh::Error>(())
//! ```
//!
//! Not for: coordinates that are not finite. [`TriangleMesh`] refuses them, polylines are not checked.
#![forbid(unsafe_code)]

mod bvh;
mod connectivity;
mod crossing;
mod edges;
mod error;
mod grid;
mod grouped;
mod mesh;
mod nesting;
mod quality;
mod self_intersection;
#[cfg(test)]
mod shapes;
mod surface;
#[cfg(test)]
mod test_length;
mod topology;
mod union_find;

pub use crossing::crossings;
pub use edges::{EdgeScore, edge_score};
pub use error::Error;
pub use mesh::TriangleMesh;
pub use nesting::{is_counter_clockwise, parents};
pub use quality::{Quality, compare};
pub use self_intersection::{SelfIntersections, self_intersections};
pub use surface::{Shared, SurfaceDistance, SurfaceOptions, SurfaceQuality, compare_surfaces};
pub use topology::{BoundaryLoop, Component, Topology, topology};

/// A chain of straight edges in the plane, borrowed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Polyline<'a> {
    /// Its vertices in order.
    pub vertices: &'a [[f64; 2]],
    /// True if an edge leads from the last vertex back to the first.
    pub closed: bool,
}

impl<'a> Polyline<'a> {
    /// Its edges in order. A single vertex has none, closed or not.
    pub fn edges(&self) -> impl Iterator<Item = ([f64; 2], [f64; 2])> + 'a {
        let vertices = self.vertices;
        let back = (self.closed && vertices.len() > 1)
            .then(|| (vertices[vertices.len() - 1], vertices[0]));
        vertices.windows(2).map(|pair| (pair[0], pair[1])).chain(back)
    }

    /// Sum of the lengths of its edges.
    pub fn length(&self) -> f64 {
        self.edges().map(|(a, b)| (b[0] - a[0]).hypot(b[1] - a[1])).sum()
    }
}
