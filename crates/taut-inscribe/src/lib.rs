//! Large shapes inside polygons and meshes, each with a certificate.
//!
//! | you want | call | promise | cost, n vertices |
//! |---|---|---|---|
//! | the largest circle in a polygon, with holes | [`inscribed_circle()`] | largest radius ≤ (1 + ε)·radius, proved | O(n log n) for most rings, and the cells of the search |
//! | the largest ellipse in a polygon, with holes | [`inscribed_ellipse()`] | largest area ≤ (1 + ε)·area, proved | O(n log n), and the cells of the search |
//! | a large convex polygon in a polygon, with holes | [`inscribed_polygon()`] | inside, proved; largest area ≤ (1 + gap)·area, proved with a gap of up to 65 % | the ellipse, and O(n) for each turn of a side |
//! | the largest rectangle along the axes in a polygon, with holes | [`inscribed_rectangle()`] | largest area ≤ (1 + ε)·area, proved | the cells of the search |
//! | the largest rectangle of any direction in a polygon, with holes | [`inscribed_oriented_rectangle()`] | largest area ≤ (1 + ε)·area, proved | the cells of the search |
//! | the largest triangle in a polygon, with holes | [`inscribed_triangle()`] | largest area ≤ (1 + ε)·area, proved | O(n log n), and the cells of the search |
//! | convex bodies in a triangle mesh that cover much of it | [`inscribed_bodies()`] | each lies inside, proved; how much they cover is an estimate | O(log n) for most events |
//! | how much of the mesh they hide | [`occlusion()`] | an estimate with its standard error | O(n) for each view |
//!
//! ```
//! use taut_inscribe::{CircleOptions, inscribed_circle};
//! use taut_points::Points;
//!
//! let ring = Points::new(&[0.0, 0.0, 4.0, 0.0, 4.0, 3.0], 2)?;   // vertices in order; the last may repeat the first
//! let found = inscribed_circle(&ring, &CircleOptions::default())?;
//! assert!((found.answer.radius - 1.0).abs() < 1e-9);
//! assert!(found.check(&ring)?.gap <= 1e-9);                      // proved from the ring and the certificate alone
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! A polygon is one ring of points (x, y), or several rings of points (x, y, number of the ring): holes and parts, by the
//! even-odd rule. Not for: rings that touch or cross each other or themselves.
#![forbid(unsafe_code)]

mod bodies;
mod circle;
mod convex;
mod ellipse;
mod error;
mod frontier;
mod inner_points;
mod levels;
mod occlusion;
mod oriented;
mod pair;
mod polygon;
mod program;
mod random;
mod rectangle;
mod runs;
mod simple;
#[cfg(test)]
mod test_length;
mod triangle;
mod units;

pub use bodies::{
    BodiesMethod, BodiesOptions, BodiesThesisOptions, BodyShape, Objective, Scene, ThesisSeeds,
    box_rows, inscribed_bodies, point_rows, triangle_rows,
};
pub use circle::{CircleOptions, inscribed_circle};
pub use convex::{ConvexOptions, inscribed_polygon};
pub use ellipse::{EllipseMethod, EllipseOptions, EllipseThesisOptions, inscribed_ellipse};
pub use error::Error;
pub use occlusion::{Occlusion, OcclusionOptions, occlusion};
pub use oriented::{OrientedRectangleOptions, inscribed_oriented_rectangle};
pub use rectangle::{RectangleOptions, inscribed_rectangle};
pub use triangle::{TriangleMethod, TriangleOptions, TriangleThesisOptions, inscribed_triangle};
