//! Measures how large the circles of triangles are where their vertices were given.
//!
//! *Problem.* The triangles of an alpha shape were found among moved points. Where these were given their circles can be larger than the
//! radius of the shape. Name the least `f64`, from this radius on, that none exceeds.
//! *Guarantee.* Exact signs decide. O(m) for m triangles and each of the few numbers that are tried.

use taut_certify::SurfaceMode as Promise;
use taut_points::parallel::ParallelSlice;
use taut_predicates::space::equatorial_radius;

use super::alpha::least;
use super::scaled::Scale;
use super::spheres::Point;
use super::vector::{circumcenter, dot, minus};

/// Returns what an alpha shape of a radius promises of its triangles in other places: a radius, unless a triangle is flat there or its circle is
/// larger than all numbers.
pub(super) fn promise(places: &[Point], triangles: &[[u32; 3]], radius: f64) -> Promise {
    let corners = |triangle: &[u32; 3]| triangle.map(|row| places[row as usize]);
    let fits = |rho: f64| {
        triangles.par_iter().all(|triangle| {
            let [a, b, c] = corners(triangle);
            !equatorial_radius(a, b, c, rho).is_negative()
        })
    };
    if fits(radius) {
        return Promise::Alpha { radius };
    }
    let scale = Scale::of(places);
    let size = |triangle: &[u32; 3]| {
        let [a, b, c] = corners(triangle).map(|place| scale.apply(place));
        let center = circumcenter(minus(b, a), minus(c, a));
        dot(center, center).sqrt()
    };
    // Roundings leave it next to the largest radius, and no number for flat triangles, which are left out here.
    let guess = triangles.iter().map(size).fold(0.0, f64::max);
    let [guess, ..] = scale.inverse().apply([guess, 0.0, 0.0]);
    let least = least(guess.min(f64::MAX).to_bits(), |bits| fits(f64::from_bits(bits)));
    if least.is_finite() { Promise::Alpha { radius: least } } else { Promise::Open }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_least_radius_of_a_right_triangle_of_any_unit() {
        for unit in [1.0, 1e-300, 1e150, 2f64.powi(1021)] {
            let places = [[0.0; 3], [1.5 * unit, 0.0, 0.0], [0.0, 2.0 * unit, 0.0]];
            let promised = |radius: f64| promise(&places, &[[0, 1, 2]], radius);
            let radius = 1.25 * unit;
            // The unit 1e-300 rounds its multiples: the diameter is not the hypotenuse to the last bit.
            let Promise::Alpha { radius: found } = promised(0.5 * unit) else {
                panic!("the triangle has an area")
            };
            assert!((found / radius - 1.0).abs() <= 2.0 * f64::EPSILON, "{found:e}");
            assert_eq!(promised(found), Promise::Alpha { radius: found });
            assert_eq!(promised(found.next_down()), Promise::Alpha { radius: found });
            assert_eq!(promised(2.0 * radius), Promise::Alpha { radius: 2.0 * radius });
        }
    }

    #[test]
    fn a_flat_triangle_has_no_radius() {
        let places = [[0.0; 3], [1.0; 3], [2.0; 3], [0.0, 1.0, 0.0]];
        assert_eq!(promise(&places, &[[0, 1, 3], [0, 1, 2]], 9.0), Promise::Open);
    }
}
