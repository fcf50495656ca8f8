//! Polylines of the plane, and how far apart two sets of them are.
//!
//! | you want | call | cost, n edges |
//! |---|---|---|
//! | how good a found curve is beside the true one | [`compare`] | O(n) where edges are alike in length |
//! | where edges meet that should not | [`crossings`] | the same, and exact |
//! | which loops lie within which | [`parents`] | O(n log n), and for each loop the edges on its level; exact |
//! | how many of the true edges were found | [`edge_score`] | O(n log n) |
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
//! Not for: coordinates that are not finite.
#![forbid(unsafe_code)]

mod connectivity;
mod crossing;
mod edges;
mod grid;
mod nesting;
mod quality;

pub use crossing::crossings;
pub use edges::{EdgeScore, edge_score};
pub use nesting::{is_counter_clockwise, parents};
pub use quality::{Quality, compare};

/// A chain of straight edges in the plane, borrowed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Polyline<'a> {
    /// Its vertices in order.
    pub vertices: &'a [[f64; 2]],
    /// Whether an edge leads from the last vertex back to the first.
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
