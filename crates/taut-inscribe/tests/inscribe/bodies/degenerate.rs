//! Meshes without inside, with holes, or with numbers at the ends of the range.

use taut_inscribe::{BodiesOptions, BodyShape, Error, inscribed_bodies, triangle_rows};
use taut_points::{InputError, Points};

use super::shapes::{Mesh, cuboid, octahedron, options, proved, solve};

fn scaled(mesh: &Mesh, factor: f64, shift: f64) -> Mesh {
    mesh.iter().map(|t| t.map(|p| p.map(|x| x * factor + shift))).collect()
}

#[test]
fn meshes_without_inside_are_refused() {
    let k = options(18);
    assert!(matches!(solve(&[], &k), Err(Error::NoInside)));
    let point = [[1.0; 3]; 3];
    assert!(matches!(solve(&[point], &k), Err(Error::NoInside)));
    let flat = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    assert!(matches!(solve(&[flat, flat], &k), Err(Error::NoInside)));
    let thin = cuboid([0.0; 3], [1.0, 1.0, 1e-7]);
    assert!(matches!(solve(&thin, &k), Err(Error::NoInside)));
}

#[test]
fn a_hole_is_named() {
    let mut mesh = octahedron();
    let gone = mesh.remove(3);
    match solve(&mesh, &options(18)) {
        Err(Error::Open { edges: 3, from, to, .. }) => {
            assert!(gone.contains(&from) && gone.contains(&to) && from != to);
        }
        other => panic!("{other:?}"),
    }
    let error = solve(&[gone], &options(18)).unwrap_err();
    assert!(error.to_string().contains("of triangle 0 (from 0); close the holes"), "{error}");
}

#[test]
fn numbers_and_options_out_of_range_are_refused() {
    let cube = cuboid([0.0; 3], [1.0; 3]);
    let mut mesh = cube.clone();
    mesh[2][1][0] = f64::NAN;
    let error = solve(&mesh, &options(6)).unwrap_err();
    assert!(matches!(error, Error::Input(InputError::NonFinite { row: 2, column: 3, .. })));
    for (factor, shift) in [(1.1e-83, 0.0), (0.9e100, 0.0), (1.99, 6.8e10 * 1.99)] {
        assert!(solve(&scaled(&cube, factor, shift), &options(6)).is_ok(), "{factor} {shift}");
    }
    for (factor, shift) in
        [(1e300, 0.0), (f64::MAX, 0.0), (1e-300, 0.0), (1.0, 1e12), (1.99, 7e10 * 1.99)]
    {
        let error = solve(&scaled(&cube, factor, shift), &options(6)).unwrap_err();
        assert!(matches!(error, Error::Grid { .. }), "{factor} {shift}: {error}");
    }
    let dim = inscribed_bodies(&Points::new(&[0.0; 6], 3).unwrap(), &options(6)).unwrap_err();
    assert!(dim.to_string().contains("expected 9"), "{dim}");
    for (wrong, name) in [
        (BodiesOptions { shape: BodyShape::Dop(8), ..options(6) }, "directions"),
        (BodiesOptions { shape: BodyShape::Free(7), ..options(6) }, "facets"),
        (BodiesOptions { shape: BodyShape::Free(257), ..options(6) }, "facets"),
        (BodiesOptions { coverage: Some(0.0), ..options(6) }, "coverage"),
        (BodiesOptions { coverage: Some(f64::NAN), ..options(6) }, "coverage"),
        (BodiesOptions { hidden: Some(0.5), ..options(6) }, "hidden"),
        (BodiesOptions { merge_within: Some(1.0), ..options(6) }, "merge_within"),
        (BodiesOptions { merge_within: Some(f64::NAN), ..options(6) }, "merge_within"),
        (BodiesOptions { at: &[[0.5; 3]; 1001], ..options(6) }, "at"),
        (BodiesOptions { count: 0, ..options(6) }, "count"),
        (BodiesOptions { events: 0, ..options(6) }, "events"),
    ] {
        let error = solve(&cube, &wrong).unwrap_err();
        assert!(error.to_string().contains(name), "{error}");
    }
    let missing = triangle_rows(&[[0.0; 3]], &[[0, 0, 1]]).unwrap_err();
    assert_eq!(missing.to_string(), "triangle 0 names vertex 1, but there are 1 vertices");
}

#[test]
fn small_large_and_far_meshes_are_answered() {
    let cube = cuboid([0.0; 3], [1.0; 3]);
    for (factor, shift) in [(1e-70, 0.0), (1e85, 0.0), (1.0, 1e9), (1e-3, -5e6), (3.0, -0.1)] {
        let mesh = scaled(&cube, factor, shift);
        let (_, verdict) = proved(&mesh, &options(14));
        let [low, high] = [mesh[0][0][0], mesh[0][0][0]].map(|_| {
            let all = mesh.as_flattened().iter().map(|p| p[0]);
            (all.clone().fold(f64::MAX, f64::min), all.fold(f64::MIN, f64::max))
        });
        let side = high.1 - low.0;
        assert!((verdict.largest / side.powi(3) - 1.0).abs() < 1e-5, "{factor} {shift}");
    }
}

#[test]
fn repeated_vertices_and_triangles_without_area_do_no_harm() {
    let mut mesh = octahedron();
    // A triangle twice is no triangle, and a triangle along an edge has no inside.
    let [a, b, c] = mesh[0];
    mesh.extend([[a, b, c], [a, b, c], [a, a, a], [a, b, b]]);
    let negative_zero = mesh.iter_mut().flatten().flatten().filter(|x| **x == 0.0).step_by(2);
    negative_zero.for_each(|x| *x = -0.0);
    let (_, verdict) = proved(&mesh, &options(14));
    assert!((verdict.largest - 4.0 / 3.0).abs() < 1e-4, "{verdict:?}");
}
