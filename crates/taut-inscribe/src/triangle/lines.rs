//! The lines from the corners of one box to those of another, and the points that are left of all of them.
//!
//! *Idea.* A point is left of all lines from a point of one box to a point of another if it is left of the sixteen lines between
//! corners, as the cross product is linear in each coordinate. Each of these is a linear function of the point.

use super::tile::Tile;
use crate::groups::Extent;

/// Lines side by side, for vectors of the machine.
const LANES: usize = 4;

#[inline(always)]
fn smallest(lanes: [f64; LANES]) -> f64 {
    lanes.into_iter().fold(f64::INFINITY, |a, b| if b < a { b } else { a })
}

#[inline(always)]
fn largest(lanes: [f64; LANES]) -> f64 {
    lanes.into_iter().fold(f64::NEG_INFINITY, |a, b| if b > a { b } else { a })
}

/// Sixteen linear functions that are positive left of their lines.
pub(super) struct Lines {
    offset: [f64; 16],
    x: [f64; 16],
    y: [f64; 16],
}

impl Lines {
    pub(super) fn of(from: &Tile, to: &Tile) -> Self {
        let mut lines = Lines { offset: [0.0; 16], x: [0.0; 16], y: [0.0; 16] };
        for (i, p) in from.corners().into_iter().enumerate() {
            for (j, q) in to.corners().into_iter().enumerate() {
                lines.offset[4 * i + j] = p[0] * q[1] - p[1] * q[0];
                lines.x[4 * i + j] = p[1] - q[1];
                lines.y[4 * i + j] = q[0] - p[0];
            }
        }
        lines
    }

    /// The least and the largest value at a point.
    #[inline]
    pub(super) fn range(&self, w: [f64; 2]) -> [f64; 2] {
        let (mut least, mut most) = ([f64::INFINITY; LANES], [f64::NEG_INFINITY; LANES]);
        for i in 0..16 / LANES {
            for lane in 0..LANES {
                let at = LANES * i + lane;
                let value = self.offset[at] + self.x[at] * w[0] + self.y[at] * w[1];
                least[lane] = if value < least[lane] { value } else { least[lane] };
                most[lane] = if value > most[lane] { value } else { most[lane] };
            }
        }
        [smallest(least), largest(most)]
    }

    /// Bounds of the values in a box: the least of the largest values, and the largest one.
    #[inline]
    pub(super) fn largest_over(&self, Extent { center, half }: Extent) -> [f64; 2] {
        let (mut least, mut most) = ([f64::INFINITY; LANES], [f64::NEG_INFINITY; LANES]);
        for i in 0..16 / LANES {
            for lane in 0..LANES {
                let at = LANES * i + lane;
                let (x, y) = (self.x[at], self.y[at]);
                let value = self.offset[at] + x * center[0] + y * center[1];
                let value = value + (x.abs() * half[0] + y.abs() * half[1]);
                least[lane] = if value < least[lane] { value } else { least[lane] };
                most[lane] = if value > most[lane] { value } else { most[lane] };
            }
        }
        [smallest(least), largest(most)]
    }

    /// The shares of the way from a to b between which all values are above an error.
    pub(super) fn shares_left(&self, a: [f64; 2], b: [f64; 2], error: f64) -> Option<[f64; 2]> {
        let (mut from, mut to) = (0.0f64, 1.0f64);
        for i in 0..16 {
            let at = |w: [f64; 2]| self.offset[i] + self.x[i] * w[0] + self.y[i] * w[1] - error;
            let (one, other) = (at(a), at(b));
            match (one > 0.0, other > 0.0) {
                (true, true) => {}
                (false, false) => return None,
                (false, true) => from = from.max(one / (one - other)),
                (true, false) => to = to.min(one / (one - other)),
            }
        }
        (from < to).then_some([from, to])
    }
}
