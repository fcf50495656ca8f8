//! The shape of an ellipse: a point (s, t) of the half-plane t > 0.
//!
//! The ellipse of shape (s, t), center c and size r is {p : |p − c| ≤ r} in the norm |w|² = t·w₁² + (w₂ + s·w₁)²/t, whose form has
//! the determinant 1: its area is πr². The map w ↦ (√t·w₁, (w₂ + s·w₁)/√t) takes it to a disk.

use crate::polygon::Segment;

/// The norm of a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Shape {
    pub(super) s: f64,
    pub(super) t: f64,
    root: f64,
}

impl Shape {
    pub(super) fn new(s: f64, t: f64) -> Self {
        Shape { s, t, root: t.sqrt() }
    }

    /// The vector w in the plane where ellipses of this shape are disks.
    #[inline(always)]
    pub(super) fn image(&self, w: [f64; 2]) -> [f64; 2] {
        [self.root * w[0], (w[1] + self.s * w[0]) / self.root]
    }

    /// The vector whose image is w.
    pub(super) fn inverse(&self, w: [f64; 2]) -> [f64; 2] {
        [w[0] / self.root, self.root * w[1] - self.s * w[0] / self.root]
    }

    /// |w|².
    #[inline(always)]
    pub(super) fn square(&self, w: [f64; 2]) -> f64 {
        let along = w[1] + self.s * w[0];
        self.t * w[0] * w[0] + along * along / self.t
    }

    /// The vector from c to the nearest point of an edge, its image and its length.
    #[inline(always)]
    pub(super) fn nearest(&self, c: [f64; 2], [a, b]: Segment) -> Nearest {
        let (d, e) = ([a[0] - c[0], a[1] - c[1]], [b[0] - a[0], b[1] - a[1]]);
        let (from, along) = (self.image(d), self.image(e));
        let square = along[0] * along[0] + along[1] * along[1];
        let share = -(from[0] * along[0] + from[1] * along[1]) / square;
        // An edge so short that its square is 0 is as good as one of its ends.
        let share = if share >= 0.0 { share.min(1.0) } else { 0.0 };
        let image = [from[0] + share * along[0], from[1] + share * along[1]];
        let vector = [d[0] + share * e[0], d[1] + share * e[1]];
        Nearest { vector, image, length: (image[0] * image[0] + image[1] * image[1]).sqrt() }
    }
}

/// The way from a point to an edge.
#[derive(Clone, Copy, Debug)]
pub(super) struct Nearest {
    pub(super) vector: [f64; 2],
    pub(super) image: [f64; 2],
    pub(super) length: f64,
}
