//! Curves through samples of the plane, clean or noisy, each with a certificate, and surfaces through samples of space.
//!
//! | you want | call | promise | cost, n points |
//! |---|---|---|---|
//! | the curves that noisy points were sampled from | [`curve()`] | no crossings; each point within the band told, or named as an outlier; the verdict says whether sampling was dense enough | O(n log n) |
//! | the curves through points without noise, vertices the points themselves | [`curve()`] with [`CurveMethod::HnnCrust`] and its kin | exactly the edges of the curve, for samples as dense as the method asks for | O(n log n) |
//! | a short tour through all points | [`curve()`] with [`CurveMethod::Tour`] | a lower bound beside it | near O(n log n) |
//! | the surface that points of space were sampled from, vertices the points themselves | [`surface()`] | Delaunay facets with an empty ball each, so it nowhere meets itself; where it is no surface is named | O(n log n), and the triangulation |
//!
//! Not for: curves that cross themselves or branch.
#![forbid(unsafe_code)]

mod curve;
mod error;
mod surface;
mod tour;

pub use curve::{CurveMethod, CurveOptions, CurveThesisOptions, Ends, curve};
pub use error::{Error, Span};
pub use surface::{
    Denoise, HullOptions, LabelBorder, LabelFacet, LabelTrace, Positions, SurfaceMethod,
    SurfaceMode, SurfaceOptions, alpha, label_trace, looks_one_sided, surface, thesis,
};
