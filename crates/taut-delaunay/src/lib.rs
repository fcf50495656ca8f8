//! Delaunay triangulations of points in the plane and in space: exact, canonical, parallel.

#[cfg_attr(not(test), allow(dead_code))]
mod kernel;
#[cfg_attr(not(test), allow(dead_code))]
mod plane;
#[cfg_attr(not(test), allow(dead_code))]
mod simplex;

pub use kernel::Counters;
pub use plane::constrained::{
    Constrained, ConstraintError, Piece, Pieces, Segment, Split, constrain,
};
pub use simplex::{GHOST, Simplex, decode};
