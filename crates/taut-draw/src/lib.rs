//! Pictures of the answers of taut: SVG, PNG and one self-contained interactive HTML page.
//!
//! | you have | you call | you get |
//! |---|---|---|
//! | a ball and its points | [`ball_figures`] | scenes of the plane or of space, and plots |
//! | k centers and their items | [`centers_figures`] | the same, with all balls, what is left out and the core-set |
//! | the radius for each of several k | [`elbow_figure`] | a plot of both bounds |
//! | an ellipsoid and its points | [`ellipsoid_figures`] | scenes of the plane or of space, shadows on pairs of coordinates, and plots |
//! | a robust ellipsoid and its points | [`robust_figures`] | the same with outliers apart, and the distance of each point |
//! | an ellipsoid in a polytope, and its half-spaces | [`inscribed_figures`] | scenes of the plane or of space, cuts through the center, and plots |
//! | a ball of a kernel | [`kernel_ball_figures`] | a scene of the plane with its border, or a histogram of squared distances |
//! | a circle in a polygon, and the rings | [`circle_figures`] | a scene of the plane, with the edges that are touched |
//! | an ellipse in a polygon, and the rings | [`ellipse_figures`] | the same |
//! | a convex polygon in a polygon, and the rings | [`convex_figures`] | the same |
//! | a rectangle in a polygon, and the rings | [`rectangle_figures`], [`oriented_rectangle_figures`] | the same |
//! | an ellipse or a triangle in a polygon, and the rings | [`ellipse_figures`], [`triangle_figures`] | the same |
//! | convex bodies in a mesh, and its triangles | [`bodies_figures`] | a scene of space, with the mesh translucent |
//! | a bounding dop and its points | [`dop_figures`] | a scene of space, with the facets translucent |
//! | a triangulation and its points | [`delaunay_figures`] | scenes of the plane or of space, and the Voronoi diagram |
//! | curves and their points | [`curve_figures`] | scenes of the plane, with the band of noise, outliers and ends |
//! | a surface and its points, or bare triangles | [`surface_figures`], [`surface_scene`] | a scene to turn, with fronts, backs, boundary and unused points, and fixed views |
//! | an answer of any kind and its points | [`Figures`] | the same, for code that is generic over answers |
//! | a [`Figure`] | [`to_svg`] | SVG text, with a title and a description for screen readers |
//! | a [`Figure`] | `to_png` (feature `png`) | PNG bytes, the same on every machine: the font is bundled |
//! | a [`Page`] of figures | [`to_html`] | one file: no network, no library; light, dark and print |
//!
//! A figure is data, not drawing calls: an answer of another kind brings another function that returns figures,
//! and every renderer shows them.
//!
//! ```
//! use taut_draw::{DrawOptions, Figure, Style, ball_figures, to_svg};
//!
//! let points = taut_points::Points::new(&[0.0, 0.0, 2.0, 0.0, 1.0, 1.0], 2)?;
//! let found = taut_enclose::ball(&points, &Default::default())?;
//! let figures = ball_figures(&found, &points, &DrawOptions::default())?;
//! assert!(matches!(figures[0], Figure::Plane(_)));
//! assert!(to_svg(&figures[0], &Style::default()).starts_with("<svg"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Not for: maps, animation, or charts in general; pictures of millions of points (they are thinned, and the
//! caption says so; triangles never are).
#![forbid(unsafe_code)]

mod axes;
mod ball;
mod base64;
mod bodies;
mod body;
mod centers;
mod circle;
mod convex;
mod curve;
mod decision;
mod delaunay;
mod det;
mod deviate;
mod dop;
mod ellipse;
mod ellipsoid;
mod error;
mod figure;
mod html;
mod inscribed;
mod item_pass;
mod kernel_ball;
mod marks;
mod number;
mod options;
mod passes;
mod plot;
#[cfg(feature = "png")]
mod png;
mod project;
mod raster;
mod rectangle;
mod rings;
mod scene;
mod scene2;
mod scene3;
mod shape_in_rings;
mod style;
mod surface;
mod svg;
mod text;
mod triangle;

pub use ball::ball_figures;
pub use bodies::bodies_figures;
pub use centers::{ElbowStep, centers_figures, elbow_figure};
pub use circle::circle_figures;
pub use convex::convex_figures;
pub use curve::curve_figures;
pub use decision::{DecisionPoints, decision_figure};
pub use delaunay::delaunay_figures;
pub use det::{DetCurve, det_figure};
pub use dop::dop_figures;
pub use ellipse::ellipse_figures;
pub use ellipsoid::{ellipsoid_figures, robust_figures};
pub use error::Error;
pub use figure::{Figure, Figures};
pub use html::{Field, Page, Section, to_html};
pub use inscribed::inscribed_figures;
pub use kernel_ball::kernel_ball_figures;
pub use options::DrawOptions;
pub use plot::{Bar, Level, Plot, Scale, Series, SeriesStyle};
#[cfg(feature = "png")]
pub use png::to_png;
pub use rectangle::{oriented_rectangle_figures, rectangle_figures};
pub use scene2::{Aspect, Axis, Circle2, Layer2, Point2, Scene2, Shape2, Text2};
pub use scene3::{
    Layer3, Mesh3, Point3, Projection, Scene3, Shading, Shape3, Sphere3, Surface3, View, Views,
};
pub use style::{LineStyle, Style, Theme, Tone};
pub use surface::{SurfaceView, UnusedPoints, surface_figures, surface_scene};
pub use svg::to_svg;
pub use triangle::triangle_figures;
