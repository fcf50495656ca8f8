//! Delaunay triangulation of more points than memory holds: finished simplices leave, unfinished sites go up.
//!
//! *Problem.* Triangulate n points with memory for m of them, in the plane and in space, for any distribution of points,
//! with the same simplices as in memory.
//! *Idea.* Distribute the points to the leaves of a kd-tree. Triangulate each leaf; a simplex whose sphere meets no box with
//! points of other leaves is final and is written. Only the sites of the other simplices, and the facets where the two kinds
//! meet, go up, and are triangulated again with those of the leaf beside.
//! *Guarantee.* The simplices are those of [`delaunay()`](crate::delaunay), ties included; tiles are a function of the points,
//! their rows and the tree, byte by byte, for any number of threads.
//! *Cost.* On well-spread points the front of a leaf of m points has about 5.5·√m sites in the plane and 9.7·m^⅔ in space;
//! each point is read, written to a bucket, read and triangulated once.
//! *Limit.* Where spheres hold most of the set (points on a circle, on a torus), nothing is final before a node has both
//! sides, and fronts are as large as the set. Such a node is refused with the bytes that it needs.
//!
//! | module | what |
//! |---|---|
//! | `tree` | cells and boxes |
//! | `points` | sites of a node in canonical order |
//! | `solve`, `facets` | the node function |
//! | `front` | what goes up, and its bytes |
//! | `tile` | what is finished, and its bytes |
//! | `node` | the functions for drivers |
//! | `extent` | what these must know of all points, and its bytes |
//! | `driver` | from the leaves to the root, on several threads |
//! | `disk` | points from a source to a folder of tiles |
//! | `mosaic` | tiles side by side, for what is computed from a triangulation |
//! | `stream` | points that come once, in a coherent order |

pub(crate) mod bytes;
mod disk;
mod driver;
mod extent;
mod facets;
mod front;
mod mosaic;
mod node;
mod points;
mod solve;
mod stream;
#[cfg(test)]
pub(crate) mod tests;
mod tile;
mod tree;

pub use crate::sites::Magnitudes;
pub use disk::{
    DiskPlan, FolderOptions, TiledTriangulation, delaunay_to_folder, plan_folder, tile_name,
};
pub use driver::{NodeRecord, Totals};
pub use extent::Extent;
pub use front::{Front, Link};
pub use mosaic::{AlphaPart, Mosaic};
pub(crate) use mosaic::{Corners, Place, View};
pub use node::{Dim, Dimension, NodeJob, finish, merge, summarize};
pub use points::NodePoints;
pub use solve::Whole;
pub use stream::{Coherence, Stream, StreamOptions, TakeSimplex};
pub use tile::{NO_NEIGHBOR, OTHER_TILE, Tile, TileCounts, TileLink};
pub use tree::{CellBox, FINE_LEVELS, LEVELS_MAX, Router, Tree};
