//! The figure of a convex polygon in a polygon.
//!
//! *Guarantee.* The rings are drawn as they are, but for vertices that are nearer to the one before than a pixel.

use taut_certify::{ConvexPolygon, Solution};
use taut_points::PointSource;

use crate::marks::all_finite;
use crate::number::{counted, exact};
use crate::rings::Rings;
use crate::{Aspect, DrawOptions, Error, Figure, Layer2, LineStyle, Scene2, Shape2, Tone};

/// The picture of a convex polygon in the polygon whose rings are the rows of `source`.
///
/// # Errors
/// [`Error::Mismatch`] when `source` has rows of more than three numbers, [`Error::NonFinite`], [`Error::Option`],
/// [`Error::Read`].
pub fn convex_figures(
    solution: &Solution<ConvexPolygon>,
    source: &dyn PointSource,
    options: &DrawOptions,
) -> Result<Vec<Figure>, Error> {
    options.check()?;
    let (answer, certificate) = (&solution.answer, &solution.certificate);
    all_finite(answer.vertices.as_flattened().iter().map(|x| ("a coordinate of a corner", x)))?;
    let rings = Rings::read(source)?;
    let layer = |name: &str, tone, line_style, shape| Layer2 {
        name: name.to_owned(),
        tone,
        line_style,
        shape,
    };
    let gap = options.gap_words("relative gap", certificate.gap);
    let scene = Scene2 {
        title: format!("Large convex polygon in a polygon of {}", counted(source.len(), "point")),
        caption: format!(
            "Area {}; {gap}; {}.",
            exact(answer.area),
            counted(answer.vertices.len() as u64, "corner")
        ),
        x: options.axis(0, 2),
        y: options.axis(1, 2),
        aspect: Aspect::Equal,
        layers: vec![
            layer(
                "polygon",
                Tone::Point,
                LineStyle::Solid,
                Shape2::Polygons(rings.outlines(options)),
            ),
            layer(
                "convex polygon",
                Tone::Answer,
                LineStyle::Solid,
                Shape2::Polygons(vec![answer.vertices.clone()]),
            ),
        ],
        width: options.width,
        height: options.height,
    };
    Ok(vec![Figure::Plane(scene)])
}
