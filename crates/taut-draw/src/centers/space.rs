//! Centres in three dimensions, to be turned.

use taut_certify::Items;

use super::{Group, Picture};
use crate::{Error, Layer3, Look, Point3, Projection, Scene3, Shape3, Sphere3, Tone};

fn at(row: &[f64]) -> [f64; 3] {
    [row[0], row[1], row[2]]
}

impl Picture<'_> {
    /// d = 3: to be turned.
    pub(super) fn space(&self) -> Result<Scene3, Error> {
        let spheres = |radius: f64| {
            let sphere = |center: &Vec<f64>| Sphere3 { id: None, center: at(center), radius };
            Shape3::Spheres(self.answer.centers.iter().map(sphere).collect())
        };
        let mut layers = vec![];
        if self.has_balls() {
            layers.push(Layer3 {
                name: self.balls_name("sphere", "spheres"),
                tone: Tone::Answer,
                look: Look::Filled,
                shape: spheres(self.answer.radius),
            });
        }
        let groups = self.groups()?;
        let [others, marked @ ..] = &groups;
        layers.extend(self.group_in_space(others));
        if self.lower_is_visible() {
            layers.push(Layer3 {
                name: "lower bound".into(),
                tone: Tone::Bound,
                look: Look::Dashed,
                shape: spheres(self.answer.lower_bound),
            });
        }
        for group in marked {
            layers.extend(self.group_in_space(group));
        }
        layers.push(Layer3 {
            name: self.centers_name(),
            tone: Tone::Ink,
            look: Look::Solid,
            shape: Shape3::Crosses(self.answer.centers.iter().map(|c| at(c)).collect()),
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

    /// A layer of discs, or for balls of their spheres.
    fn group_in_space(&self, group: &Group) -> Option<Layer3> {
        let each = group.ids.iter().zip(group.rows.chunks_exact(self.source.dim()));
        let shape = match self.certificate.items {
            Items::Balls => Shape3::Spheres(
                each.map(|(&id, row)| Sphere3 {
                    id: Some(id),
                    center: at(row),
                    radius: self.own_radius(row),
                })
                .collect(),
            ),
            Items::Points | Items::Ellipsoids => Shape3::Points(
                each.map(|(&id, row)| {
                    let label = group.label.into();
                    Point3 { id: Some(id), at: at(row), size: group.size, label }
                })
                .collect(),
            ),
        };
        let (name, tone) = (group.name.clone(), group.tone);
        (!group.ids.is_empty()).then_some(Layer3 { name, tone, look: Look::Filled, shape })
    }
}
