//! Bodies around given points.

use taut_inscribe::{BodiesOptions, BodyShape, Error};

use super::shapes::{Mesh, cuboid, free, l_shape, options, proved, solve, wavy};

/// Whether a body of the answer contains a point, by its half-spaces.
fn contains(
    found: &taut_certify::Solution<taut_certify::InscribedBodies>,
    body: usize,
    p: [f64; 3],
) -> bool {
    let sides = found.answer.half_spaces(&found.answer.bodies[body]);
    sides.iter().all(|(u, b)| u[0] * p[0] + u[1] * p[1] + u[2] * p[2] <= *b)
}

/// Points near the center line of the tube of the torus.
fn around_the_tube() -> Vec<[f64; 3]> {
    let at = |k: usize| {
        let turn = std::f64::consts::TAU * k as f64 / 5.0;
        [2.1 * turn.cos(), 2.1 * turn.sin(), 0.123 * k as f64 / 5.0]
    };
    (0..5).map(at).collect()
}

#[test]
fn each_body_contains_its_point() {
    let mesh = wavy(16, None);
    let at = around_the_tube();
    let shapes = [6, 18, 26].map(BodyShape::Dop);
    for shape in shapes.into_iter().chain([8, 20, 256].map(BodyShape::Free)) {
        for disjoint in [false, true] {
            let options = BodiesOptions { shape, at: &at, count: 7, disjoint, ..free(256) };
            let (found, verdict) = proved(&mesh, &options);
            assert_eq!(verdict.at, 5);
            assert!(verdict.bodies >= 6, "{shape:?}: {verdict:?}");
            for (body, p) in at.iter().enumerate() {
                assert!(contains(&found, body, *p), "{shape:?}, body {body}");
            }
        }
    }
}

#[test]
fn the_body_around_a_point_is_the_part_in_which_the_point_lies() {
    // The arms of an L: the largest box around a point in one of them.
    for (at, volume) in [([1.9, 0.5, 0.5], 2.0), ([0.5, 1.9, 0.1], 2.0), ([0.5, 0.5, 0.5], 2.0)] {
        for options in [options(6), free(256)] {
            let (_, verdict) = proved(&l_shape(), &BodiesOptions { at: &[at], ..options });
            assert!(verdict.largest > 0.98 * volume, "{at:?}: {verdict:?}");
        }
    }
    // Two boxes apart: a point in the smaller one.
    let mut mesh: Mesh = cuboid([0.0; 3], [2.0; 3]);
    mesh.extend(cuboid([3.0; 3], [4.0; 3]));
    for options in [options(14), free(256)] {
        let (_, verdict) = proved(&mesh, &BodiesOptions { at: &[[3.9; 3]], ..options });
        assert!((verdict.largest - 1.0).abs() < 0.02, "{verdict:?}");
    }
}

#[test]
fn points_without_room_are_refused_with_the_reason() {
    let mesh = cuboid([0.0; 3], [1.0; 3]);
    let half = [0.5; 3];
    for (at, number, expected) in [
        (vec![half, [1.5, 0.5, 0.5]], 1, "is outside of the mesh"),
        (vec![[0.5, 0.5, -1e-3]], 0, "is outside of the mesh"),
        (vec![[f64::NAN; 3]], 0, "is not finite"),
        (vec![[f64::INFINITY; 3]], 0, "is not finite"),
        (vec![[1.0, 0.5, 0.5]], 0, "is on the surface"),
        (vec![[1e-6, 0.5, 0.5]], 0, "is on the surface"),
    ] {
        for options in [options(18), free(256)] {
            let error = solve(&mesh, &BodiesOptions { at: &at, ..options }).unwrap_err();
            assert!(matches!(error, Error::At { at, .. } if at == number), "{error}");
            assert!(error.to_string().contains(expected), "{error}");
        }
    }
    let near = [half, [0.5, 0.5, 0.500_001]];
    for options in [options(18), free(256)] {
        let both = BodiesOptions { at: &near, ..options };
        assert_eq!(proved(&mesh, &both).1.at, 2);
        let error = solve(&mesh, &BodiesOptions { disjoint: true, ..both }).unwrap_err();
        assert!(error.to_string().contains("point 0 of those"), "{error}");
        assert!(error.to_string().contains("too near another point"), "{error}");
    }
    // A cavity is not inside.
    let mut cavity = cuboid([0.0; 3], [8.0; 3]);
    cavity.extend(cuboid([2.0; 3], [6.0; 3]));
    let error = solve(&cavity, &BodiesOptions { at: &[[4.0; 3]], ..free(256) }).unwrap_err();
    assert!(error.to_string().contains("is outside of the mesh"), "{error}");
}
