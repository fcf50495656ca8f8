//! Queries of a triangulation: find where a point lies, the nearest site, Voronoi cells, natural neighbors.
//!
//! Idea: sites lie along a Hilbert curve, so boxes over runs of them answer which site is nearest, whatever the sites
//! span; a walk of a few steps from there finds the simplex.
//! Guarantee: the simplex is exact, and the nearest site is nearest as `f64` computes squared distances.
//! Reference: Sibson, *A brief description of natural neighbour interpolation*, 1981.

mod alpha;
mod convex;
mod locator;
mod many;
mod natural;
mod voronoi;

pub use alpha::AlphaComplex;
pub(crate) use alpha::{Radii, ascending, is_singular, turned};
pub(crate) use convex::Body;
pub use convex::{Polygon, Polyhedron};
pub use locator::{Location, Locator};
pub use many::{NOWHERE, NaturalNeighbors, TriangulationIndex, VoronoiDiagram};
pub(crate) use natural::sibson_weights;
pub(crate) use voronoi::clipped;
