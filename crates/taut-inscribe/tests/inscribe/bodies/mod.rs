//! Convex bodies in triangle meshes.

mod closed_forms;
mod degenerate;
mod laws;
mod models;
mod mutations;
mod occlusion;
mod shapes;
