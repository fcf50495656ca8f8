//! The polygon in units of its bounding box, skewed where that makes it much less thin.
//!
//! *Idea.* A needle along a diagonal fills little of its bounding box, and boxes of corners would have to be as small as its width. In
//! coordinates x, y + m·x, with the second one shifted and scaled, it is as good as any other. The extent of y + m·x is a convex
//! function of m.

use taut_points::two_to;

use super::gauge::Triangle;
use crate::pair::cross;
use crate::polygon::Segment;
use crate::units::{Units, factors_of};

/// Largest skew in size, as a checker takes it.
const SKEW_MAX: f64 = 4.0;

/// Steps of the golden section search for the skew, each of which cuts its range to 0.62.
const SKEW_STEPS: usize = 90;

/// Share of the extent above which a skew is not worth its rounding errors.
const SKEW_SHARE: f64 = 0.75;

/// Largest power of two by which skewed coordinates are scaled, as in a checker.
const GROWTH_MAX: f64 = (1u64 << 24) as f64;

/// Bound of the errors of coordinates in units: 2⁻⁵⁰.
const COORDINATE_ERROR: f64 = two_to(-50);

/// Bound of the errors of skewed coordinates before they are scaled: 2⁻⁴⁶.
const SKEW_ERROR: f64 = two_to(-46);

/// Bound of the error of twice an area, here and in a checker, relative to the sum of the sizes of the two products: 2⁻⁹³.
const AREA_ERROR: f64 = two_to(-93);

/// How much the root is larger than the polygon on each side, besides errors of coordinates.
const ROOT_MARGIN: f64 = 1e-9;

/// The polygon in the coordinates of the search.
pub(super) struct Frame {
    units: Units,
    skew: f64,
    /// The lower end of y + m·x, and the power of two by which it is scaled.
    low: f64,
    growth: f64,
    /// The edges, with coordinates from 0 to about 2.
    pub(super) edges: Vec<Segment>,
    /// The largest coordinates; the smallest are 0.
    pub(super) extent: [f64; 2],
    /// A bound of the errors of coordinates, here and in a checker.
    pub(super) error: f64,
}

impl Frame {
    pub(super) fn of(units: Units) -> Self {
        let skew = skew(&units.edges);
        let (mut low, mut growth, mut error) = (0.0, 1.0, COORDINATE_ERROR);
        if skew != 0.0 {
            let (from, to) = range(&units.edges, skew);
            let [one, other] = factors_of(to - from);
            (low, growth) = (from, (one * other).min(GROWTH_MAX));
            error = COORDINATE_ERROR.max(SKEW_ERROR * growth);
        }
        let map = |p: [f64; 2]| [p[0], (p[1] + skew * p[0] - low) * growth];
        let edges: Vec<Segment> = units.edges.iter().map(|edge| edge.map(map)).collect();
        let extent = [0, 1].map(|k| edges.iter().fold(0.0f64, |most, edge| most.max(edge[0][k])));
        Frame { units, skew, low, growth, edges, extent, error }
    }

    pub(super) fn skew(&self) -> f64 {
        self.skew
    }

    /// The lower and the upper corner of a box that holds the polygon.
    pub(super) fn root(&self) -> [[f64; 2]; 2] {
        let margin = ROOT_MARGIN + 4.0 * self.error;
        [[-margin; 2], self.extent.map(|x| x + margin)]
    }

    /// The point of the input that is nearest to one of the frame, but for rounding.
    pub(super) fn given_point(&self, p: [f64; 2]) -> [f64; 2] {
        self.units.given_point([p[0], p[1] / self.growth + self.low - self.skew * p[0]])
    }

    /// A bound of the distance along each axis between a point of the frame and that of the input for it.
    pub(super) fn rounding(&self) -> f64 {
        let [x, y] = [0, 1].map(|axis| self.units.rounding(axis));
        self.error + x.max((y + self.skew.abs() * x) * self.growth)
    }

    /// A point of the input in the frame.
    pub(super) fn point(&self, given: [f64; 2]) -> [f64; 2] {
        let p = self.units.point(given);
        [p[0], (p[1] + self.skew * p[0] - self.low) * self.growth]
    }

    /// Twice the area of a triangle of the input, in the frame, off by 2⁻⁹⁰ times the product of its extents.
    pub(super) fn doubled_area(&self, &[p, q, r]: &Triangle) -> f64 {
        self.turn(q, r, p) * self.growth
    }

    /// A lower bound of twice the area of a triangle of the input, in the frame, that a checker confirms.
    pub(super) fn doubled_below(&self, corners: &Triangle) -> f64 {
        let [p, q, r] = corners;
        let size = |a: &[f64; 2], b: &[f64; 2]| {
            [0, 1].map(|k| self.units.difference(k, a[k], b[k]).0.abs())
        };
        let (d, e) = (size(q, p), size(r, p));
        let error = AREA_ERROR * (d[0] * e[1] + d[1] * e[0]) * self.growth;
        self.doubled_area(corners) * (1.0 - 4.0 * f64::EPSILON) - error
    }

    /// The cross product of two sides of a triangle of the input, pw × qw, in units and accurate.
    pub(super) fn turn(&self, p: [f64; 2], q: [f64; 2], w: [f64; 2]) -> f64 {
        let difference = |p: [f64; 2]| [0, 1].map(|k| self.units.difference(k, p[k], w[k]));
        cross(difference(p), difference(q))
    }

    /// The area of a triangle of the input.
    pub(super) fn given_area(&self, corners: &Triangle) -> f64 {
        self.units.given_area(0.5 * self.doubled_area(corners) / self.growth)
    }
}

/// The lower and the upper end of y + m·x.
fn range(edges: &[Segment], skew: f64) -> (f64, f64) {
    edges.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), edge| {
        let at = edge[0][1] + skew * edge[0][0];
        (low.min(at), high.max(at))
    })
}

/// The skew of the least extent; 0 where that is not much less than without.
fn skew(edges: &[Segment]) -> f64 {
    let extent = |skew: f64| {
        let (low, high) = range(edges, skew);
        high - low
    };
    let golden = 0.5 * (5f64.sqrt() - 1.0);
    let (mut low, mut high) = (-SKEW_MAX, SKEW_MAX);
    let at = |low: f64, high: f64, share: f64| low + share * (high - low);
    let (mut one, mut other) = (at(low, high, 1.0 - golden), at(low, high, golden));
    let (mut of_one, mut of_other) = (extent(one), extent(other));
    for _ in 0..SKEW_STEPS {
        if of_one < of_other {
            (high, other, of_other) = (other, one, of_one);
            one = at(low, high, 1.0 - golden);
            of_one = extent(one);
        } else {
            (low, one, of_one) = (one, other, of_other);
            other = at(low, high, golden);
            of_other = extent(other);
        }
    }
    if of_one < SKEW_SHARE * extent(0.0) && of_one > 0.0 { one } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::Loops;

    #[test]
    fn a_needle_along_a_diagonal_fills_the_frame() {
        let width = 1e-6;
        let mut loops = Loops::default();
        loops.push(&[[0.0, 0.0], [3.0, 1.0], [3.0, 1.0 + width], [0.0, width]]);
        let frame = Frame::of(Units::of(&loops.segments));
        assert!(frame.extent.iter().all(|x| (1.0..2.0).contains(x)), "{:?}", frame.extent);
        let corners = [[0.0, 0.0], [3.0, 1.0], [3.0, 1.0 + width]];
        let expected = 1.5 * width;
        assert!((frame.given_area(&corners) / expected - 1.0).abs() < 1e-9);
        let images = corners.map(|p| frame.point(p));
        let doubled = super::super::gauge::doubled_area(&images);
        assert!((frame.doubled_area(&corners) / doubled - 1.0).abs() < 1e-6);
        for (p, q) in images.iter().zip(corners) {
            let back = frame.given_point(*p);
            assert!((0..2).all(|k| (back[k] - q[k]).abs() < 1e-12), "{back:?}, {q:?}");
        }
        loops = Loops::default();
        loops.push(&[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
        assert_eq!(Frame::of(Units::of(&loops.segments)).skew(), 0.0);
    }
}
