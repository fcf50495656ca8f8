//! Delaunay triangulations of points in the plane and in space: exact, canonical, parallel.
//!
//! | you want | call | promise | cost |
//! |---|---|---|---|
//! | the simplices with their certificate | [`delaunay()`] | exact for every finite input; the same bytes for any number of threads | O(n log n) |
//! | a triangulation to walk around in | [`Plane::build`], [`Space::build`] | the set of simplices is a function of the point set alone, their numbers after [`Triangulation::renumbered`] | O(n log n) |
//! | the nearest site, the simplex at a point, Voronoi cells, natural neighbors | [`Triangulation::locator`] | the simplex exactly, areas to rounding | O(log n) a question |
//! | more points than memory holds | [`outofcore::delaunay_to_folder`] | the same simplices, as tiles in a folder, within a limit on memory | about twice the time in memory |
//! | the same for many points at a time, in rows and canonical numbers; the Voronoi diagram | [`TriangulationIndex`] | simplices and ties exactly | O(log n) a question, O(simplices) |
//! | the convex hull alone | [`convex_hull`] | exact, extreme points only | O(n log h) expected |
//! | contour lines and rasters of heights | [`terrain::contours`], [`terrain::raster`] | the same bits in memory and by tiles | O(simplices + output) |
//! | the alpha shape | [`Plane::alpha_complex`], [`Space::alpha_complex`] | emptiness exactly, radii to rounding | O(simplices) |
//! | rows in the order in which sites are numbered, with its certificate | [`spatial_order`] | a function of the point set alone | O(n log n) |
//! | given edges in it | [`Plane::constrained`] | exact; Delaunay as far as the edges let it | O(n), and O(k²) for an edge across k others |
//!
//! ```
//! use taut_delaunay::{DelaunayOptions, Location, Plane, delaunay};
//! use taut_points::Points;
//!
//! let square = [0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0];
//! let points = Points::new(&square, 2)?;                               // n × d, row-major
//! let found = delaunay(&points, &DelaunayOptions::default())?;
//! assert_eq!(found.answer.len(), 2);                                   // rows of the input, two triangles
//! assert_eq!(found.check(&points)?.ties, 1);                           // a second opinion: four points on a circle
//!
//! let plane = Plane::build(&points, &DelaunayOptions::default())?;
//! let locator = plane.locator();
//! let corner = locator.nearest([0.9, 0.2]).expect("there are sites");
//! assert_eq!(plane.row(corner), 1);                                    // a site is not a row: `row` translates
//! assert!(matches!(locator.locate([0.5, 0.25]), Location::Inside(_)));
//! assert_eq!(locator.voronoi_cell(corner, [0.0, 0.0], [1.0, 1.0]).area(), 0.25);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Sites are numbered along a Hilbert curve, simplices by slot; [`Triangulation::row`] and
//! [`Triangulation::sites_of_rows`] lead to and from the rows of the input.
//!
//! Not for: weights (regular triangulations); points that come and go (build again); other dimensions than two and three.

mod affine;
mod canonical;
mod error;
mod flat;
mod geometry;
mod groups;
mod hull;
mod kernel;
#[cfg(test)]
mod numbers;
mod options;
mod order;
pub mod outofcore;
mod plane;
mod query;
mod records;
mod rounds;
mod simplex;
mod sites;
mod solution;
mod space;
pub mod terrain;
#[cfg(test)]
mod test_length;
mod threads;
mod triangulation;
mod vector;

pub use error::Error;
pub use hull::{ConvexHull, convex_hull};
pub use kernel::Counters;
pub use options::{DelaunayOptions, InsertionOrder};
pub use order::{OrderOptions, spatial_order};
pub use outofcore::{FolderOptions, delaunay_to_folder};
pub use plane::constrained::{Constrained, ConstraintError, Piece, Segment, Split};
pub use query::{
    AlphaComplex, Location, Locator, NOWHERE, NaturalNeighbors, Polygon, Polyhedron,
    TriangulationIndex, VoronoiDiagram,
};
pub use simplex::{GHOST, Simplex, Slots, decode};
pub use solution::delaunay;
pub use triangulation::{Complex, Plane, Space, Triangulation};
