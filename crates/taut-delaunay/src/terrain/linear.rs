//! The value at a place in a triangle, of the function that is linear there.
//!
//! *Idea.* In numbers of 100 bits, and rounded once: where the exact value is a double, as on a plane through doubles mostly, it
//! comes out to the last bit.
//! *Guarantee.* At a corner the height of the corner, on an edge a function of that edge alone. So a surface has one value at
//! each place, whichever triangle is asked. No value is outside the heights of the corners.

use taut_points::{OrderBy, exponent_of, two_to};
use taut_predicates::{Sign, plane};

use super::wide::Wide;

/// A place with a height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Corner {
    pub(super) at: [f64; 2],
    pub(super) height: f64,
}

/// Heights beyond this are scaled down for the computation.
const HEIGHT_MAX: f64 = two_to(900);
/// What they are scaled by.
const HEIGHT_SCALE: f64 = two_to(-200);

/// What sums of a few products in numbers of 100 bits may lose of the largest height, with room: 2⁻⁸⁵.
const LOST: f64 = two_to(-85);

/// Where a place lies in a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Within {
    /// In the interior.
    Interior,
    /// On the edge opposite this vertex, and at no corner.
    Edge(usize),
    /// At this corner.
    Corner(usize),
}

/// Where `q` lies in a triangle that turns counter-clockwise; `None` outside.
pub(super) fn within(at: &[[f64; 2]; 3], q: [f64; 2]) -> Option<Within> {
    let mut zeros = [false; 3];
    for (i, is_zero) in zeros.iter_mut().enumerate() {
        match plane::orient(at[(i + 1) % 3], at[(i + 2) % 3], q) {
            Sign::Negative => return None,
            sign => *is_zero = sign == Sign::Zero,
        }
    }
    Some(match zeros {
        [false, false, false] => Within::Interior,
        [true, false, false] => Within::Edge(0),
        [false, true, false] => Within::Edge(1),
        [false, false, true] => Within::Edge(2),
        [false, true, true] => Within::Corner(0),
        [true, false, true] => Within::Corner(1),
        _ => Within::Corner(2),
    })
}

/// The plane over three places that are not on a line.
pub(super) struct Plane {
    corners: [Corner; 3],
    /// The power of two that heights are multiplied with.
    scale: f64,
    /// The largest magnitude of a height.
    largest: f64,
    /// The distances are multiplied with this power of two.
    zoom: f64,
}

impl Plane {
    pub(super) fn through(mut corners: [Corner; 3]) -> Self {
        corners.order_by(&|a, b| plane::lexicographic(a.at, b.at));
        let largest = corners.iter().fold(0.0f64, |most, c| most.max(c.height.abs()));
        let scale = if largest > HEIGHT_MAX { HEIGHT_SCALE } else { 1.0 };
        let [a, b, c] = corners.map(|corner| corner.at);
        let distances = [b[0] - a[0], b[1] - a[1], c[0] - a[0], c[1] - a[1]];
        let side = distances.iter().fold(0.0f64, |most, x| most.max(x.abs()));
        Self { corners, scale, largest, zoom: power_below(side) }
    }

    fn wide_at(&self, q: [f64; 2]) -> Wide {
        let [a, b, c] = self.corners;
        let zoomed = |to: [f64; 2]| {
            std::array::from_fn(|k| Wide::difference(to[k] * self.zoom, a.at[k] * self.zoom))
        };
        let (u, v, w): ([Wide; 2], [Wide; 2], [Wide; 2]) = (zoomed(b.at), zoomed(c.at), zoomed(q));
        let cross = |p: [Wide; 2], q: [Wide; 2]| p[0] * q[1] - p[1] * q[0];
        let rise = |to: Corner| Wide::difference(to.height * self.scale, a.height * self.scale);
        let (area, at_b, at_c) = (cross(u, v), cross(w, v), cross(u, w));
        Wide::from(a.height * self.scale) + (at_b * rise(b) + at_c * rise(c)) / area
    }

    /// The value at a place of the triangle.
    pub(super) fn at(&self, q: [f64; 2]) -> f64 {
        let value = rounded(self.wide_at(q), self.largest, self.scale);
        let heights = self.corners.map(|corner| corner.height);
        let (low, high) =
            (heights.iter().copied().reduce(f64::min), heights.iter().copied().reduce(f64::max));
        value.max(low.unwrap_or(value)).min(high.unwrap_or(value))
    }

    /// By how much a corner is above the plane.
    pub(super) fn excess(&self, corner: Corner) -> f64 {
        let above = Wide::from(corner.height * self.scale) - self.wide_at(corner.at);
        rounded(above, self.largest.max(corner.height.abs()), self.scale)
    }
}

/// The value on the edge between two places, at a place on it.
pub(super) fn on_edge(a: Corner, b: Corner, q: [f64; 2]) -> f64 {
    let (a, b) = if plane::lexicographic(a.at, b.at).is_le() { (a, b) } else { (b, a) };
    let side = |k: usize| (b.at[k] - a.at[k]).abs();
    let k = usize::from(side(1) > side(0));
    let zoom = power_below(side(k));
    let along = |to: [f64; 2]| Wide::difference(to[k] * zoom, a.at[k] * zoom);
    let largest = a.height.abs().max(b.height.abs());
    let scale = if largest > HEIGHT_MAX { HEIGHT_SCALE } else { 1.0 };
    let rise = Wide::difference(b.height * scale, a.height * scale);
    let value = Wide::from(a.height * scale) + along(q) * rise / along(b.at);
    rounded(value, largest, scale).max(a.height.min(b.height)).min(a.height.max(b.height))
}

/// A scaled sum of heights as a double; 0 where it is as small as what 100 bits lose.
fn rounded(value: Wide, largest: f64, scale: f64) -> f64 {
    let value = value.rounded() / scale;
    if value.abs() <= LOST * largest { 0.0 } else { value }
}

/// A power of two that brings a length to about 1.
fn power_below(length: f64) -> f64 {
    // Neither the power nor what is multiplied with it leaves the range of doubles by far.
    two_to(-exponent_of(length).clamp(-900, 900))
}
