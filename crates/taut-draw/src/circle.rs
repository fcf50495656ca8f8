//! The figure of the largest circle in a polygon.
//!
//! *Guarantee.* The ring is drawn as it is, but for vertices that are nearer to the one before than a pixel; edges that the
//! circle touches are drawn in full.

use taut_certify::{InscribedCircle, Solution};
use taut_points::{PointSource, gather};

use crate::marks::{agree, all_finite, all_there};
use crate::number::{counted, short};
use crate::{
    Aspect, Circle2, DrawOptions, Error, Figure, Layer2, LineStyle, Point2, Scene2, Shape2, Tone,
};

/// The picture of a circle in the polygon whose vertices are the rows of `source`.
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
    agree("number of coordinates", 2, source.dim())?;
    all_there("number of points", &certificate.touching, source.len())?;
    let center = answer.center.iter().map(|x| ("a coordinate of the center", x));
    all_finite(center.chain([("the radius", &answer.radius)]))?;
    let ring = read(source)?;
    let edge = |row: u64| {
        let row = row as usize;
        [ring[row], ring[if row + 1 == ring.len() { 0 } else { row + 1 }]]
    };
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
    let outline = Shape2::Polygons(vec![thinned(&ring, options)]);
    let gap = match certificate.gap {
        gap if gap.is_finite() => format!("certified gap {}", short(gap, 3)),
        _ => "no gap is certified".to_owned(),
    };
    let scene = Scene2 {
        title: format!("Largest circle in a polygon of {vertices}"),
        caption: format!(
            "Radius {}; {gap}. It touches {}.",
            short(answer.radius, 8),
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

/// All vertices, which must be finite.
fn read(source: &dyn PointSource) -> Result<Vec<[f64; 2]>, Error> {
    let rows: Vec<u64> = (0..source.len()).collect();
    let values = gather(source, &rows)?;
    if let Some(at) = values.iter().position(|x| !x.is_finite()) {
        let what = format!("coordinate {} of point {}", at % 2, at / 2);
        return Err(Error::NonFinite { what, value: values[at] });
    }
    Ok(values.chunks_exact(2).map(|at| [at[0], at[1]]).collect())
}

/// The ring without vertices that are within half a pixel of the one before.
fn thinned(ring: &[[f64; 2]], options: &DrawOptions) -> Vec<[f64; 2]> {
    let extent = |k: usize| {
        let low = ring.iter().fold(f64::INFINITY, |least, at| least.min(at[k]));
        let high = ring.iter().fold(f64::NEG_INFINITY, |most, at| most.max(at[k]));
        high - low
    };
    let step = (extent(0) / options.width).max(extent(1) / options.height) / 2.0;
    let mut kept: Vec<[f64; 2]> = vec![];
    for &at in ring {
        let is_near =
            kept.last().is_some_and(|last| (at[0] - last[0]).hypot(at[1] - last[1]) < step);
        if !is_near {
            kept.push(at);
        }
    }
    kept
}

/// The point of the segment ab that is nearest to p.
fn nearest(p: [f64; 2], a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    let e = [b[0] - a[0], b[1] - a[1]];
    let square = e[0] * e[0] + e[1] * e[1];
    let share = ((p[0] - a[0]) * e[0] + (p[1] - a[1]) * e[1]) / square;
    let share = if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.0 };
    [a[0] + share * e[0], a[1] + share * e[1]]
}
