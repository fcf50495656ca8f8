//! Spheres in plain arithmetic, and boxes that are surely outside: what a search asks of most boxes.
//!
//! *Formula.* With N and O as in [`ball`](super::ball), c = N/2O and ρ = |c|, a point a + r is outside if |r − c| > ρ. A box is outside if
//! its nearest point is.
//! *Bound.* Let O and N, as rounded, be off by at most ω and by ν in each component, and d = |r − c| ≥ ρ, so that |r| ≤ 2d. Then
//! f(r)/O ≥ d² − ρ² − ω|r|²/O − √3ν|r|/O ≥ d²(1 − κ) − ρ² for κ = (4ω + 2√3ν/ρ)/O. That is positive if d > ρ(1 + κ) and κ ≤ 1/2. The
//! center a + c as rounded is off by less than 4U(|a| + ρ), with the largest coordinate for |a|; the distance of a box from it, by less
//! than four roundings of itself.
//! *Why.* Where a sphere is well determined, this is a third of the work of the bound in [`ball`](super::ball), and takes no
//! double-double to begin with. That is left for the few points close to a sphere.

use super::tree::Area;
use crate::arithmetic::U;
use crate::triangulation::{Gabriel, Geometry, Lifted, Tetrahedra, UNDERFLOW};

/// Radii below this are left to others, as squares could underflow.
const RADIUS_MIN: f64 = f64::from_bits((1023 - 400) << 52);

pub(super) struct Sphere {
    center: [f64; 3],
    /// The square of a distance from the center beyond which all is outside; infinite where the sphere is not known well enough.
    far: f64,
}

impl Sphere {
    /// Of a positively oriented tetrahedron. 18 monomials in a component of N, with fewer than 15 roundings on the way of each.
    pub(super) fn around(tetrahedron: &[[f64; 3]; 4]) -> Self {
        let (edges, m) = edges(tetrahedron);
        let normal_error = 18.0 * 16.0 * U * (m * m) * (m * m);
        let weight_error = Tetrahedra::ORIENTATION.rounding * m * m * m;
        Sphere::new(&tetrahedron[0], &Tetrahedra::lifted(&edges), normal_error, weight_error)
    }

    /// The smallest of a triangle. 24 monomials in a component of N, with fewer than 17 roundings on the way of each.
    pub(super) fn smallest(triangle: &[[f64; 3]; 3]) -> Self {
        let (edges, m) = edges(triangle);
        let normal_error = 24.0 * 18.0 * U * (m * m) * (m * m) * m;
        let weight_error = Gabriel::ORIENTATION.rounding * (m * m) * (m * m);
        Sphere::new(&triangle[0], &Gabriel::lifted(&edges), normal_error, weight_error)
    }

    fn new(a: &[f64; 3], lifted: &Lifted<f64, 3>, normal_error: f64, weight_error: f64) -> Self {
        let weight = lifted.orientation;
        let c = lifted.normal.map(|x| x / (2.0 * weight));
        let rho = (c[0] * c[0] + c[1] * c[1] + c[2] * c[2]).sqrt();
        // A few per cent more than the bounds, for their own roundings.
        let (nu, omega) = (normal_error + UNDERFLOW, weight_error + UNDERFLOW);
        let kappa = (4.1 * omega + 3.6 * nu / rho) / weight;
        let largest = a.iter().fold(0.0f64, |largest, x| largest.max(x.abs()));
        let radius = (rho * (1.0 + kappa) + 8.0 * U * (largest + rho)) * (1.0 + 32.0 * U);
        // NaN is in no range.
        let is_known = weight > 0.0 && (0.0..0.5).contains(&kappa) && radius > RADIUS_MIN;
        let far = if is_known { radius * radius * (1.0 + 4.0 * U) } else { f64::INFINITY };
        Sphere { center: [0, 1, 2].map(|k| a[k] + c[k]), far }
    }

    /// Returns true if the sphere is known well enough to leave anything out.
    pub(super) fn is_known(&self) -> bool {
        self.far < f64::INFINITY
    }

    /// Returns true if all of a box is surely strictly outside. All sizes are below 1.
    #[inline(always)]
    pub(super) fn misses(&self, area: &Area) -> bool {
        let mut square = 0.0;
        for k in 0..3 {
            let below = area.least[k] - self.center[k];
            let above = self.center[k] - area.most[k];
            let gap = below.max(above).max(0.0);
            square += gap * gap;
        }
        square > self.far
    }
}

/// The edges from the first vertex, and the largest difference in a coordinate, no less than it is.
fn edges<const V: usize>(vertices: &[[f64; 3]; V]) -> ([[f64; 3]; 3], f64) {
    let (mut edges, mut largest) = ([[0.0; 3]; 3], 0.0f64);
    for (edge, vertex) in edges.iter_mut().zip(&vertices[1..]) {
        for k in 0..3 {
            edge[k] = vertex[k] - vertices[0][k];
            largest = largest.max(edge[k].abs());
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

    /// Grid points, moved by an ulp or not, so that four of them are near one circle now and then; or any.
    fn point() -> impl Strategy<Value = [f64; 3]> {
        let coordinate = (-3i32..4, -1i64..2).prop_map(|(cell, ulps)| {
            f64::from_bits(((0.5 + f64::from(cell) * 0.1).to_bits() as i64 + ulps) as u64)
        });
        let grid = [coordinate.clone(), coordinate.clone(), coordinate];
        let any = -0.9f64..0.9;
        prop_oneof![3 => grid, 1 => [any.clone(), any.clone(), any]]
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, cases: 4000, ..ProptestConfig::default() })]

        /// No point of a box that is left out is inside, or on the sphere, however small all of it is.
        #[test]
        fn what_is_left_out_is_outside(
            tetrahedron in [point(), point(), point(), point()], ends in [point(), point()],
            inner in vec(point(), 4), width in prop_oneof![Just(0.0), Just(1e-15), Just(0.1), Just(1.0)],
            size in prop_oneof![Just(1.0), Just(2f64.powi(-100)), Just(2f64.powi(-150)), Just(2f64.powi(-300))],
        ) {
            let [a, b, c, d] = tetrahedron.map(|p| p.map(|x| x * size));
            let near = ends.map(|p| [0, 1, 2].map(|k| a[k] + width * (p[k] * size - a[k])));
            let side = SIGNS.orientation::<Tetrahedra, 3, 4>(&[a, b, c, d]);
            let tetrahedron = if side.is_gt() { [a, b, c, d] } else { [a, c, b, d] };
            let (area, triangle) = (Area::of(&near), [a, b, c]);
            let into = |p: &[f64; 3]| [0, 1, 2].map(|k| (p[k] * size).clamp(area.least[k], area.most[k]));
            let mut inner: Vec<[f64; 3]> = inner.iter().map(into).collect();
            inner.extend(near);
            for q in inner {
                let smallest = SIGNS.in_sphere::<Gabriel, 3, 3>(&triangle, &q);
                prop_assert!(!Sphere::smallest(&triangle).misses(&area) || smallest.is_lt());
                if side.is_ne() {
                    let around = SIGNS.in_sphere::<Tetrahedra, 3, 4>(&tetrahedron, &q);
                    prop_assert!(!Sphere::around(&tetrahedron).misses(&area) || around.is_lt());
                }
            }
        }
    }

    #[test]
    fn what_is_far_is_left_out_and_what_is_not_known_is_kept() {
        let triangle = [[0.25, 0.25, 0.25], [0.5, 0.25, 0.25], [0.25, 0.5, 0.25]];
        let [a, b, c] = triangle;
        let spheres = [Sphere::smallest(&triangle), Sphere::around(&[a, b, c, [0.25, 0.25, 0.5]])];
        let area = |least: f64, most: f64| Area::of(&[[least; 3], [most; 3]]);
        for sphere in spheres {
            assert!(sphere.is_known() && sphere.misses(&area(0.6, 0.9)));
            // The opposite corner of the cube is on one sphere, and outside of the other by little.
            assert!(!sphere.misses(&area(0.4, 0.9)) && sphere.misses(&area(0.5 + 1e-12, 0.9)));
        }
        let flat = Sphere::smallest(&[a, b, b.map(|x| x + 1e-17)]);
        assert!(!flat.is_known() && !flat.misses(&area(0.6, 0.9)));
        let small = triangle.map(|p| p.map(|x| x * 2f64.powi(-500)));
        assert!(!Sphere::smallest(&small).is_known());
    }
}
