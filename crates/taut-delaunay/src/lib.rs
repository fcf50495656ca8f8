//! Delaunay triangulations of points in the plane and in space: exact, canonical, parallel.
//!
//! | you want | call | promise |
//! |---|---|---|
//! | a triangulation to walk around in | [`Plane::build`], [`Space::build`] | exact for every finite input; a function of the point set alone |
//! | the simplices with their certificate | [`delaunay()`], [`delaunay_of_source()`], [`Triangulation::solution`] | the same bytes for any number of threads |
//!
//! Not for: more points than memory holds, or other dimensions than two and three.

mod affine;
mod canonical;
mod cells;
mod error;
mod flat;
mod kernel;
mod options;
mod plane;
mod query;
mod rounds;
mod simplex;
mod sites;
mod solution;
mod space;
mod triangulation;

pub use error::Error;
pub use kernel::Counters;
pub use options::{DelaunayOptions, InsertionOrder};
pub use plane::constrained::{Constrained, ConstraintError, Piece, Segment, Split};
pub use query::{AlphaComplex, Location, Locator, Polygon, Polyhedron};
pub use simplex::{GHOST, Simplex, Slots, decode};
pub use solution::{delaunay, delaunay_of_source};
pub use triangulation::{Complex, Plane, Space, Triangulation};
