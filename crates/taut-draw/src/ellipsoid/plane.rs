//! An ellipsoid of one or two dimensions as it is.

use super::Picture;
use super::body::Shadow;
use crate::{Aspect, Axis, Error, Layer2, Look, Point2, Scene2, Shape2, Tone};

/// An ellipse drawn large has this many corners.
pub(crate) const LARGE_CORNERS: usize = 240;
/// An ellipse that is one among many has this many corners.
pub(super) const SMALL_CORNERS: usize = 48;

/// Marks of items left out are this many times as large: their tone is not all that tells them.
pub(crate) const LEFT_OUT_SCALE: f64 = 1.6;

/// A layer of the ellipsoid to compare with.
pub(super) fn compared(shape: Shape2) -> Layer2 {
    Layer2 { name: super::robust::KEPT_LABEL.into(), tone: Tone::Second, look: Look::Dashed, shape }
}

/// One place of a plane picture.
pub(crate) type Place = [f64; 2];

impl Picture<'_> {
    /// Items as discs, or as ellipses where they have an extent.
    pub(super) fn items(
        &self,
        ids: &[u64],
        name: String,
        tone: Tone,
        size: f64,
        place: impl Fn(&[f64]) -> (Place, Option<Shadow>),
    ) -> Result<Option<Layer2>, Error> {
        let (mut points, mut chains) = (Vec::new(), Vec::new());
        for &id in ids {
            match place(&self.row(id)?) {
                (at, None) => {
                    points.push(Point2 { id: Some(id), at, size, label: String::new() });
                }
                (at, Some(shadow)) => chains.push(shadow.chain(at, 1.0, SMALL_CORNERS)),
            }
        }
        let shape = match (points.is_empty(), chains.is_empty()) {
            (true, true) => return Ok(None),
            (_, true) => Shape2::Points(points),
            (_, false) => Shape2::Polygons(chains),
        };
        let look = if matches!(shape, Shape2::Points(_)) { Look::Filled } else { Look::Thin };
        Ok(Some(Layer2 { name, tone, look, shape }))
    }

    /// d = 2: as it is.
    pub(super) fn plane(&self) -> Result<Scene2, Error> {
        let (dim, items) = (self.dim(), self.certificate().items);
        let center = [self.body.center[0], self.body.center[1]];
        let shadow = self.body.shadow(0, 1);
        let place = |row: &[f64]| ([row[0], row[1]], Shadow::of_item(items, dim, row, 0, 1));
        let outline = |part: f64| match self.rank() {
            2 => Shape2::Polygons(vec![shadow.chain(center, part, LARGE_CORNERS)]),
            // A segment, or nothing but the centre.
            rank => Shape2::Polylines(
                self.body.principal()[..rank]
                    .iter()
                    .map(|axis| {
                        [-part, part].map(|t| [center[0] + t * axis[0], center[1] + t * axis[1]])
                    })
                    .map(|ends| ends.to_vec())
                    .collect(),
            ),
        };
        let mut layers = self.layers(outline, place, center, |mark| [mark[0], mark[1]])?;
        if let Some(second) = self.second() {
            let center = [second.center[0], second.center[1]];
            let chain = second.shadow(0, 1).chain(center, 1.0, LARGE_CORNERS);
            layers.insert(1, compared(Shape2::Polygons(vec![chain])));
        }
        Ok(Scene2 {
            title: self.title(),
            caption: self.facts() + &self.counts(),
            x: self.options.axis(0, 2),
            y: self.options.axis(1, 2),
            aspect: Aspect::Equal,
            layers,
            width: self.options.width,
            height: self.options.height,
        })
    }

    /// d = 1: an interval.
    pub(super) fn line(&self) -> Result<Scene2, Error> {
        let (center, half) = (self.body.center[0], self.body.half_width(0));
        let items = self.certificate().items;
        let band = |part: f64| {
            let (a, b, h) = (center - part * half, center + part * half, 0.3 * part * half);
            Shape2::Polygons(vec![vec![[a, -h], [b, -h], [b, h], [a, h]]])
        };
        let place = |row: &[f64]| {
            let own = Shadow::of_item(items, 1, row, 0, 0);
            ([row[0], 0.0], own.map(|Shadow([[wide, _], _])| Shadow([[wide, 0.0], [0.0, 0.0]])))
        };
        let layers = self.layers(band, place, [center, 0.0], |mark| [mark[0], 0.0])?;
        let no_height = " The vertical direction has no meaning.";
        Ok(Scene2 {
            title: self.title(),
            caption: self.facts() + &self.counts() + no_height,
            x: self.options.axis(0, 1),
            y: Axis::default(),
            aspect: Aspect::Free,
            layers,
            width: self.options.width,
            height: self.options.height.min(260.0),
        })
    }

    fn layers(
        &self,
        outline: impl Fn(f64) -> Shape2,
        place: impl Fn(&[f64]) -> (Place, Option<Shadow>),
        center: Place,
        marked: impl Fn(&[f64]) -> Place,
    ) -> Result<Vec<Layer2>, Error> {
        let (inside, out) = self.others();
        let mut layers = vec![Layer2 {
            name: self.name(),
            tone: Tone::Answer,
            look: Look::Filled,
            shape: outline(1.0),
        }];
        let size = self.dot_size();
        layers.extend(self.items(&inside, self.others_name(), Tone::Point, size, &place)?);
        let (name, larger) = (self.left_out_name(), LEFT_OUT_SCALE * size);
        layers.extend(self.items(&out, name, Tone::Third, larger, &place)?);
        if self.lower_is_visible() {
            layers.push(Layer2 {
                name: "lower bound".into(),
                tone: Tone::Bound,
                look: Look::Dashed,
                shape: outline(self.lower()),
            });
        }
        let mark = |mark: super::Mark| Point2 {
            id: Some(mark.id),
            at: marked(&mark.at),
            size: mark.size,
            label: mark.label,
        };
        let marks: Vec<Point2> = self.support()?.into_iter().map(mark).collect();
        layers.extend((!marks.is_empty()).then(|| Layer2 {
            name: self.support_name(),
            tone: Tone::Support,
            look: Look::Solid,
            shape: Shape2::Points(marks),
        }));
        layers.push(Layer2 {
            name: "centre".into(),
            tone: Tone::Ink,
            look: Look::Solid,
            shape: Shape2::Crosses(vec![center]),
        });
        Ok(layers)
    }
}
