//! The figure of the largest ellipse in a polygon.
//!
//! *Guarantee.* The rings are drawn as they are, but for vertices that are nearer to the one before than a pixel; edges that the
//! ellipse touches are drawn in full. The ellipse is a polygon of [`CORNERS`] corners on it.

use taut_certify::{InscribedEllipse, Solution};
use taut_points::PointSource;

use crate::marks::{all_finite, all_there};
use crate::number::{counted, short};
use crate::rings::Rings;
use crate::{Aspect, DrawOptions, Error, Figure, Layer2, LineStyle, Scene2, Shape2, Tone};

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
    let rings = Rings::read(source)?;
    let lines = certificate.touching.iter().map(|&row| rings.edge(row as usize).to_vec()).collect();
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
        title: format!("Largest ellipse in a polygon of {}", counted(source.len(), "point")),
        caption: format!(
            "Area {}; {gap}. It touches {}.",
            short(answer.area, 8),
            counted(certificate.touching.len() as u64, "edge")
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
                "largest ellipse",
                Tone::Answer,
                LineStyle::Solid,
                Shape2::Polygons(vec![outline(answer)]),
            ),
            layer("touching edges", Tone::Support, LineStyle::Solid, Shape2::Polylines(lines)),
        ],
        width: options.width,
        height: options.height,
    };
    Ok(vec![Figure::Plane(scene)])
}

/// Points of the ellipse, all the way round.
fn outline(answer: &InscribedEllipse) -> Vec<[f64; 2]> {
    let point = |i: usize| {
        let (sine, cosine) = (std::f64::consts::TAU * i as f64 / CORNERS as f64).sin_cos();
        [0, 1].map(|k| answer.center[k] + answer.axes[k][0] * cosine + answer.axes[k][1] * sine)
    };
    (0..CORNERS).map(point).collect()
}
