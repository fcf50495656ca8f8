//! The figure of the largest ellipse in a polygon.
//!
//! *Guarantee.* The ellipse is a polygon of [`CORNERS`] corners on it.

use taut_certify::{InscribedEllipse, Solution};
use taut_points::PointSource;

use crate::marks::{all_finite, all_there};
use crate::shape_in_rings::ShapeInRings;
use crate::{DrawOptions, Error, Figure};

/// Corners of the ellipse: it is off by 1 − cos(π/256), less than 1e-4 of its axes.
const CORNERS: usize = 256;

/// The picture of an ellipse in the polygon whose rings are the rows of `source`.
///
/// # Errors
/// [`Error::Mismatch`] when `source` is not what the ellipse was found for, [`Error::NonFinite`], [`Error::Option`],
/// [`Error::Read`].
pub fn ellipse_figures(
    solution: &Solution<InscribedEllipse>,
    source: &dyn PointSource,
    options: &DrawOptions,
) -> Result<Vec<Figure>, Error> {
    options.check()?;
    let (answer, certificate) = (&solution.answer, &solution.certificate);
    all_there("number of points", &certificate.touching, source.len())?;
    let center = answer.center.iter().map(|x| ("a coordinate of the center", x));
    let axes = answer.axes.iter().flatten().map(|x| ("an entry of the axes", x));
    all_finite(center.chain(axes))?;
    let picture = ShapeInRings {
        name: "ellipse",
        outline: outline(answer),
        area: answer.area,
        gap: certificate.gap,
        touching: &certificate.touching,
    };
    picture.figures(source, options)
}

/// Points of the ellipse, all the way round.
fn outline(answer: &InscribedEllipse) -> Vec<[f64; 2]> {
    let point = |i: usize| {
        let (sine, cosine) = (std::f64::consts::TAU * i as f64 / CORNERS as f64).sin_cos();
        [0, 1].map(|k| answer.center[k] + answer.axes[k][0] * cosine + answer.axes[k][1] * sine)
    };
    (0..CORNERS).map(point).collect()
}
