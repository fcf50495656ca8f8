//! Delaunay triangulations of points in the plane and in space: exact, canonical, parallel.

mod kernel;
mod simplex;
mod space;
