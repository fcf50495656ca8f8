//! Cells of shapes and centers, and the bounds of the sizes of the ellipses in them.
//!
//! *Bound by edges.* An ellipse of shape σ = (s, t) and center c that no edge enters has at most the size Σ λᵢ·dist(c, eᵢ) for any
//! weights λ ≥ 0 with Σ λᵢ = 1. For one shape that is a convex function of c, largest at a corner cₖ of the cell. There the distance
//! is at most |w| for the vector w to any point of the edge, and |w| ≤ (|w|²/z + z)/2 for any z > 0. In terms of s/t and 1/t the
//! form |w|² is convex, a cell is a trapezoid, and a convex function is largest at a corner σⱼ. So no size is above
//! maxₖⱼ Σ λᵢ(|wᵢₖ|²ⱼ/zᵢₖ + zᵢₖ)/2. With z = |w| in the middle of the cell and the weights of a local optimum this is off by the
//! square of the size of the cell.
//! *Bound by widths.* In the direction n the ellipse reaches r·√((n₁ − s·n₂)²/t + t·n₂²) from its center.

use taut_points::{exponent_of, two_to};

use super::shape::Shape;
use crate::polygon::Segment;

/// What rounding of coordinates in units can change, as a checker may bound it: 2⁻⁴⁵.
const COORDINATE_ERROR: f64 = two_to(-45);

/// Relative rounding errors of a bound, as a checker may bound them: 2⁻⁴³.
const BOUND_ERROR: f64 = two_to(-43);

/// A direction, and the square of half the width of the polygon in it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Width {
    pub(super) direction: [f64; 2],
    pub(super) square: f64,
}

/// Shapes and centers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cell {
    /// The range of s, less the skew of the frame.
    pub(super) s: [f64; 2],
    pub(super) t: [f64; 2],
    /// Once there is a frame, its skew m and the ranges of x and y + m·x of the center.
    pub(super) frame: Option<Frame>,
}

/// Centers in coordinates (x, y + m·x).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Frame {
    pub(super) skew: f64,
    pub(super) low: [f64; 2],
    pub(super) high: [f64; 2],
}

/// What is split.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Axis {
    S,
    T,
    X,
    Y,
}

impl Frame {
    /// A point of the frame in units.
    pub(super) fn units(&self, at: [f64; 2]) -> [f64; 2] {
        [at[0], at[1] - self.skew * at[0]]
    }

    /// A point in units in coordinates of the frame.
    pub(super) fn skewed(&self, p: [f64; 2]) -> [f64; 2] {
        [p[0], p[1] + self.skew * p[0]]
    }

    pub(super) fn corners(&self) -> [[f64; 2]; 4] {
        let (low, high) = (self.low, self.high);
        [low, [high[0], low[1]], [low[0], high[1]], high]
    }

    pub(super) fn middle(&self) -> [f64; 2] {
        [0, 1].map(|k| 0.5 * self.low[k] + 0.5 * self.high[k])
    }
}

impl Cell {
    /// The middle of the shapes.
    pub(super) fn shape(&self) -> Shape {
        let skew = self.frame.map_or(0.0, |frame| frame.skew);
        Shape::new(skew + 0.5 * (self.s[0] + self.s[1]), (self.t[0] * self.t[1]).sqrt())
    }

    /// Half the extents of s/t and of ln t.
    pub(super) fn half_shape(&self) -> [f64; 2] {
        let t = (self.t[0] * self.t[1]).sqrt();
        [0.5 * (self.s[1] - self.s[0]) / t, 0.5 * (self.t[1] / self.t[0]).ln()]
    }

    /// The bound of the size by the widths of the polygon.
    pub(super) fn width_bound(&self, widths: &[Width]) -> f64 {
        let skew = self.frame.map_or(0.0, |frame| frame.skew);
        let bound = |width: &Width| {
            let [n1, n2] = width.direction;
            let [one, other] = self.s.map(|s| n1 - (skew + s) * n2);
            let least = if one * other > 0.0 { one.abs().min(other.abs()) } else { 0.0 };
            // The form least²/t + t·n₂² is least where both terms are equal.
            let t = (least / n2.abs()).min(self.t[1]).max(self.t[0]);
            width.square / (least * least / t + t * n2 * n2)
        };
        widths.iter().map(bound).fold(f64::INFINITY, f64::min).sqrt() * (1.0 + BOUND_ERROR)
    }

    /// The bound by edges with weights that sum to 1; `least` keeps z away from 0.
    pub(super) fn edge_bound(&self, parts: &[(Segment, f64)], least: f64) -> f64 {
        let Some(frame) = self.frame else { return f64::INFINITY };
        let middle = self.shape();
        let corner = |i: usize, j: usize| Shape::new(frame.skew + self.s[i], self.t[j]);
        let shapes = [corner(0, 0), corner(0, 1), corner(1, 0), corner(1, 1)];
        let mut most = 0.0f64;
        for center in frame.corners() {
            let center = frame.units(center);
            let mut sums = [0.0; 4];
            for &(edge, weight) in parts {
                let nearest = middle.nearest(center, edge);
                let z = nearest.length.max(least);
                for (sum, shape) in sums.iter_mut().zip(&shapes) {
                    *sum += weight * 0.5 * (shape.square(nearest.vector) / z + z);
                }
            }
            most = sums.into_iter().fold(most, f64::max);
        }
        most * (1.0 + BOUND_ERROR) + self.rounding(frame.skew)
    }

    /// What the rounding of coordinates can add to a distance.
    fn rounding(&self, skew: f64) -> f64 {
        let s = self.s[0].abs().max(self.s[1].abs());
        let [low, high] = self.t.map(f64::sqrt);
        COORDINATE_ERROR * (high + (1.0 + skew.abs() + s) / low)
    }

    /// The halves along an axis; `None` where rounding leaves no middle.
    pub(super) fn halves(&self, axis: Axis) -> Option<[Cell; 2]> {
        let (mut below, mut above) = (*self, *self);
        let middle = |[low, high]: [f64; 2]| {
            let middle = 0.5 * low + 0.5 * high;
            (low < middle && middle < high).then_some(middle)
        };
        match (axis, &mut below.frame, &mut above.frame) {
            (Axis::S, ..) => {
                let at = middle(self.s)?;
                (below.s[1], above.s[0]) = (at, at);
            }
            (Axis::T, ..) => {
                let at = middle_of_t(self.t)?;
                (below.t[1], above.t[0]) = (at, at);
            }
            (Axis::X | Axis::Y, Some(lower), Some(upper)) => {
                let k = usize::from(axis == Axis::Y);
                let at = middle([lower.low[k], lower.high[k]])?;
                (lower.high[k], upper.low[k]) = (at, at);
            }
            _ => return None,
        }
        Some([below, above])
    }
}

/// The middle of a range of t: a power of two where the ends are farther apart than a factor of two.
fn middle_of_t([low, high]: [f64; 2]) -> Option<f64> {
    let at = match high > 2.0 * low {
        // Both ends are powers of two.
        true => two_to((exponent_of(low) + exponent_of(high)).div_euclid(2)),
        false => 0.5 * low + 0.5 * high,
    };
    (low < at && at < high).then_some(at)
}
