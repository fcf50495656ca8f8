//! Bodies around given points.

use taut_inscribe::{BodiesOptions, BodyShape, Error};

use super::shapes::{Mesh, cuboid, free, l_shape, options, proved, solve, wavy};
use crate::test_length::long_or;

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
    let shapes = shapes.into_iter().chain([8, 20, 256].map(BodyShape::Free));
    for shape in shapes.step_by(long_or(1, 2)) {
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
        (vec![[1.0, 0.5, 0.5]], 0, "is on a surface or an obstacle"),
        (vec![[1e-6, 0.5, 0.5]], 0, "is on a surface or an obstacle"),
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

/// Whether a body contains all of a segment.
fn contains_segment(
    found: &taut_certify::Solution<taut_certify::InscribedBodies>,
    body: usize,
    [from, to]: [[f64; 3]; 2],
) -> bool {
    contains(found, body, from) && contains(found, body, to)
}

#[test]
fn each_body_contains_its_segment() {
    let mesh = wavy(16, None);
    let at = around_the_tube();
    // Along the tube, across it, and a point.
    let ends: Vec<[f64; 3]> = at
        .iter()
        .enumerate()
        .map(|(k, p)| match k {
            0 => *p,
            1 => [p[0], p[1], p[2] + 0.3],
            _ => [p[0] - 0.25 * p[1], p[1] + 0.25 * p[0], p[2]],
        })
        .collect();
    for shape in [BodyShape::Dop(26), BodyShape::Free(20), BodyShape::Free(256)] {
        for disjoint in [false, true] {
            let options =
                BodiesOptions { shape, at: &at, ends: &ends, count: 6, disjoint, ..free(256) };
            let (found, verdict) = proved(&mesh, &options);
            assert_eq!((verdict.at, found.answer.ends.len()), (5, 5));
            for (body, (from, to)) in at.iter().zip(&ends).enumerate() {
                assert!(contains_segment(&found, body, [*from, *to]), "{shape:?}, body {body}");
            }
            let text = found.to_json();
            let read = taut_certify::AnySolution::from_json(&text).unwrap();
            assert_eq!(read.to_json(), text);
        }
    }
}

/// A long segment near the diagonal of a thin slab, which no box along the axes contains.
#[test]
fn a_body_around_a_segment_follows_it() {
    // A prism with the diagonal of the plane as its axis: |x − y| ≤ 0.1, 0 ≤ x + y ≤ 10, 0 ≤ z ≤ 0.1.
    let corner = |s: f64, t: f64, z: f64| [(s + t) / 2.0, (s - t) / 2.0, z];
    let vertices: Vec<[f64; 3]> = [0.0, 10.0]
        .into_iter()
        .flat_map(|s| [-0.1, 0.1].map(|t| [0.0, 0.1].map(|z| corner(s, t, z))))
        .flatten()
        .collect();
    let normals = [[1.0, 1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 0.0, 1.0]];
    let normals: Vec<[f64; 3]> = normals.into_iter().flat_map(|u| [u, u.map(|x| -x)]).collect();
    let mesh = super::shapes::hull(&vertices, &normals);
    let (from, to) = (corner(0.2, 0.0, 0.05), corner(9.8, 0.01, 0.06));
    let (at, ends) = ([from], [to]);
    let around = |options| BodiesOptions { at: &at, ends: &ends, ..options };
    let volume = 10.0 * 0.2 / 2.0 * 0.1;
    let given = [[1, 1, 0], [1, -1, 0], [0, 0, 1]];
    let shapes = [
        options(18),
        free(256),
        free(8),
        BodiesOptions { shape: BodyShape::Directions(&given), ..options(6) },
    ];
    for options in shapes {
        let (found, verdict) = proved(&mesh, &around(options.clone()));
        assert!(contains_segment(&found, 0, [from, to]), "{:?}", options.shape);
        assert!(verdict.largest > 0.999 * volume, "{:?}: {verdict:?}", options.shape);
    }
    // Along the axes there is none.
    let error = solve(&mesh, &around(options(6))).unwrap_err();
    assert!(error.to_string().contains("was found with facets in these directions"), "{error}");
}

#[test]
fn segments_that_leave_the_mesh_are_refused() {
    // Between the arms of the L.
    let (at, ends) = ([[1.9, 0.5, 0.5]], [[0.5, 1.9, 0.5]]);
    for options in [options(18), free(256)] {
        let error = solve(&l_shape(), &BodiesOptions { at: &at, ends: &ends, ..options.clone() });
        assert!(error.unwrap_err().to_string().contains(
            "point 0 of those that bodies are to contain (from 0) meets a surface or an obstacle"
        ));
        let outside = [[f64::NAN, 0.0, 0.0]];
        let error =
            solve(&l_shape(), &BodiesOptions { at: &at, ends: &outside, ..options.clone() });
        assert!(error.unwrap_err().to_string().contains("is not finite"));
        let error = solve(&l_shape(), &BodiesOptions { at: &at, ends: &[[0.5; 3]; 2], ..options });
        assert!(error.unwrap_err().to_string().contains("`ends`"));
    }
    // Two segments that cross have no disjoint bodies.
    let (at, ends) = ([[0.2, 0.5, 0.5], [0.5, 0.2, 0.5]], [[0.8, 0.5, 0.5], [0.5, 0.8, 0.5]]);
    let both = BodiesOptions { at: &at, ends: &ends, disjoint: true, ..free(256) };
    let error = solve(&l_shape(), &both).unwrap_err();
    assert!(error.to_string().contains("too near another point"), "{error}");
    assert_eq!(proved(&l_shape(), &BodiesOptions { disjoint: false, ..both }).1.at, 2);
}

/// A segment that is moved out of its body is rejected.
#[test]
fn the_checker_looks_at_both_ends() {
    let options = BodiesOptions { at: &[[0.5; 3]], ends: &[[1.5, 0.5, 0.5]], ..free(256) };
    let (found, _) = proved(&l_shape(), &options);
    for ends in [vec![[1.5, 1.5, 0.5]], vec![[f64::NAN; 3]], vec![[0.5; 3]; 2]] {
        let mut moved = found.clone();
        moved.answer.ends = ends;
        assert!(moved.check(&super::shapes::points(&l_shape())).is_err());
    }
}
