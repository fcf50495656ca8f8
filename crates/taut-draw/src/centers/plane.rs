//! Centres in one or two dimensions as they are, and the layers that a projection shares.

use taut_certify::Items;

use super::{Group, Picture};
use crate::{Aspect, Axis, Circle2, Error, Layer2, Look, Point2, Scene2, Shape2, Tone};

impl Picture<'_> {
    /// The layers of a plane picture; `place` says where a position is drawn.
    pub(super) fn layers(
        &self,
        place: impl Fn(&[f64]) -> [f64; 2],
        balls: String,
    ) -> Result<Vec<Layer2>, Error> {
        let centers: Vec<[f64; 2]> = self.answer.centers.iter().map(|c| place(c)).collect();
        let circles = |radius: f64| {
            let circle = |&center: &[f64; 2]| Circle2 { id: None, center, radius };
            Shape2::Circles(centers.iter().map(circle).collect())
        };
        let mut layers = vec![];
        if self.has_balls() {
            let (tone, look) = (Tone::Answer, Look::Filled);
            layers.push(Layer2 { name: balls, tone, look, shape: circles(self.answer.radius) });
        }
        let groups = self.groups()?;
        let [others, marked @ ..] = &groups;
        layers.extend(self.group_of_points(others, &place));
        if self.lower_is_visible() {
            layers.push(Layer2 {
                name: "lower bound".into(),
                tone: Tone::Bound,
                look: Look::Dashed,
                shape: circles(self.answer.lower_bound),
            });
        }
        for group in marked {
            layers.extend(self.group_of_points(group, &place));
        }
        layers.push(Layer2 {
            name: self.centers_name(),
            tone: Tone::Ink,
            look: Look::Solid,
            shape: Shape2::Crosses(centers),
        });
        Ok(layers)
    }

    /// A layer of discs, or for balls of their circles.
    fn group_of_points(&self, group: &Group, place: impl Fn(&[f64]) -> [f64; 2]) -> Option<Layer2> {
        let rows = group.rows.chunks_exact(self.source.dim());
        let each = group.ids.iter().zip(rows).map(|(&id, row)| {
            let at = place(&row[..self.dim]);
            (id, at, self.own_radius(row))
        });
        let shape = match self.certificate.items {
            Items::Balls => Shape2::Circles(
                each.map(|(id, center, radius)| Circle2 { id: Some(id), center, radius }).collect(),
            ),
            Items::Points | Items::Ellipsoids => Shape2::Points(
                each.map(|(id, at, _)| {
                    let label = group.label.into();
                    Point2 { id: Some(id), at, size: group.size, label }
                })
                .collect(),
            ),
        };
        let (name, tone) = (group.name.clone(), group.tone);
        (!group.ids.is_empty()).then_some(Layer2 { name, tone, look: Look::Filled, shape })
    }

    /// d = 1: the balls are intervals.
    pub(super) fn line(&self) -> Result<Scene2, Error> {
        let name = self.balls_name("interval", "intervals");
        let mut layers = self.layers(|at| [at[0], 0.0], name)?;
        let half = 0.3 * self.answer.radius;
        for layer in &mut layers {
            let Shape2::Circles(circles) = &layer.shape else { continue };
            let ends = circles.iter().map(|c| [c.center[0] - c.radius, c.center[0] + c.radius]);
            layer.shape = match layer.tone {
                Tone::Answer | Tone::Bound => {
                    let half = if layer.tone == Tone::Answer { half } else { 0.8 * half };
                    let band =
                        |[a, b]: [f64; 2]| vec![[a, -half], [b, -half], [b, half], [a, half]];
                    Shape2::Polygons(ends.map(band).collect())
                }
                _ => Shape2::Polylines(ends.map(|[a, b]| vec![[a, 0.0], [b, 0.0]]).collect()),
            };
        }
        Ok(Scene2 {
            title: self.title(),
            caption: format!(
                "{}{} The vertical direction has no meaning.",
                self.facts(),
                self.counts()
            ),
            x: self.options.axis(0, 1),
            y: Axis::default(),
            aspect: Aspect::Free,
            layers,
            width: self.options.width,
            height: self.options.height.min(260.0),
        })
    }

    /// d = 2: as it is.
    pub(super) fn plane(&self) -> Result<Scene2, Error> {
        let layers = self.layers(|at| [at[0], at[1]], self.balls_name("circle", "circles"))?;
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
}
