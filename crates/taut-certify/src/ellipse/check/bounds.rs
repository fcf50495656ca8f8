//! Cells of shapes and centers, and upper bounds of the sizes of the ellipses in them.
//!
//! *Norm.* That of the shape σ = (s, t) is |w|² = t·w₁² + (w₂ + s·w₁)²/t. With b = s/t and c = 1/t it is linear in (a, b, c) for
//! a = (1 + b²)/c, which is convex in (b, c). The shapes of a cell fill a trapezoid of the plane (b, c), whose corners are those of
//! the cell: each (b, c) is a mean of corners, and its form is at most the same mean of the forms of the corners.
//! *Edges.* No edge enters the ellipse of shape σ, center p and size r, so r ≤ Σ λᵢ·dist(p, eᵢ). For one shape the sum is convex in
//! p, and largest at a corner pₖ of the cell. There dist(pₖ, eᵢ) ≤ |wᵢₖ| ≤ (|wᵢₖ|²/zᵢₖ + zᵢₖ)/2 for the way wᵢₖ to any point
//! of the edge and any zᵢₖ > 0, and the sum of these is largest at a corner of the shapes. Ways and z are taken as the middle shape has
//! them, which is a choice and needs no bound of errors.
//! *Widths.* In the direction n the ellipse reaches r·√((n₁ − s·n₂)²/t + t·n₂²) from its center.
//! *Rounding.* A way is off by the errors of the coordinates and of some operations on numbers below 16·(1 + |m|); in every norm of the
//! cell that is less than [`Cell::rounding`], and norms obey the triangle inequality.

use crate::arithmetic::U;

/// Bound of the errors of ways in either coordinate, per size of the coordinates: 2⁻⁴⁷.
const WAY_ERROR: f64 = f64::from_bits((1023 - 47) << 52);

/// Bound of the relative errors of what is made of at most 100 numbers of one sign, by at most 400 operations: 2⁻⁴⁴.
const SUM_ERROR: f64 = f64::from_bits((1023 - 44) << 52);

/// Most edges of a leaf, as [`SUM_ERROR`] supposes.
pub(super) const EDGES_MAX: usize = 32;

/// Least z, in the size of the answer: keeps quotients finite.
const LEAST_LENGTH: f64 = 1e-3;

/// An edge and its weight.
pub(super) type Part = ([[f64; 2]; 2], f64);

/// A direction, and the square of half the width of the polygon in it, rounded up.
#[derive(Clone, Copy)]
pub(super) struct Width {
    pub(super) direction: [f64; 2],
    pub(super) square: f64,
}

/// Centers in coordinates (x, y + m·x).
#[derive(Clone, Copy)]
pub(super) struct Frame {
    /// m.
    pub(super) skew: f64,
    pub(super) low: [f64; 2],
    pub(super) high: [f64; 2],
}

/// Shapes, and once there is a frame centers.
#[derive(Clone, Copy)]
pub(super) struct Cell {
    /// The range of s, less the skew of the frame.
    pub(super) s: [f64; 2],
    pub(super) t: [f64; 2],
    pub(super) frame: Option<Frame>,
}

impl Frame {
    /// A vector in coordinates of the frame.
    pub(super) fn skewed(&self, p: [f64; 2]) -> [f64; 2] {
        [p[0], p[1] + self.skew * p[0]]
    }

    /// The size of coordinates in the frame, but for a factor: 1 + |m|.
    pub(super) fn reach(&self) -> f64 {
        1.0 + self.skew.abs()
    }

    pub(super) fn corners(&self) -> [[f64; 2]; 4] {
        let (low, high) = (self.low, self.high);
        [low, [high[0], low[1]], [low[0], high[1]], high]
    }
}

impl Cell {
    /// Returns the largest square of a size that a width allows.
    pub(super) fn width_bound(&self, width: &Width) -> f64 {
        let skew = self.frame.map_or(0.0, |frame| frame.skew);
        let [n1, n2] = width.direction;
        let term = |s: f64| n1 - (skew + s) * n2;
        // A lower bound of the size of the term at an end.
        let size =
            |s: f64| term(s).abs() - 8.0 * U * (n1.abs() + (skew.abs() + s.abs()) * n2.abs());
        let [one, other] = self.s.map(term);
        let least = match one * other > 0.0 {
            true => size(self.s[0]).min(size(self.s[1])).max(0.0),
            false => 0.0,
        };
        // The least of least²/t + t·n₂² over the range of t; a t that is off changes it by the square of that.
        let t = (least / n2.abs()).min(self.t[1]).max(self.t[0]);
        let form = least * least / t + t * n2 * n2;
        let bound = width.square / form * (1.0 + SUM_ERROR);
        if bound >= 0.0 { bound } else { f64::INFINITY }
    }

    /// Returns the bound of the size by edges, each with its weight, which sum to `sum`; `size` is that of the answer.
    pub(super) fn edge_bound(&self, frame: &Frame, parts: &[Part], sum: f64, size: f64) -> f64 {
        let middle = [0.5 * (self.s[0] + self.s[1]), (self.t[0] * self.t[1]).sqrt()];
        let (s, t) = (self.s, self.t);
        let shapes = [[s[0], t[0]], [s[0], t[1]], [s[1], t[0]], [s[1], t[1]]];
        let mut most = 0.0f64;
        for center in frame.corners() {
            let mut sums = [0.0; 4];
            for &(edge, weight) in parts {
                let [a, b] = edge.map(|p| frame.skewed(p));
                let way = way(middle, center, a, b);
                let z = square(middle, way).sqrt().max(LEAST_LENGTH * size);
                for (sum, shape) in sums.iter_mut().zip(shapes) {
                    *sum += weight * (0.5 * (square(shape, way) / z + z));
                }
            }
            for value in sums {
                most = if value >= 0.0 { most.max(value) } else { f64::INFINITY };
            }
        }
        most / sum * (1.0 + SUM_ERROR) + self.rounding(frame)
    }

    /// Returns a bound of the norms of errors of ways.
    fn rounding(&self, frame: &Frame) -> f64 {
        let s = self.s[0].abs().max(self.s[1].abs());
        let [low, high] = self.t.map(f64::sqrt);
        2.0 * WAY_ERROR * (high + (frame.reach() + s) / low)
    }
}

/// Returns |w|² in the norm of the shape (s, t), not below the exact number but for the relative errors of a sum.
fn square([s, t]: [f64; 2], w: [f64; 2]) -> f64 {
    let along = (w[1] + s * w[0]).abs() + 4.0 * U * (w[1].abs() + (s * w[0]).abs());
    t * w[0] * w[0] + along * along / t
}

/// Returns the way from p to the point of the edge ab that is nearest in the norm of a shape, or to another one by rounding.
fn way([s, t]: [f64; 2], p: [f64; 2], a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    let (d, e) = ([a[0] - p[0], a[1] - p[1]], [b[0] - a[0], b[1] - a[1]]);
    let along = |w: [f64; 2]| w[1] + s * w[0];
    let product = |v: [f64; 2], w: [f64; 2]| t * v[0] * w[0] + along(v) * along(w) / t;
    let share = -product(d, e) / product(e, e);
    let share = if share >= 0.0 { share.min(1.0) } else { 0.0 };
    [d[0] + share * e[0], d[1] + share * e[1]]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers in [0, 1), a function of the seed.
    struct Random(u64);

    impl Random {
        fn unit(&mut self) -> f64 {
            self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (self.0 >> 11) as f64 / (1u64 << 53) as f64
        }

        fn between(&mut self, [low, high]: [f64; 2]) -> f64 {
            low + self.unit() * (high - low)
        }
    }

    #[test]
    fn no_sampled_ellipse_of_a_cell_is_larger_than_its_bounds() {
        let mut random = Random(1);
        let (mut tightest, mut samples) = (f64::INFINITY, 0);
        for round in 0..2000 {
            let extent = 0.5f64.powi(round % 12);
            let mut range = |low: f64, high: f64| {
                let from = random.between([low, high]);
                [from, from + extent * random.unit() * (high - low)]
            };
            let (s, t) = (range(-1.0, 1.0), range(0.25, 2.0));
            let (x, y) = (range(0.2, 1.2), range(0.2, 1.2));
            let frame =
                Frame { skew: random.between([-3.0, 3.0]), low: [x[0], y[0]], high: [x[1], y[1]] };
            let cell = Cell { s, t, frame: Some(frame) };
            let edges: Vec<[[f64; 2]; 2]> = (0..4)
                .map(|_| [0, 1].map(|_| [0, 1].map(|_| random.between([0.0, 2.0]))))
                .collect();
            let parts: Vec<Part> = edges.iter().map(|&edge| (edge, random.unit())).collect();
            let sum = parts.iter().map(|part| part.1).sum();
            let bound = cell.edge_bound(&frame, &parts, sum, 1.0);
            for _ in 0..100 {
                let shape = [random.between(s), random.between(t)];
                let center = [random.between(x), random.between(y)];
                // The largest ellipse that no edge enters.
                let distance = |edge: [[f64; 2]; 2]| {
                    let [a, b] = edge.map(|p| frame.skewed(p));
                    square(shape, way(shape, center, a, b)).sqrt()
                };
                let size = edges.iter().map(|&edge| distance(edge)).fold(f64::INFINITY, f64::min);
                assert!(size <= bound, "{cell:?}: {size} above {bound}", cell = (s, t, x, y));
                let mean = parts.iter().map(|part| part.1 * distance(part.0)).sum::<f64>() / sum;
                assert!(mean <= bound, "{mean} above {bound}");
                tightest = tightest.min(bound / mean - 1.0);
                samples += 1;
            }
        }
        assert!(samples == 200_000 && tightest < 1e-2, "{tightest}");
    }

    #[test]
    fn no_ellipse_is_wider_than_the_bound_by_widths() {
        let mut random = Random(2);
        for _ in 0..20_000 {
            let s = random.between([-2.0, 2.0]);
            let t = random.between([0.1, 3.0]);
            let cell = Cell { s: [s, s + random.unit()], t: [t, t + random.unit()], frame: None };
            let direction = [random.between([-1.0, 1.0]), random.between([-1.0, 1.0])];
            let bound = cell.width_bound(&Width { direction, square: 0.25 });
            let (s, t) = (random.between(cell.s), random.between(cell.t));
            // The ellipse as the image of a disk, and its width by sampling.
            let reach = (0..64).map(|i| {
                let (sine, cosine) = (f64::from(i) * std::f64::consts::TAU / 64.0).sin_cos();
                let p = [cosine / t.sqrt(), t.sqrt() * sine - s * cosine / t.sqrt()];
                p[0] * direction[0] + p[1] * direction[1]
            });
            let reach = reach.fold(0.0, f64::max);
            // A size above the root of the bound makes it wider than 1.
            assert!(0.25 / (reach * reach) * 0.99 <= bound, "{cell:?}", cell = (s, t));
        }
    }
}
