//! A polytope of three dimensions, to be turned: its facets as rings of edges, the ellipsoid inside as a net.
//!
//! *Idea.* A facet is what all other half-spaces leave of the plane of its own, so each is found by itself.

use super::clip::{HalfPlane, Polygon, polygon};
use super::sides::Side;
use super::{ELLIPSOID, Picture};
use crate::ellipsoid::plane::LARGE_CORNERS;
use crate::ellipsoid::space::{Place, at, azimuth, net};
use crate::project::dot;
use crate::{Layer3, Look, Point3, Projection, Scene3, Shape3, Tone};

/// At most this many half-spaces are drawn: the work grows with their square.
pub(super) const HALF_SPACES_MAX: usize = 2000;

/// This far around the ellipsoid is looked at first, in half axes: the polytope lies within d.
const FIRST_REACH: f64 = 8.0;

/// Two directions at right angles to a third, all of length 1 (Duff et al., Journal of Computer Graphics Techniques 6(1),
/// 2017).
fn beside([x, y, z]: Place) -> [Place; 2] {
    let sign = 1f64.copysign(z);
    let (a, b) = (-1.0 / (sign + z), -x * y / (sign + z));
    [[1.0 + sign * x * x * a, sign * b, -sign * x], [b, sign + y * y * a, -y]]
}

impl Picture<'_> {
    /// d = 3: to be turned.
    pub(super) fn space(&self) -> Scene3 {
        let center = at(&self.body.center);
        let axes = self.body.principal();
        let mut is_whole = true;
        let mut rings = Vec::new();
        for i in 0..self.sides.near.len() {
            let (ring, ends) = self.facet(i);
            is_whole &= ends;
            if ring.len() > 2 {
                rings.push(ring);
            }
        }
        let marks = self.sides.support().map(|side| Point3 {
            id: Some(side.id),
            at: at(&self.touching(side)),
            size: self.size(side),
            label: Self::label(side),
        });
        let layer = |name: &str, tone, look, shape| Layer3 { name: name.into(), tone, look, shape };
        let layers = vec![
            layer(
                ELLIPSOID,
                Tone::Answer,
                Look::Thin,
                Shape3::Polylines(net(center, &axes, 1.0, LARGE_CORNERS / 2, true)),
            ),
            layer("polytope", Tone::Point, Look::Solid, Shape3::Polylines(rings)),
            layer(
                &self.touching_name(),
                Tone::Support,
                Look::Solid,
                Shape3::Points(marks.collect()),
            ),
            layer("centre", Tone::Ink, Look::Solid, Shape3::Crosses(vec![center])),
        ];
        Scene3 {
            title: self.title(),
            caption: self.caption(is_whole),
            axes: [0, 1, 2].map(|k| self.options.axis(k, 3)),
            layers,
            projection: Projection::Perspective,
            azimuth: azimuth(&axes),
            elevation: 22.0,
            width: self.options.width,
            height: self.options.height,
        }
    }

    /// The facet on one half-space, as a closed ring, and whether it has an end.
    fn facet(&self, which: usize) -> (Vec<Place>, bool) {
        let sides = &self.sides.near;
        let own = &sides[which];
        let normal = at(&own.seen);
        let [u, v] = beside(normal);
        let mut half_planes: Vec<HalfPlane> = Vec::with_capacity(sides.len());
        for (place, other) in sides.iter().enumerate() {
            if place == which {
                continue;
            }
            let (slope, offset) = seen_in(own, other, [u, v]);
            let is_parallel = slope.iter().all(|s| s.abs() < 1e-12);
            match is_parallel {
                // The same plane once more: the first of them has the facet.
                true if offset < 1e-12 && (offset < -1e-12 || place < which) => {
                    return (vec![], true);
                }
                true => {}
                false => half_planes.push((slope, offset)),
            }
        }
        let Polygon { corners, is_whole } = polygon(&half_planes, FIRST_REACH);
        let corner = |[a, b]: [f64; 2]| {
            at(&self.place(&[0, 1, 2].map(|k| own.distance * normal[k] + a * u[k] + b * v[k])))
        };
        let mut ring: Vec<Place> = corners.into_iter().map(corner).collect();
        ring.extend(ring.first().copied());
        (ring, is_whole)
    }
}

/// Another half-space in the plane of one, with its foot as the origin.
fn seen_in(own: &Side, other: &Side, axes: [Place; 2]) -> HalfPlane {
    let offset = other.distance - own.distance * dot(&own.seen, &other.seen);
    (axes.map(|axis| dot(&axis, &other.seen)), offset)
}
