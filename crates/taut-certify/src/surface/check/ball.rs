//! Balls, half-spaces among them, and boxes that are surely outside of one.
//!
//! *Formula.* Let a be a vertex, r = q − a. Whether q is inside a ball with a on its sphere is a matter of the sign of
//!
//! > f(r) = O·|r|² − N·r,
//!
//! negative inside, where O ≥ 0 and N are polynomials in the vertices; O is 0 of a half-space. For a box, each coordinate has its own
//! share O·x² − Nₖx, a parabola, whose least value is at its apex or at a side.
//! *Bound.* O and N are formed in double-double, where each is off by less than 2⁻⁹³ of its largest monomial there can be (no more than
//! 24 of them, 14 operations of 8u² on the way of each), and then rounded. f is off by what that makes of the farthest point of the
//! box, and by a few roundings of each share.
//! *Trap.* A sphere through four points almost on a circle is hardly determined: its center, as rounded, may lie anywhere. The bound of
//! f is not touched by that, as no center is formed.

use super::tree::Area;
use crate::arithmetic::{DoubleDouble, U};
use crate::triangulation::{Gabriel, Geometry, Lifted, Tetrahedra, UNDERFLOW, cross};

/// In double-double, O and N are off by this, over their largest monomials.
const DOUBLED_ROUNDING: f64 = f64::from_bits((1023 - 93) << 52);

/// A share is off by this, over the sum of its two terms: the ends of the box, the apex, two products and a difference,
/// and the sums.
const SHARE_ROUNDING: f64 = 16.0 * U;

pub(super) struct Ball {
    a: [f64; 3],
    normal: [f64; 3],
    weight: f64,
    /// Where the shares are least: N/2O, infinite or NaN for a half-space.
    apex: [f64; 3],
    /// The error of the share of x, over |x|² and over |x|.
    square_error: f64,
    line_errors: [f64; 3],
}

impl Ball {
    /// Of a positively oriented tetrahedron.
    pub(super) fn around(tetrahedron: &[[f64; 3]; 4]) -> Self {
        let (edges, m) = edges(tetrahedron);
        Ball::new(&tetrahedron[0], &Tetrahedra::lifted(&edges), m.powi(4), m.powi(3))
    }

    pub(super) fn smallest(triangle: &[[f64; 3]; 3]) -> Self {
        let (edges, m) = edges(triangle);
        Ball::new(&triangle[0], &Gabriel::lifted(&edges), m.powi(5), m.powi(4))
    }

    /// The half-space that a triangle faces.
    pub(super) fn beyond(triangle: &[[f64; 3]; 3]) -> Self {
        let (edges, m) = edges(triangle);
        let orientation = DoubleDouble { high: 0.0, low: 0.0 };
        let plane = Lifted { normal: cross(&edges[0], &edges[1]), orientation };
        Ball::new(&triangle[0], &plane, m.powi(2), 0.0)
    }

    /// From N and O, of which no monomial is larger than the sizes given.
    fn new(
        a: &[f64; 3],
        lifted: &Lifted<DoubleDouble, 3>,
        normal_size: f64,
        weight_size: f64,
    ) -> Self {
        let (normal, weight) = (lifted.normal.map(|x| x.high), lifted.orientation.high);
        let largest = normal.iter().fold(0.0f64, |largest, x| largest.max(x.abs()));
        // The errors of the components of N, and of O.
        let normal_error = 2.0 * U * largest + DOUBLED_ROUNDING * normal_size + UNDERFLOW;
        let weight_error = 2.0 * U * weight.abs() + DOUBLED_ROUNDING * weight_size + UNDERFLOW;
        Ball {
            a: *a,
            normal,
            weight,
            apex: normal.map(|x| x / (2.0 * weight)),
            square_error: SHARE_ROUNDING * weight.abs() + weight_error,
            line_errors: normal.map(|x| SHARE_ROUNDING * x.abs() + normal_error),
        }
    }

    /// Returns true if all of a box is surely strictly outside. All sizes are below 1.
    #[inline(always)]
    pub(super) fn misses(&self, area: &Area) -> bool {
        let (mut least, mut error) = (0.0, UNDERFLOW);
        for k in 0..3 {
            let (low, high) = (area.least[k] - self.a[k], area.most[k] - self.a[k]);
            let reach = low.abs().max(high.abs());
            let share = |x: f64| (self.weight * x - self.normal[k]) * x;
            // O as rounded may be negative though it is not: then there is no least value but at the ends.
            let apex = self.apex[k].max(low).min(high);
            least += if self.weight < 0.0 { share(low).min(share(high)) } else { share(apex) };
            error += reach * (self.square_error * reach + self.line_errors[k]);
        }
        least > error
    }
}

/// The edges from the first vertex, and the largest difference in a coordinate, no less than it is.
fn edges<const V: usize>(vertices: &[[f64; 3]; V]) -> ([[DoubleDouble; 3]; 3], f64) {
    let (mut edges, mut largest) = ([[DoubleDouble { high: 0.0, low: 0.0 }; 3]; 3], 0.0f64);
    for (edge, vertex) in edges.iter_mut().zip(&vertices[1..]) {
        for k in 0..3 {
            edge[k] = DoubleDouble::difference(vertex[k], vertices[0][k]);
            largest = largest.max(edge[k].high.abs());
        }
    }
    (edges, largest * (1.0 + 4.0 * U))
}

#[cfg(test)]
mod tests {
    use proptest::collection::vec;
    use proptest::prelude::*;

    use super::*;
    use crate::triangulation::Signs;

    const SIGNS: Signs = Signs { is_filtered: true, quantum: 0.0 };

    /// Grid points, moved by an ulp or not, so that four of them are near one circle now and then.
    fn point() -> impl Strategy<Value = [f64; 3]> {
        let coordinate = (-3i32..4, -1i64..2).prop_map(|(cell, ulps)| {
            f64::from_bits(((0.5 + f64::from(cell) * 0.1).to_bits() as i64 + ulps) as u64)
        });
        [coordinate.clone(), coordinate.clone(), coordinate]
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, cases: 4000, ..ProptestConfig::default() })]

        /// No point of a box that is left out is inside, or on the sphere.
        #[test]
        fn what_is_left_out_is_outside(
            tetrahedron in [point(), point(), point(), point()], ends in [point(), point()],
            inner in vec(point(), 4), width in prop_oneof![Just(0.0), Just(1e-15), Just(0.1), Just(1.0)],
        ) {
            let [a, b, c, d] = tetrahedron;
            let near = ends.map(|p| [0, 1, 2].map(|k| a[k] + width * (p[k] - a[k])));
            let side = SIGNS.orientation::<Tetrahedra, 3, 4>(&tetrahedron);
            let tetrahedron = if side.is_gt() { tetrahedron } else { [a, c, b, d] };
            let (area, triangle) = (Area::of(&near), [a, b, c]);
            let into = |p: &[f64; 3]| [0, 1, 2].map(|k| p[k].clamp(area.least[k], area.most[k]));
            let inner = inner.iter().chain(&near).map(into);
            for q in inner {
                let beyond = SIGNS.orientation::<Tetrahedra, 3, 4>(&[a, b, c, q]);
                prop_assert!(!Ball::beyond(&triangle).misses(&area) || beyond.is_lt());
                let smallest = SIGNS.in_sphere::<Gabriel, 3, 3>(&triangle, &q);
                prop_assert!(!Ball::smallest(&triangle).misses(&area) || smallest.is_lt());
                if side.is_ne() {
                    let around = SIGNS.in_sphere::<Tetrahedra, 3, 4>(&tetrahedron, &q);
                    prop_assert!(!Ball::around(&tetrahedron).misses(&area) || around.is_lt());
                }
            }
        }
    }

    #[test]
    fn what_is_far_or_beside_is_left_out() {
        let triangle = [[0.25, 0.25, 0.25], [0.5, 0.25, 0.25], [0.25, 0.5, 0.25]];
        let [a, b, c] = triangle;
        let around = Ball::around(&[a, b, c, [0.25, 0.25, 0.5]]);
        let area = |least: [f64; 3], most: [f64; 3]| Area::of(&[least, most]);
        let far = area([0.6; 3], [0.9; 3]);
        assert!(around.misses(&far) && Ball::smallest(&triangle).misses(&far));
        let beneath = area([-0.9; 3], [0.9, 0.9, 0.249]);
        assert!(Ball::beyond(&triangle).misses(&beneath) && !around.misses(&beneath));
        let corner = area([0.5; 3], [0.5 + 1e-12; 3]);
        assert!(!around.misses(&corner), "on the sphere");
    }
}
