//! Delaunay triangulations of points in the plane and in space: exact, canonical, parallel.

#[allow(dead_code)]
mod kernel;
#[allow(dead_code)]
mod plane;
#[allow(dead_code)]
mod simplex;
