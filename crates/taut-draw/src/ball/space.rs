//! A ball of three dimensions, to be turned.

use taut_certify::Items;
use taut_points::gather;

use super::Picture;
use crate::{Error, Layer3, Look, Point3, Projection, Scene3, Shape3, Sphere3, Tone};

impl Picture<'_> {
    /// d = 3: to be turned.
    pub(super) fn space(&self) -> Result<Scene3, Error> {
        let others = self.others();
        let balls = self.certificate().items == Items::Balls;
        let center = [self.ball().center[0], self.ball().center[1], self.ball().center[2]];
        let sphere = |id, radius| Sphere3 { id, center, radius };
        let mut layers = vec![Layer3 {
            name: "smallest ball".into(),
            tone: Tone::Answer,
            look: Look::Filled,
            shape: Shape3::Spheres(vec![sphere(None, self.ball().radius)]),
        }];
        let rows = gather(self.source, &others)?;
        let at = |row: &[f64]| [row[0], row[1], row[2]];
        if !others.is_empty() {
            let each = others.iter().zip(rows.chunks_exact(self.source.dim()));
            let shape = if balls {
                let ball = |(&id, row): (&u64, &[f64])| Sphere3 {
                    id: Some(id),
                    center: at(row),
                    radius: row[3],
                };
                Shape3::Spheres(each.map(ball).collect())
            } else {
                let size = self.dot_size();
                let point = |(&id, row): (&u64, &[f64])| Point3 {
                    id: Some(id),
                    at: at(row),
                    size,
                    label: String::new(),
                };
                Shape3::Points(each.map(point).collect())
            };
            layers.push(Layer3 {
                name: self.others_name(),
                tone: Tone::Point,
                look: Look::Filled,
                shape,
            });
        }
        if self.lower_is_visible() {
            layers.push(Layer3 {
                name: "lower bound".into(),
                tone: Tone::Bound,
                look: Look::Dashed,
                shape: Shape3::Spheres(vec![sphere(None, self.lower())]),
            });
        }
        let (mut marks, mut spheres) = (Vec::new(), Vec::new());
        for (id, size, label) in self.support() {
            let row = self.row(id)?;
            marks.push(Point3 { id: Some(id), at: at(&row), size, label });
            spheres.push(Sphere3 {
                id: None,
                center: at(&row),
                radius: row.get(3).copied().unwrap_or(0.0),
            });
        }
        if balls {
            layers.push(Layer3 {
                name: String::new(),
                tone: Tone::Support,
                look: Look::Filled,
                shape: Shape3::Spheres(spheres),
            });
        }
        layers.push(Layer3 {
            name: self.support_name(),
            tone: Tone::Support,
            look: Look::Solid,
            shape: Shape3::Points(marks),
        });
        layers.push(Layer3 {
            name: "centre".into(),
            tone: Tone::Ink,
            look: Look::Solid,
            shape: Shape3::Crosses(vec![center]),
        });
        Ok(Scene3 {
            title: self.title(),
            caption: self.facts() + &self.counts(),
            axes: [0, 1, 2].map(|k| self.options.axis(k, 3)),
            layers,
            projection: Projection::Perspective,
            azimuth: 35.0,
            elevation: 22.0,
            width: self.options.width,
            height: self.options.height,
        })
    }
}
