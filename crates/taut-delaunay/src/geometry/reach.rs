//! Measures how far a simplex reaches: where a site would conflict with it, as a quadratic form that boxes can be judged by.
//!
//! Idea: for fixed vertices, the in-sphere determinant is a function of the query alone, α|q − a|² + β·(q − a) with
//! α < 0: its maximum over a box is a sum over the axes. A ghost's half-space is the same with α = 0.
//! Guarantee: a box that is ruled out holds no conflict; rounding is on the safe side by `slack`. What is not ruled
//! out is asked exactly, point by point.
//! Trap: the center and the radius of a sliver's sphere are worthless in floating point; the form needs neither.

use taut_points::two_to;

use crate::vector::{cross, difference, dot, largest, square};

/// α|q − a|² + β·(q − a), positive where `q` conflicts.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reach<const D: usize> {
    origin: [f64; D],
    alpha: f64,
    beta: [f64; D],
    /// Largest coordinate difference among the vertices.
    size: f64,
    /// A half-space: α is 0 truly, not by rounding.
    linear: bool,
}

/// Bounds the rounding of the form relative to the size of its terms, in space, where it is largest. With u = 2⁻⁵³, m the
/// size and f the largest coordinate of q − a: β·q is 54 products of five factors, each with at most 20 roundings, so
/// off by at most 1080·u·m⁴·f; α|q|² is 18 products with as many, off by 360·u·m³·f².
const FORM_ROUNDING: f64 = 1.0 / (1u64 << 42) as f64;

/// The error that underflow may add to the form, 2⁻⁹⁰⁰. A product that underflows is off by less than 2⁻¹⁰⁷⁴ and is
/// multiplied by at most four coordinates, which `filtered` bounds by 2⁴⁰, and their differences.
const UNDERFLOW_ERROR: f64 = two_to(-900);

impl Reach<2> {
    /// The inside of the circle through a, b, c in counter-clockwise order.
    #[inline(always)]
    pub(crate) fn of_triangle([a, b, c]: [[f64; 2]; 3]) -> Self {
        let (b, c) = (difference(b, a), difference(c, a));
        let (b2, c2) = (square(b), square(c));
        let alpha = -(b[0] * c[1] - b[1] * c[0]);
        let beta = [b2 * c[1] - c2 * b[1], c2 * b[0] - b2 * c[0]];
        Self { origin: a, alpha, beta, size: largest(&[b, c]), linear: false }
    }

    /// The closed half-plane to the left of a → b.
    pub(crate) fn of_edge([a, b]: [[f64; 2]; 2]) -> Self {
        let b = difference(b, a);
        Self { origin: a, alpha: 0.0, beta: [-b[1], b[0]], size: largest(&[b]), linear: true }
    }
}

impl Reach<3> {
    /// The inside of the sphere through a, b, c, d in positive order.
    #[inline(always)]
    pub(crate) fn of_tetrahedron([a, b, c, d]: [[f64; 3]; 4]) -> Self {
        let (b, c, d) = (difference(b, a), difference(c, a), difference(d, a));
        let (b2, c2, d2) = (square(b), square(c), square(d));
        let (cd, db, bc) = (cross(c, d), cross(d, b), cross(b, c));
        let alpha = -dot(b, cd);
        let beta = std::array::from_fn(|i| b2 * cd[i] + c2 * db[i] + d2 * bc[i]);
        Self { origin: a, alpha, beta, size: largest(&[b, c, d]), linear: false }
    }

    /// The closed half-space from which a, b, c are seen in counter-clockwise order.
    pub(crate) fn of_facet([a, b, c]: [[f64; 3]; 3]) -> Self {
        let (b, c) = (difference(b, a), difference(c, a));
        Self { origin: a, alpha: 0.0, beta: cross(b, c), size: largest(&[b, c]), linear: true }
    }
}

impl<const D: usize> Reach<D> {
    /// An upper bound of the form over the box `low..=high`, rounding included; coordinates are `filtered`.
    #[inline(always)]
    pub(crate) fn most(&self, low: [f64; D], high: [f64; D]) -> f64 {
        let (mut most, mut far) = (0.0, 0.0f64);
        for i in 0..D {
            let (l, h) = (low[i] - self.origin[i], high[i] - self.origin[i]);
            let value = |x: f64| (self.alpha * x + self.beta[i]) * x;
            let ends = value(l).max(value(h));
            // The parabola's top counts if it lies between the ends.
            let top = if self.alpha < 0.0 { self.beta[i] / (-2.0 * self.alpha) } else { f64::NAN };
            most += if l < top && top < h { ends.max(self.beta[i] * top * 0.5) } else { ends };
            far = far.max(l.abs()).max(h.abs());
        }
        let unit = if D == 2 { self.size * self.size } else { self.size * self.size * self.size };
        let slack = if self.linear {
            FORM_ROUNDING * far * if D == 2 { self.size } else { self.size * self.size }
        } else {
            FORM_ROUNDING * (unit * far * far + unit * self.size * far)
        };
        most + slack + UNDERFLOW_ERROR
    }

    /// The corners of the box one of which is where a half-space's form is largest: one, or more where rounding leaves
    /// open which way the half-space faces along an axis.
    pub(crate) fn foremost(&self, low: [f64; D], high: [f64; D]) -> impl Iterator<Item = [f64; D]> {
        // A component of the normal is a difference in the plane, two products of two differences in space.
        let doubt = if D == 2 {
            0.0
        } else {
            self.size * self.size * 16.0 * f64::EPSILON + f64::MIN_POSITIVE
        };
        let beta = self.beta;
        (0..1 << D)
            .filter(move |code| {
                (0..D).all(|i| {
                    let up = code >> i & 1 == 1;
                    beta[i].abs() <= doubt || up == (beta[i] > 0.0)
                })
            })
            .map(move |code: usize| {
                std::array::from_fn(|i| if code >> i & 1 == 1 { high[i] } else { low[i] })
            })
    }
}
