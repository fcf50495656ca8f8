//! Convex bodies in triangle meshes.

mod closed_forms;
mod degenerate;
mod free;
mod given;
mod holes;
mod laws;
mod models;
mod mutations;
mod obstacles;
mod occlusion;
mod shapes;
mod thesis;
