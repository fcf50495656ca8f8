//! The figure of the largest circle in a polygon.
//!
//! *Guarantee.* The rings are drawn as they are, but for vertices that are nearer to the one before than a pixel; edges that the
//! circle touches are drawn in full.

use taut_certify::{InscribedCircle, Solution};
use taut_points::PointSource;

use crate::marks::{all_finite, all_there};
use crate::number::{counted, exact};
use crate::rings::{Rings, nearest};
use crate::{
    Aspect, Circle2, DrawOptions, Error, Figure, Layer2, LineStyle, Point2, Scene2, Shape2, Tone,
};

/// The picture of a circle in the polygon whose rings are the rows of `source`.
///
/// # Errors
/// [`Error::Mismatch`] when `source` is not what the circle was found for, [`Error::NonFinite`], [`Error::Option`],
/// [`Error::Read`].
pub fn circle_figures(
    solution: &Solution<InscribedCircle>,
    source: &dyn PointSource,
    options: &DrawOptions,
) -> Result<Vec<Figure>, Error> {
    options.check()?;
    let (answer, certificate) = (&solution.answer, &solution.certificate);
    all_there("number of points", &certificate.touching, source.len())?;
    let center = answer.center.iter().map(|x| ("a coordinate of the center", x));
    all_finite(center.chain([("the radius", &answer.radius)]))?;
    let rings = Rings::read(source)?;
    let edge = |row: u64| rings.edge(row as usize);
    let touching: Vec<[[f64; 2]; 2]> = certificate.touching.iter().map(|&row| edge(row)).collect();
    let mark = |(&[a, b], &row): (&[[f64; 2]; 2], &u64)| Point2 {
        id: Some(row),
        at: nearest(answer.center, a, b),
        size: 4.0,
        label: format!("touches the edge from point {row}"),
    };
    let marks = touching.iter().zip(&certificate.touching).map(mark).collect();
    let layer = |name: &str, tone, line_style, shape| Layer2 {
        name: name.to_owned(),
        tone,
        line_style,
        shape,
    };
    let circle = vec![Circle2 { id: None, center: answer.center, radius: answer.radius }];
    let lines = touching.iter().map(|edge| edge.to_vec()).collect();
    let vertices = counted(source.len(), "point");
    let outline = Shape2::Polygons(rings.outlines(options));
    let gap = options.gap_words("relative gap", certificate.gap);
    let scene = Scene2 {
        title: format!("Largest circle in a polygon of {vertices}"),
        caption: format!(
            "Radius {}; {gap}. It touches {}.",
            exact(answer.radius),
            counted(certificate.touching.len() as u64, "edge")
        ),
        x: options.axis(0, 2),
        y: options.axis(1, 2),
        aspect: Aspect::Equal,
        layers: vec![
            layer("polygon", Tone::Point, LineStyle::Solid, outline),
            layer("largest circle", Tone::Answer, LineStyle::Solid, Shape2::Circles(circle)),
            layer("touching edges", Tone::Support, LineStyle::Solid, Shape2::Polylines(lines)),
            layer("touched at", Tone::Support, LineStyle::Solid, Shape2::Points(marks)),
        ],
        width: options.width,
        height: options.height,
    };
    Ok(vec![Figure::Plane(scene)])
}
