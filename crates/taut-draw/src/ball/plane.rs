//! A ball of one or two dimensions as it is, and the layers that a projection shares.

use taut_certify::Items;

use super::Picture;
use crate::{Aspect, Axis, Circle2, Error, Layer2, Look, Point2, Scene2, Shape2, Tone};

impl Picture<'_> {
    /// The layers of a plane picture; `place` says where an item is drawn, and its own radius.
    pub(super) fn layers(
        &self,
        place: impl Fn(u64) -> Result<([f64; 2], f64), Error>,
        center: [f64; 2],
        answer: &str,
    ) -> Result<Vec<Layer2>, Error> {
        let others = self.others();
        let places = others.iter().map(|&id| place(id)).collect::<Result<Vec<_>, _>>()?;
        let size = self.dot_size();
        let mut layers = vec![Layer2 {
            name: answer.to_owned(),
            tone: Tone::Answer,
            look: Look::Filled,
            shape: Shape2::Circles(vec![Circle2 { id: None, center, radius: self.ball().radius }]),
        }];
        let balls = self.certificate().items == Items::Balls;
        if !others.is_empty() {
            let shape = if balls {
                let circle = |(&id, &(center, radius)): (&u64, &([f64; 2], f64))| Circle2 {
                    id: Some(id),
                    center,
                    radius,
                };
                Shape2::Circles(others.iter().zip(&places).map(circle).collect())
            } else {
                let point = |(&id, &(at, _)): (&u64, &([f64; 2], f64))| Point2 {
                    id: Some(id),
                    at,
                    size,
                    label: String::new(),
                };
                Shape2::Points(others.iter().zip(&places).map(point).collect())
            };
            layers.push(Layer2 {
                name: self.others_name(),
                tone: Tone::Point,
                look: Look::Filled,
                shape,
            });
        }
        if self.lower_is_visible() {
            layers.push(Layer2 {
                name: "lower bound".into(),
                tone: Tone::Bound,
                look: Look::Dashed,
                shape: Shape2::Circles(vec![Circle2 { id: None, center, radius: self.lower() }]),
            });
        }
        let mut marks = Vec::new();
        let mut circles = Vec::new();
        for (id, size, label) in self.support() {
            let (at, radius) = place(id)?;
            marks.push(Point2 { id: Some(id), at, size, label });
            circles.push(Circle2 { id: None, center: at, radius });
        }
        if balls {
            layers.push(Layer2 {
                name: String::new(),
                tone: Tone::Support,
                look: Look::Filled,
                shape: Shape2::Circles(circles),
            });
        }
        layers.push(Layer2 {
            name: self.support_name(),
            tone: Tone::Support,
            look: Look::Solid,
            shape: Shape2::Points(marks),
        });
        layers.push(Layer2 {
            name: "centre".into(),
            tone: Tone::Ink,
            look: Look::Solid,
            shape: Shape2::Crosses(vec![center]),
        });
        Ok(layers)
    }

    /// d = 1: the ball is an interval.
    pub(super) fn line(&self) -> Result<Scene2, Error> {
        let (center, radius) = (self.ball().center[0], self.ball().radius);
        let own = |row: &[f64]| if row.len() > 1 { row[1] } else { 0.0 };
        let mut layers = self.layers(
            |id| self.row(id).map(|row| ([row[0], 0.0], own(&row))),
            [center, 0.0],
            "smallest ball, an interval",
        )?;
        let half = 0.3 * radius;
        let band = |reach: f64, half: f64| {
            let (a, b) = (center - reach, center + reach);
            Shape2::Polygons(vec![vec![[a, -half], [b, -half], [b, half], [a, half]]])
        };
        for layer in &mut layers {
            if let Shape2::Circles(circles) = &layer.shape {
                layer.shape = match layer.tone {
                    Tone::Answer => band(radius, half),
                    Tone::Bound => band(self.lower(), 0.8 * half),
                    _ => Shape2::Polylines(
                        circles
                            .iter()
                            .map(|c| {
                                vec![[c.center[0] - c.radius, 0.0], [c.center[0] + c.radius, 0.0]]
                            })
                            .collect(),
                    ),
                };
            }
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
        let own = |row: &[f64]| row.get(2).copied().unwrap_or(0.0);
        let center = [self.ball().center[0], self.ball().center[1]];
        let layers = self.layers(
            |id| self.row(id).map(|row| ([row[0], row[1]], own(&row))),
            center,
            "smallest ball",
        )?;
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
