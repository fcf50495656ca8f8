//! The figure of the largest triangle in a polygon.

use taut_certify::{InscribedTriangle, Solution};
use taut_points::PointSource;

use crate::marks::{all_finite, all_there};
use crate::shape_in_rings::ShapeInRings;
use crate::{DrawOptions, Error, Figure};

/// The picture of a triangle in the polygon whose rings are the rows of `source`.
///
/// # Errors
/// [`Error::Mismatch`] when `source` is not what the triangle was found for, [`Error::NonFinite`], [`Error::Option`],
/// [`Error::Read`].
pub fn triangle_figures(
    solution: &Solution<InscribedTriangle>,
    source: &dyn PointSource,
    options: &DrawOptions,
) -> Result<Vec<Figure>, Error> {
    options.check()?;
    let (answer, certificate) = (&solution.answer, &solution.certificate);
    all_there("number of points", &certificate.touching, source.len())?;
    let corners = answer.corners.as_flattened().iter();
    all_finite(corners.map(|x| ("a coordinate of a corner", x)))?;
    let picture = ShapeInRings {
        name: "triangle",
        outline: answer.corners.to_vec(),
        area: answer.area,
        gap: certificate.gap,
        touching: &certificate.touching,
    };
    picture.figures(source, options)
}
