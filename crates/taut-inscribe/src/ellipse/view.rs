//! A cell of shapes and centers as its middle shape sees it: a disk to find room for, and how distances change across the cell.

use super::ascent::gradient;
use super::cell::{Cell, Frame};
use super::shape::{Nearest, Shape};
use super::weights::Column;

/// A cell as its middle shape sees it.
pub(super) struct View {
    pub(super) shape: Shape,
    /// The middle of the centers, in units.
    pub(super) middle: [f64; 2],
    /// Half the extents of s/t and of ln t.
    half_shape: [f64; 2],
    /// Half the extents of the centers.
    half: [f64; 2],
    /// The images of the half extents: the second has no first coordinate.
    x: [f64; 2],
    y: f64,
    /// How much shapes of the cell change distances, as a factor.
    pub(super) factor: f64,
}

impl View {
    pub(super) fn of(cell: &Cell, frame: &Frame) -> Self {
        let shape = cell.shape();
        let half_shape = cell.half_shape();
        let half = [0, 1].map(|k| 0.5 * (frame.high[k] - frame.low[k]));
        let root = shape.t.sqrt();
        View {
            shape,
            middle: frame.units(frame.middle()),
            half_shape,
            half,
            x: [root * half[0], (shape.s - frame.skew) * half[0] / root],
            y: half[1] / root,
            factor: (0.5 * (half_shape[0] + half_shape[1])).exp(),
        }
    }

    /// How far a center is from the middle, at most.
    pub(super) fn reach(&self) -> f64 {
        self.x[0].hypot(self.x[1]) + self.y
    }

    /// How much distances of about `size` change along each axis, relatively.
    pub(super) fn changes(&self, size: f64) -> [f64; 4] {
        let [s, t] = self.half_shape.map(|half| 0.5 * half);
        [s, t, self.x[0].hypot(self.x[1]) / size, self.y / size]
    }

    /// The column of an edge in the linear program of the cell.
    pub(super) fn column(&self, nearest: &Nearest) -> Column {
        let [s, t, first, second] = gradient(nearest);
        let [half_s, half_t] = self.half_shape;
        let x = first * self.x[0] + second * self.x[1];
        Column { distance: nearest.length, gradient: [half_s * s, half_t * t, x, second * self.y] }
    }

    /// The shape and center of a point of the cell.
    pub(super) fn stepped(&self, frame: &Frame, step: [f64; 4]) -> (Shape, [f64; 2]) {
        let Shape { s, t, .. } = self.shape;
        let shape = Shape::new(
            s + step[0] * self.half_shape[0] * t,
            t * (step[1] * self.half_shape[1]).exp(),
        );
        let at = frame.middle();
        let center = [at[0] + step[2] * self.half[0], at[1] + step[3] * self.half[1]];
        (shape, frame.units(center))
    }
}
