//! Closed forms: shapes whose signs everybody knows.

use taut_predicates::{Fused, Separate, Sign, plane, space};

#[test]
fn unit_triangle_and_tetrahedron() {
    let (a, b, c) = ([0.0, 0.0], [1.0, 0.0], [0.0, 1.0]);
    assert_eq!(plane::orient(a, b, c), Sign::Positive);
    assert_eq!(plane::orient(a, c, b), Sign::Negative);
    assert_eq!(plane::in_circle(a, b, c, [0.3, 0.3]), Sign::Positive);
    assert_eq!(plane::in_circle(a, b, c, [1.0, 1.0]), Sign::Zero);
    assert_eq!(plane::in_circle(a, b, c, [1.0, 1.0 + f64::EPSILON]), Sign::Negative);

    let (a, b, c, d) = ([0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]);
    assert_eq!(space::orient(a, b, c, d), Sign::Positive);
    assert_eq!(space::orient(b, a, c, d), Sign::Negative);
    assert_eq!(space::in_sphere(a, b, c, d, [0.5; 3]), Sign::Positive);
    assert_eq!(space::in_sphere(a, b, c, d, [1.0; 3]), Sign::Zero);
    assert_eq!(space::in_sphere(a, b, c, d, [1.0, 1.0, 1.0 + f64::EPSILON]), Sign::Negative);
}

#[test]
fn filters_agree_and_know_ghosts() {
    let (a, b, c, q) = ([0.0, 0.0], [3.0, 0.5], [0.25, 2.0], [1.0, 0.75]);
    assert!(plane::orient_filter::<Separate>(a, b, c) > 0.0);
    assert!(plane::orient_filter::<Fused>(a, b, c) > 0.0);
    assert!(plane::in_circle_filter::<Separate>(a, b, c, q) > 0.0);
    assert!(plane::in_circle_filter::<Fused>(a, b, c, q) > 0.0);
    let ghost = [f64::NAN; 2];
    assert_eq!(plane::orient_filter::<Separate>(a, b, ghost), 0.0);
    assert_eq!(plane::in_circle_filter::<Separate>(a, ghost, c, q), 0.0);

    let (a, b, c, d) = ([0.0; 3], [2.0, 0.5, 0.25], [0.0, 3.0, 0.5], [0.5, 0.0, 1.5]);
    let q = [0.5, 0.75, 0.5];
    assert!(space::orient_filter::<Separate>(a, b, c, d) > 0.0);
    assert!(space::orient_filter::<Fused>(a, b, c, d) > 0.0);
    assert!(space::in_sphere_filter::<Separate>(a, b, c, d, q) > 0.0);
    assert!(space::in_sphere_filter::<Fused>(a, b, c, d, q) > 0.0);
    let ghost = [f64::NAN; 3];
    assert_eq!(space::orient_filter::<Separate>(a, ghost, c, d), 0.0);
    assert_eq!(space::in_sphere_filter::<Separate>(a, b, c, ghost, q), 0.0);
}

#[test]
fn smallest_balls_of_edges_and_facets() {
    assert_eq!(plane::in_diametral_circle([0.0, 0.0], [2.0, 0.0], [1.0, 0.5]), Sign::Positive);
    assert_eq!(plane::in_diametral_circle([0.0, 0.0], [2.0, 0.0], [1.0, 1.0]), Sign::Zero);
    assert_eq!(plane::in_diametral_circle([0.0, 0.0], [2.0, 0.0], [3.0, 0.0]), Sign::Negative);
    // The circle of radius 5 about (0, 0, 1) in the plane z = 1.
    let (a, b, c) = ([3.0, 4.0, 1.0], [-3.0, 4.0, 1.0], [4.0, -3.0, 1.0]);
    for (q, sign) in [
        ([0.0, 0.0, 1.0], Sign::Positive),
        ([0.0, 0.0, 6.0], Sign::Zero),
        ([0.0, 0.0, 5.999_999_999_999_999], Sign::Positive),
        ([0.0, 3.0, 5.0], Sign::Zero),
        ([0.0, 3.0, 5.000_000_000_000_001], Sign::Negative),
        ([0.0, 5.0, 2.0], Sign::Negative),
    ] {
        assert_eq!(space::in_equatorial_sphere(a, b, c, q), sign, "{q:?}");
        assert_eq!(space::in_equatorial_sphere(b, a, c, q), sign, "{q:?}");
        assert_eq!(space::shrunk_sphere(a, b, c, q, 0.0), sign, "{q:?}");
    }
    // Shrunk by a fifth its radius is 4.
    assert_eq!(space::shrunk_sphere(a, b, c, [0.0, 0.0, 4.9], 0.25), Sign::Negative);
    assert_eq!(space::shrunk_sphere(a, b, c, [0.0, 0.0, 4.75], 0.25), Sign::Zero);
    assert_eq!(space::shrunk_sphere(a, b, c, [0.0, 0.0, 4.7], 0.25), Sign::Positive);
    assert_eq!(space::in_diametral_sphere([0.0; 3], [2.0, 0.0, 0.0], [1.0, 0.0, 1.0]), Sign::Zero);
    assert_eq!(space::in_diametral_sphere([0.0; 3], [2.0, 0.0, 0.0], [1.0; 3]), Sign::Negative);
    assert_eq!(space::in_diametral_sphere([0.0; 3], [2.0, 0.0, 0.0], [0.5; 3]), Sign::Positive);
}

#[test]
fn circumcenters_on_cuts() {
    // Circumcenter (1, 2), radius 5.
    let (a, b, c) = ([4.0, 6.0], [-2.0, 6.0], [5.0, -1.0]);
    for (p, q, r) in [(a, b, c), (b, a, c)] {
        for (axis, at) in [(0, 1.0), (1, 2.0)] {
            assert_eq!(plane::circumcenter_side(p, q, r, axis, at), Sign::Zero);
            assert_eq!(plane::circumcenter_side(p, q, r, axis, at - 1e-15), Sign::Positive);
            assert_eq!(plane::circumcenter_side(p, q, r, axis, at + 1e-15), Sign::Negative);
        }
        let (r1, r2) = ([1.0, 3.0], [2.0, 2.0]);
        assert_eq!(plane::circumcenter_nearer(p, q, r, r1, r2), Sign::Zero);
        assert_eq!(plane::circumcenter_nearer(p, q, r, r1, [2.5, 2.0]), Sign::Positive);
        assert_eq!(plane::circumcenter_nearer(p, q, r, [2.5, 2.0], r1), Sign::Negative);
    }
    // Circumcenter (1, 2, 3), radius 3.
    let (a, b, c, d) = ([2.0, 4.0, 5.0], [4.0, 2.0, 3.0], [1.0, 5.0, 3.0], [-1.0, 1.0, 1.0]);
    for (p, q) in [(a, b), (b, a)] {
        for axis in 0..3 {
            let at = (axis + 1) as f64;
            assert_eq!(space::circumcenter_side(p, q, c, d, axis, at), Sign::Zero);
            assert_eq!(space::circumcenter_side(p, q, c, d, axis, at - 1e-15), Sign::Positive);
            assert_eq!(space::circumcenter_side(p, q, c, d, axis, at + 1e-15), Sign::Negative);
        }
        let (r1, r2) = ([1.0, 3.0, 3.0], [1.0, 2.0, 2.0]);
        assert_eq!(space::circumcenter_nearer(p, q, c, d, r1, r2), Sign::Zero);
        assert_eq!(space::circumcenter_nearer(p, q, c, d, r1, [1.0, 2.0, 1.5]), Sign::Positive);
        assert_eq!(space::circumcenter_nearer(p, q, c, d, [1.0, 2.0, 1.5], r1), Sign::Negative);
    }
}

/// Of the two diagonals of a square the perturbation takes the same one from whatever triangle is asked.
#[test]
fn conflict_is_antisymmetric_on_the_square() {
    let (a, b, c, d) = ([0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]);
    // abc and acd stand against abd and bcd.
    let inside = plane::conflict(a, b, c, d);
    assert_eq!(plane::conflict(a, c, d, b), inside);
    assert_eq!(plane::conflict(a, b, d, c), !inside);
    assert_eq!(plane::conflict(b, c, d, a), !inside);
    // c is lifted most, so c sees the diagonal bd from outside.
    assert!(inside);
}
