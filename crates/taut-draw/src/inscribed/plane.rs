//! A polytope of one or two dimensions as it is.

use super::clip::{Polygon, polygon};
use super::{ELLIPSOID, Picture};
use crate::ellipsoid::plane::LARGE_CORNERS;
use crate::{Aspect, Axis, Layer2, Look, Point2, Scene2, Shape2, Tone};

/// This far around the ellipsoid is looked at first, in half axes: the polytope lies within d.
const FIRST_REACH: f64 = 4.0;

impl Picture<'_> {
    /// d = 2.
    pub(super) fn plane(&self) -> Scene2 {
        let half_planes: Vec<_> = self
            .sides
            .near
            .iter()
            .map(|side| ([side.seen[0], side.seen[1]], side.distance))
            .collect();
        let Polygon { corners, is_whole } = polygon(&half_planes, FIRST_REACH);
        let at = |y: &[f64]| {
            let x = self.place(y);
            [x[0], x[1]]
        };
        let corners = corners.iter().map(|y| at(y)).collect();
        let center = [self.body.center[0], self.body.center[1]];
        let ellipse = self.body.shadow(0, 1).chain(center, 1.0, LARGE_CORNERS);
        let layers = self.layers(vec![corners], vec![ellipse], center, |x| [x[0], x[1]]);
        Scene2 {
            title: self.title(),
            caption: self.caption(is_whole),
            x: self.options.axis(0, 2),
            y: self.options.axis(1, 2),
            aspect: Aspect::Equal,
            layers,
            width: self.options.width,
            height: self.options.height,
        }
    }

    /// d = 1: both are one interval.
    pub(super) fn line(&self) -> Scene2 {
        let (center, half) = (self.body.center[0], self.body.half_width(0));
        let end = |sign: f64| {
            let ends = self.sides.near.iter().filter(|side| side.seen[0] * sign > 0.0);
            ends.map(|side| side.distance).fold(f64::INFINITY, f64::min)
        };
        let is_whole = end(1.0).is_finite() && end(-1.0).is_finite();
        let place = |sign: f64| center + sign * half * end(sign).min(FIRST_REACH);
        let band = |a: f64, b: f64, h: f64| vec![[a, -h], [b, -h], [b, h], [a, h]];
        let outer = band(place(-1.0), place(1.0), 0.36 * half);
        let inner = band(center - half, center + half, 0.3 * half);
        let layers = self.layers(vec![outer], vec![inner], [center, 0.0], |x| [x[0], 0.0]);
        Scene2 {
            title: self.title(),
            caption: self.caption(is_whole) + " The vertical direction has no meaning.",
            x: self.options.axis(0, 1),
            y: Axis::default(),
            aspect: Aspect::Free,
            layers,
            width: self.options.width,
            height: self.options.height.min(260.0),
        }
    }

    fn layers(
        &self,
        polytope: Vec<Vec<[f64; 2]>>,
        ellipsoid: Vec<Vec<[f64; 2]>>,
        center: [f64; 2],
        at: impl Fn(&[f64]) -> [f64; 2],
    ) -> Vec<Layer2> {
        let marks = self.sides.support().map(|side| Point2 {
            id: Some(side.id),
            at: at(&self.touching(side)),
            size: self.size(side),
            label: Self::label(side),
        });
        let layer = |name: &str, tone, look, shape| Layer2 { name: name.into(), tone, look, shape };
        vec![
            layer("polytope", Tone::Point, Look::Filled, Shape2::Polygons(polytope)),
            layer(ELLIPSOID, Tone::Answer, Look::Filled, Shape2::Polygons(ellipsoid)),
            layer(
                &self.touching_name(),
                Tone::Support,
                Look::Solid,
                Shape2::Points(marks.collect()),
            ),
            layer("centre", Tone::Ink, Look::Solid, Shape2::Crosses(vec![center])),
        ]
    }
}
