//! Curves through samples of the plane, clean or noisy, each with a certificate.
//!
//! | you want | call | promise | cost, n points |
//! |---|---|---|---|
//! | the curves that noisy points were sampled from | [`curve()`] | no crossings; each point within the band told, or named as an outlier; the verdict says whether sampling was dense enough | O(n log n) |
//! | the curves through points without noise, vertices the points themselves | [`curve()`] with [`CurveMethod::HnnCrust`] and its kin | exactly the edges of the curve, for samples as dense as the method asks for | O(n log n) |
//! | a short tour through all points | [`curve()`] with [`CurveMethod::Tour`] | a lower bound beside it | near O(n log n) |
//!
//! Not for: curves that cross themselves or branch; points of space.
#![forbid(unsafe_code)]

mod curve;
mod error;
mod threads;
mod tour;

pub use curve::{CurveMethod, CurveOptions, Ends, curve, curve_of_source};
pub use error::Error;
