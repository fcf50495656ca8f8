//! A polytope of one, two or three dimensions as it is: an interval, a polygon, or its facets as rings of edges.
//!
//! *Idea.* A facet is what all other half-spaces leave of the plane of its own, so each is found by itself.

use super::Picture;
use super::clip::{HalfPlane, Polygon, polygon};
use super::sides::Side;
use crate::project::dot;
use crate::scene::{BAND_HEIGHT, Marks, at};
use crate::{Shape2, Shape3};

/// At most this many half-spaces of space are drawn: the work grows with their square.
pub(super) const HALF_SPACES_MAX: usize = 2000;

/// This far around the ellipsoid is looked at first, in half axes: the polytope lies within d.
const FIRST_REACH: f64 = 4.0;

/// The same on a facet, which may lie far from the projection of the origin.
const FACET_REACH: f64 = 8.0;

/// The band of an interval around the ellipsoid is higher than that of the ellipsoid by this factor.
const OUTER_BAND_SCALE: f64 = 1.2;

/// Two directions at right angles to a third, all of length 1 (Duff et al., Journal of Computer Graphics Techniques 6(1),
/// 2017).
fn beside([x, y, z]: [f64; 3]) -> [[f64; 3]; 2] {
    let sign = 1f64.copysign(z);
    let (a, b) = (-1.0 / (sign + z), -x * y / (sign + z));
    [[1.0 + sign * x * x * a, sign * b, -sign * x], [b, sign + y * y * a, -y]]
}

impl Picture<'_> {
    /// Returns what is drawn of the polytope, and whether all of it is.
    pub(super) fn polytope(&self) -> (Marks<'static>, bool) {
        match self.dim() {
            1 => self.interval(),
            2 => self.polygon(),
            _ => {
                let facets = (0..self.sides.near.len()).map(|i| self.facet(i));
                let (rings, ends): (Vec<_>, Vec<_>) = facets.unzip();
                let rings = rings.into_iter().filter(|ring: &Vec<_>| ring.len() > 2).collect();
                (Marks::Space(Shape3::Polylines(rings)), ends.into_iter().all(|ends| ends))
            }
        }
    }

    fn interval(&self) -> (Marks<'static>, bool) {
        let (center, half) = (self.body.center[0], self.body.half_width(0));
        let end = |sign: f64| {
            let ends = self.sides.near.iter().filter(|side| side.seen[0] * sign > 0.0);
            ends.map(|side| side.distance).fold(f64::INFINITY, f64::min)
        };
        let is_whole = end(1.0).is_finite() && end(-1.0).is_finite();
        let [a, b] = [-1.0, 1.0].map(|sign| center + sign * half * end(sign).min(FIRST_REACH));
        let h = OUTER_BAND_SCALE * BAND_HEIGHT * half;
        let band = vec![[a, -h], [b, -h], [b, h], [a, h]];
        (Marks::Plane(Shape2::Polygons(vec![band])), is_whole)
    }

    fn polygon(&self) -> (Marks<'static>, bool) {
        let half_plane = |side: &Side| ([side.seen[0], side.seen[1]], side.distance);
        let half_planes: Vec<HalfPlane> = self.sides.near.iter().map(half_plane).collect();
        let Polygon { corners, is_whole } = polygon(&half_planes, FIRST_REACH);
        let corner = |y: &[f64; 2]| {
            let x = self.place(y);
            [x[0], x[1]]
        };
        let corners = corners.iter().map(corner).collect();
        (Marks::Plane(Shape2::Polygons(vec![corners])), is_whole)
    }

    /// The facet on one half-space, as a closed ring, and whether it has an end.
    fn facet(&self, which: usize) -> (Vec<[f64; 3]>, bool) {
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
        let Polygon { corners, is_whole } = polygon(&half_planes, FACET_REACH);
        let corner = |[a, b]: [f64; 2]| {
            at(&self.place(&[0, 1, 2].map(|k| own.distance * normal[k] + a * u[k] + b * v[k])))
        };
        let mut ring: Vec<[f64; 3]> = corners.into_iter().map(corner).collect();
        ring.extend(ring.first().copied());
        (ring, is_whole)
    }
}

/// Another half-space in the plane of one, with the projection of the origin as its origin.
fn seen_in(own: &Side, other: &Side, axes: [[f64; 3]; 2]) -> HalfPlane {
    let offset = other.distance - own.distance * dot(&own.seen, &other.seen);
    (axes.map(|axis| dot(&axis, &other.seen)), offset)
}
