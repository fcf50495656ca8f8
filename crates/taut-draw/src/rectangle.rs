//! The figure of the largest rectangle in a polygon.
//!
//! *Guarantee.* The rings are drawn as they are, but for vertices that are nearer to the one before than a pixel.

use taut_certify::{InscribedRectangle, Solution};
use taut_points::PointSource;

use crate::marks::all_finite;
use crate::number::{counted, short};
use crate::rings::Rings;
use crate::{Aspect, DrawOptions, Error, Figure, Layer2, LineStyle, Scene2, Shape2, Tone};

/// The picture of a rectangle in the polygon whose rings are the rows of `source`.
///
/// # Errors
/// [`Error::Mismatch`] when `source` has rows of more than three numbers, [`Error::NonFinite`], [`Error::Option`],
/// [`Error::Read`].
pub fn rectangle_figures(
    solution: &Solution<InscribedRectangle>,
    source: &dyn PointSource,
    options: &DrawOptions,
) -> Result<Vec<Figure>, Error> {
    options.check()?;
    let (answer, certificate) = (&solution.answer, &solution.certificate);
    let (low, high) = (answer.low, answer.high);
    all_finite(low.iter().chain(&high).map(|x| ("a coordinate of a corner", x)))?;
    let rings = Rings::read(source)?;
    let layer = |name: &str, tone, line_style, shape| Layer2 {
        name: name.to_owned(),
        tone,
        line_style,
        shape,
    };
    let gap = match certificate.gap {
        gap if gap.is_finite() => format!("certified gap {}", short(gap, 3)),
        _ => "no gap is certified".to_owned(),
    };
    let scene = Scene2 {
        title: format!(
            "Largest rectangle along the axes in a polygon of {}",
            counted(source.len(), "point")
        ),
        caption: format!(
            "Area {}, {} by {}; {gap}.",
            short(answer.area, 8),
            short(high[0] - low[0], 6),
            short(high[1] - low[1], 6)
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
                "largest rectangle",
                Tone::Answer,
                LineStyle::Solid,
                Shape2::Polygons(vec![vec![low, [high[0], low[1]], high, [low[0], high[1]]]]),
            ),
        ],
        width: options.width,
        height: options.height,
    };
    Ok(vec![Figure::Plane(scene)])
}
