//! Layers in the plane: as they are, as intervals of a line, or projected on two directions.

use taut_certify::Items;

use super::{Group, INNER_BAND_HEIGHT, Layer, Marks};
use crate::body::{Body, Shadow};
use crate::item_pass::Measure;
use crate::project::dot;
use crate::{Circle2, Layer2, LineStyle, Point2, Shape2, Tone};

/// An ellipse drawn large has this many corners.
pub(crate) const LARGE_CORNERS: usize = 240;
/// An ellipse that is one among many has this many corners.
pub(super) const SMALL_CORNERS: usize = 48;

/// A place in a picture of the plane.
pub(crate) type Place = [f64; 2];

/// The data that a projection needs beside the layers.
pub(crate) struct Projected<'a> {
    /// The measure of offsets, and its unit.
    pub(crate) measure: &'a dyn Measure,
    pub(crate) unit: f64,
    /// Two orthonormal directions.
    pub(crate) directions: [Vec<f64>; 2],
    /// The words of the caption about them.
    pub(crate) words: String,
    pub(crate) axes: [&'static str; 2],
}

/// The way in which points of d coordinates are placed in the plane.
pub(super) struct View<'a> {
    pub(super) directions: [Vec<f64>; 2],
    /// The measure of offsets, and its unit; coordinates are drawn as they are without it.
    pub(super) origin: Option<(&'a dyn Measure, f64)>,
    /// On a line, half the height of the band of the answer.
    pub(super) height: Option<f64>,
}

impl View<'_> {
    /// The first two coordinates of `dim`, or the only one.
    pub(super) fn coordinates(dim: usize, height: Option<f64>) -> Self {
        let axis = |k: usize| (0..dim).map(|j| if j == k { 1.0 } else { 0.0 }).collect();
        View { directions: [axis(0), axis(1)], origin: None, height }
    }

    fn place(&self, at: &[f64]) -> Place {
        let along = |at: &[f64]| [0, 1].map(|k| dot(at, &self.directions[k]));
        match self.origin {
            None => along(at),
            Some((measure, unit)) => along(&measure.offset(at)).map(|x| x * unit),
        }
    }

    pub(super) fn layer(&self, Layer { name, tone, line_style, marks }: Layer<'_>) -> Layer2 {
        let (line_style, shape) = match marks {
            Marks::Balls { centers, radius } => {
                let circle =
                    |center: &Vec<f64>| Circle2 { id: None, center: self.place(center), radius };
                let circles: Vec<Circle2> = centers.iter().map(circle).collect();
                (line_style, self.bands(&circles, tone).unwrap_or(Shape2::Circles(circles)))
            }
            Marks::Ellipsoid { body, part } => (line_style, self.outline(body, part, tone)),
            Marks::Items(group) => (
                if group.items == Items::Ellipsoids { LineStyle::Thin } else { line_style },
                self.items(&group),
            ),
            Marks::Points(marks) => {
                let point = |mark: super::Mark| Point2 {
                    id: Some(mark.id),
                    at: self.place(&mark.at),
                    size: mark.size,
                    label: mark.label,
                };
                (line_style, Shape2::Points(marks.into_iter().map(point).collect()))
            }
            Marks::Crosses(centers) => {
                (line_style, Shape2::Crosses(centers.iter().map(|at| self.place(at)).collect()))
            }
            Marks::Plane(shape) => (line_style, shape),
            Marks::Space(_) => (line_style, Shape2::Points(Vec::new())),
        };
        Layer2 { name, tone, line_style, shape }
    }

    /// On a line, intervals as bands.
    fn bands(&self, circles: &[Circle2], tone: Tone) -> Option<Shape2> {
        let full = self.height?;
        let h = if tone == Tone::Answer { full } else { INNER_BAND_HEIGHT * full };
        let band = |circle: &Circle2| {
            let (a, b) = (circle.center[0] - circle.radius, circle.center[0] + circle.radius);
            vec![[a, -h], [b, -h], [b, h], [a, h]]
        };
        Some(Shape2::Polygons(circles.iter().map(band).collect()))
    }

    /// An ellipsoid: an ellipse, a segment, or nothing where it is one point.
    fn outline(&self, body: &Body, part: f64, tone: Tone) -> Shape2 {
        let center = self.place(&body.center);
        let shadow = body.shadow_along(&self.directions);
        let Shadow([[wide, _], _]) = shadow;
        let interval = Circle2 { id: None, center, radius: part * wide };
        if let Some(bands) = self.bands(&[interval], tone) {
            return bands;
        }
        if body.rank() >= 2 {
            return Shape2::Polygons(vec![shadow.chain(center, part, LARGE_CORNERS)]);
        }
        let segment = |axis: Vec<f64>| {
            let end = |sign: f64| {
                let end = body.center.iter().zip(&axis).map(|(c, a)| c + sign * part * a);
                self.place(&end.collect::<Vec<f64>>())
            };
            vec![end(-1.0), end(1.0)]
        };
        Shape2::Polylines(body.principal().into_iter().map(segment).collect())
    }

    /// Items as discs, circles or ellipses; as segments on a line.
    fn items(&self, group: &Group) -> Shape2 {
        let dim = self.directions[0].len();
        if group.items == Items::Points {
            let point = |(id, row): (u64, &[f64])| Point2 {
                id: Some(id),
                at: self.place(row),
                size: group.scale * group.size,
                label: group.label.into(),
            };
            return Shape2::Points(group.each().map(point).collect());
        }
        let half = |row: &[f64]| match group.items {
            Items::Ellipsoids => Shadow::of_row(row, &self.directions).0[0][0],
            _ => row[dim],
        };
        if self.height.is_some() {
            let segment = |(_, row): (u64, &[f64])| {
                vec![[row[0] - half(row), 0.0], [row[0] + half(row), 0.0]]
            };
            return Shape2::Polylines(group.each().map(segment).collect());
        }
        if group.items == Items::Balls {
            let circle = |(id, row): (u64, &[f64])| Circle2 {
                id: Some(id),
                center: self.place(row),
                radius: row[dim],
            };
            return Shape2::Circles(group.each().map(circle).collect());
        }
        let chain = |(_, row): (u64, &[f64])| {
            Shadow::of_row(row, &self.directions).chain(self.place(row), 1.0, SMALL_CORNERS)
        };
        Shape2::Polygons(group.each().map(chain).collect())
    }
}
