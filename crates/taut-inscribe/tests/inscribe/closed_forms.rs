//! Polygons whose largest circle is known.

use super::common::{comb, proved, regular};

/// The gap asked for and the rounding of the radius.
fn assert_radius(ring: &[[f64; 2]], expected: f64) {
    let (found, verdict) = proved(ring);
    let radius = found.answer.radius;
    assert!(radius <= expected * (1.0 + 1e-14), "{radius} > {expected}: {ring:?}");
    assert!(verdict.upper >= expected * (1.0 - 1e-14), "{} < {expected}", verdict.upper);
}

#[test]
fn a_square_has_half_its_side() {
    let square = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
    assert_radius(&square, 1.0);
    let (found, _) = proved(&square);
    assert_eq!(found.certificate.touching, [0, 1, 2, 3]);
    assert!((found.answer.center[0] - 1.0).abs() < 1e-9, "{:?}", found.answer);
}

#[test]
fn a_triangle_has_its_incircle() {
    assert_radius(&[[0.0, 0.0], [4.0, 0.0], [4.0, 3.0]], 1.0);
    // Area over half the perimeter.
    let ring = [[0.1, 0.2], [5.3, 0.7], [2.2, 4.9]];
    let side = |i: usize, j: usize| {
        let (a, b): ([f64; 2], [f64; 2]) = (ring[i], ring[j]);
        (a[0] - b[0]).hypot(a[1] - b[1])
    };
    let (e, f) = ([5.2, 0.5], [2.1, 4.7]);
    let area: f64 = 0.5 * (e[0] * f[1] - e[1] * f[0]);
    assert_radius(&ring, 2.0 * area / (side(0, 1) + side(1, 2) + side(2, 0)));
}

#[test]
fn a_regular_polygon_has_its_apothem() {
    for size in [3, 4, 5, 6, 7, 8, 12, 17, 64, 1000, 20_000] {
        let apothem = (std::f64::consts::PI / size as f64).cos();
        let (found, verdict) = proved(&regular(size));
        // Vertices are rounded, and so is the optimum.
        assert!((found.answer.radius - apothem).abs() <= 1e-9 * apothem + 1e-15, "{size}");
        assert!(verdict.upper >= apothem - 1e-15);
        assert!(found.certificate.tree.len() < 4000, "{size}: {}", found.certificate.tree.len());
    }
}

#[test]
fn a_corridor_has_a_continuum_of_best_centers() {
    for length in [1.5, 10.0, 1e3, 1e6] {
        let corridor = [[0.0, 0.0], [length, 0.0], [length, 1.0], [0.0, 1.0]];
        assert_radius(&corridor, 0.5);
        let (found, _) = proved(&corridor);
        assert!(found.certificate.tree.len() < 20, "{}", found.certificate.tree);
    }
    // The same along a diagonal, with sides that are subdivided.
    let along = |t: f64, side: f64| [3.0 * t - 4.0 * side, 4.0 * t + 3.0 * side];
    let mut ring: Vec<[f64; 2]> = (0..=40).map(|i| along(f64::from(i), 0.0)).collect();
    ring.extend((0..=40).rev().map(|i| along(f64::from(i), 1.0)));
    assert_radius(&ring, 2.5);
}

#[test]
fn an_l_touches_its_reflex_corner() {
    // Center (c, c) with c = |(2, 2) − (c, c)|: c = 2√2/(1 + √2).
    let ring = [[0.0, 0.0], [3.0, 0.0], [3.0, 2.0], [2.0, 2.0], [2.0, 3.0], [0.0, 3.0]];
    let root = 2f64.sqrt();
    assert_radius(&ring, 2.0 * root / (1.0 + root));
    let (found, _) = proved(&ring);
    assert_eq!(found.certificate.touching, [0, 2, 3, 5]);
}

#[test]
fn a_star_has_the_circle_through_its_reflex_corners() {
    let corner = |i: usize| {
        let angle = std::f64::consts::PI * i as f64 / 5.0;
        let radius = if i.is_multiple_of(2) { 1.0 } else { 0.4 };
        [radius * angle.sin(), radius * angle.cos()]
    };
    assert_radius(&(0..10).map(corner).collect::<Vec<_>>(), 0.4);
}

#[test]
fn a_comb_has_as_many_best_centers_as_teeth() {
    // At the foot of a tooth: tangent to the bar, and through both corners at the height 1 and 1 apart.
    for teeth in [3, 40, 300] {
        let ring = comb(teeth, 0.5);
        // r = y and (1 − y)² + 1/4 = r²: y = 5/8; the outer teeth have a side in place of a corner.
        assert_radius(&ring, 0.625);
    }
}

#[test]
fn a_spike_does_not_hold_up_the_search() {
    // A square with a spike that is a millionth as wide as long, to the left, where a depth-first search begins.
    let ring = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 1e-6], [-1.0, 5e-7]];
    let (found, _) = proved(&ring);
    assert!(found.answer.radius > 0.4999);
    assert!(found.trace.iterations < 2000, "{}", found.trace.iterations);
}
