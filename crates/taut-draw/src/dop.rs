//! The figure of a bounding dop.
//!
//! *Guarantee.* All facets are drawn, translucent, and the points that they touch. Of many other points a sample is drawn, and the
//! caption says so.

use taut_certify::{BoundingDop, Solution};
use taut_points::{PointSource, gather};

use crate::marks::{agree, all_there, dot_size};
use crate::number::{counted, exact};
use crate::{DrawOptions, Error, Figure, Layer3, LineStyle, Mesh3, Point3, Scene3, Shape3, Tone};

/// The radius of the disc of a point that is touched, in pixels.
const TOUCHED_SIZE: f64 = 4.5;

/// The picture of a bounding dop around the points of `source`.
///
/// # Errors
/// [`Error::Mismatch`] when `source` has not points of space, [`Error::NonFinite`], [`Error::Option`], [`Error::Read`].
pub fn dop_figures(
    solution: &Solution<BoundingDop>,
    source: &dyn PointSource,
    options: &DrawOptions,
) -> Result<Vec<Figure>, Error> {
    options.check()?;
    agree("number of coordinates", 3, source.dim())?;
    let touching = &solution.certificate.touching;
    all_there("number of points", touching, source.len())?;
    let shown = source.len().min(options.max_points as u64);
    let row = |k: u64| (u128::from(k) * u128::from(source.len()) / u128::from(shown.max(1))) as u64;
    let rows: Vec<u64> = (0..shown).map(row).collect();
    let mut touched = touching.clone();
    touched.sort_unstable();
    touched.dedup();
    let points = |rows: &[u64], size: f64, label: &str| {
        let values = gather(source, rows)?;
        if let Some(at) = values.iter().position(|x| !x.is_finite()) {
            let what = format!("coordinate {} of point {}", at % 3, rows[at / 3]);
            return Err(Error::NonFinite { what, value: values[at] });
        }
        let places = values.as_chunks::<3>().0.iter().zip(rows);
        let point = |(at, &row): (&[f64; 3], &u64)| Point3 {
            id: Some(row),
            at: *at,
            size,
            label: label.to_owned(),
        };
        Ok(Shape3::Points(places.map(point).collect()))
    };
    let answer = &solution.answer;
    let (mut vertices, mut triangles) = (vec![], vec![]);
    for polygon in answer.polygons() {
        let first = vertices.len();
        triangles.extend((2..polygon.len()).map(|k| [first, first + k - 1, first + k]));
        vertices.extend(polygon);
    }
    if let Some(&value) = vertices.as_flattened().iter().find(|x: &&f64| !x.is_finite()) {
        return Err(Error::NonFinite { what: "a vertex of the dop".to_owned(), value });
    }
    let layer = |name: &str, tone, shape| Layer3 {
        name: name.to_owned(),
        tone,
        line_style: LineStyle::Solid,
        shape,
    };
    let mut layers = vec![
        layer("points", Tone::Point, points(&rows, dot_size(rows.len()), "point")?),
        layer("touched", Tone::Support, points(&touched, TOUCHED_SIZE, "touched by a facet")?),
    ];
    // A dop without interior has no facets to draw.
    if !triangles.is_empty() {
        layers.insert(0, layer("dop", Tone::Answer, Shape3::Mesh(Mesh3 { vertices, triangles })));
    }
    let note = match shown < source.len() {
        true => format!(" Of the points {} are drawn.", counted(shown, "point")),
        false => String::new(),
    };
    let caption = format!("Its volume is {}.{note}", exact(answer.volume));
    let title = format!("{}-dop around {}", answer.normals.len(), counted(source.len(), "point"));
    Ok(vec![Figure::Space(Scene3::space(title, caption, layers, options))])
}
