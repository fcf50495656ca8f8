//! Shapes whose largest bodies are known.

use taut_inscribe::{BodiesOptions, BodyShape};

use super::shapes::{
    Mesh, cuboid, directions, hull, l_shape, octahedron, options, permutations, proved, solve,
};

/// The volume proved is within rounding to the grid of the volume expected: each of k facets is moved by at most 4 units of
/// 2⁻²³ of the longest side, and no facet has more than twice the area of the square of that side.
fn has_volume(mesh: &Mesh, k: usize, expected: f64, side: f64) {
    let (found, verdict) = proved(mesh, &options(k));
    let slack = 8.0 * k as f64 * side.powi(3) / f64::from(1 << 23);
    assert!((verdict.largest - expected).abs() <= slack, "{k}: {verdict:?}, not {expected}");
    assert_eq!(found.answer.bodies.len(), 1);
    assert!((found.answer.bodies[0].volume - expected).abs() <= slack);
    assert!(verdict.volume_lower <= verdict.volume_upper);
    assert!(verdict.volume_upper <= verdict.volume_lower * (1.0 + 1e-12));
}

#[test]
fn shapes_that_are_dops_are_filled() {
    let cube = cuboid([0.0; 3], [1.0; 3]);
    let box_ = cuboid([-3.0, 1.0, 0.5], [5.0, 2.0, 3.5]);
    let truncated = hull(&permutations([0.0, 1.0, 2.0]), &directions(&[1, 3]));
    // Of side 2: (±1, ±1, ±(1 + √2)); its corners are not on the grid.
    let rhombic = hull(&permutations([1.0, 1.0, 1.0 + 2f64.sqrt()]), &directions(&[1, 2, 3]));
    for k in [6, 14, 18, 26] {
        has_volume(&cube, k, 1.0, 1.0);
        has_volume(&box_, k, 24.0, 8.0);
    }
    for k in [14, 26] {
        has_volume(&octahedron(), k, 4.0 / 3.0, 2.0);
        has_volume(&truncated, k, 32.0, 4.0);
    }
    has_volume(&rhombic, 26, (12.0 + 10.0 * 2f64.sqrt()) * 8.0 / 3.0, 2.0 + 8f64.sqrt());
}

#[test]
fn on_the_grid_no_unit_is_lost() {
    for k in [6, 14, 18, 26] {
        let (found, verdict) = proved(&cuboid([0.0; 3], [1.0; 3]), &options(k));
        assert_eq!(&found.answer.bodies[0].offsets[..6], [1 << 23, 0, 1 << 23, 0, 1 << 23, 0]);
        assert!((verdict.largest - 1.0).abs() < 1e-13 && verdict.volume_upper >= 1.0);
        let sides = found.answer.half_spaces(&found.answer.bodies[0]);
        assert_eq!(sides[0], ([1.0, 0.0, 0.0], 1.0));
        let vertices = found.answer.vertices(&found.answer.bodies[0]);
        assert_eq!(vertices.len(), 8);
        assert!(vertices.iter().flatten().all(|&x| x == 0.0 || x == 1.0));
    }
}

#[test]
fn an_l_is_covered_by_two_boxes() {
    let mesh = l_shape();
    let (found, verdict) = proved(&mesh, &options(6));
    assert!((verdict.largest - 2.0).abs() < 1e-5, "{verdict:?}");
    assert_eq!(found.answer.bodies.len(), 1);
    let two = BodiesOptions { count: 2, ..options(6) };
    let (found, verdict) = proved(&mesh, &two);
    assert!((verdict.volume_lower - 4.0).abs() < 1e-5, "{verdict:?}");
    assert_eq!(found.trace.counters["covered"], found.trace.counters["sample_points"]);
    let (found, verdict) = proved(&mesh, &BodiesOptions { disjoint: true, ..two });
    assert!((verdict.volume_lower - 3.0).abs() < 1e-5 && verdict.disjoint, "{verdict:?}");
    assert_eq!(found.certificate.pairs.len(), 1);
    // Nothing is left for a third body.
    let three = BodiesOptions { count: 3, disjoint: true, ..options(6) };
    assert_eq!(proved(&mesh, &three).0.answer.bodies.len(), 2);
}

#[test]
fn a_cavity_is_not_inside() {
    // A cube in a cube: by the even-odd rule the inner one is a cavity, whichever way its triangles are turned.
    let mut mesh = cuboid([0.0; 3], [8.0; 3]);
    mesh.extend(cuboid([2.0; 3], [6.0; 3]));
    let (_, verdict) = proved(&mesh, &options(6));
    assert!((verdict.largest - 128.0).abs() < 1e-4, "{verdict:?}");
}

/// Given directions: polyhedra whose facets they are, and refusals.
#[test]
fn given_directions_fill_their_shapes() {
    // A parallelepiped between planes with normals (1, 2, 0), (0, 1, 3), (1, −1, 1), from −1 to 1 along each: by the inverse matrix.
    let given = [[1, 2, 0], [0, 1, 3], [1, -1, 1]];
    let inverse =
        [[4.0, -2.0, 6.0], [3.0, 1.0, -3.0], [-1.0, 3.0, 1.0]].map(|row| row.map(|x| x / 10.0));
    let signs = (0..8).map(|bits| [0, 1, 2].map(|c| if bits >> c & 1 == 1 { 1.0 } else { -1.0 }));
    let vertices: Vec<[f64; 3]> = signs
        .map(|s: [f64; 3]| {
            inverse.map(|row: [f64; 3]| row[0] * s[0] + row[1] * s[1] + row[2] * s[2])
        })
        .collect();
    let floats = given.map(|u| u.map(|n| n as f64));
    let normals: Vec<[f64; 3]> = floats.into_iter().flat_map(|u| [u, u.map(|x| -x)]).collect();
    let mesh = hull(&vertices, &normals);
    let expected = 8.0 / 10.0;
    let scaled = [[2, 4, 0], [0, -3, -9], [1, -1, 1]];
    let more = [[1, 2, 0], [0, 1, 3], [1, -1, 1], [1, 0, 0], [31, -1, 31]];
    for directions in [&given[..], &scaled, &more] {
        let options = BodiesOptions { shape: BodyShape::Directions(directions), ..options(6) };
        let (found, verdict) = proved(&mesh, &options);
        assert!((verdict.largest - expected).abs() < 1e-5, "{directions:?}: {verdict:?}");
        assert_eq!(found.answer.bodies[0].normals.len(), 2 * directions.len());
        assert_eq!(found.trace.method, "dops");
    }
    // Fixed directions cover less of it.
    assert!(proved(&mesh, &options(26)).1.largest < 0.9 * expected);
    let refused: [(&[[i64; 3]], &str); 7] = [
        (&[[1, 0, 0], [0, 1, 0]], "from 3 to 13"),
        (&[[1, 0, 0]; 14], "from 3 to 13"),
        (&[[1, 0, 0], [0, 1, 0], [0, 0, 0]], "not all 0"),
        (&[[1, 0, 0], [0, 1, 0], [0, 0, i64::MIN]], "at most 63"),
        (&[[1, 0, 0], [0, 1, 0], [32, 32, 0]], "at most 63"),
        (&[[1, 0, 0], [0, 1, 0], [-2, 0, 0], [0, 0, 1]], "no two are parallel"),
        (&[[1, 0, 0], [0, 1, 0], [1, 1, 0]], "not all in one plane"),
    ];
    for (directions, expected) in refused {
        let shape = BodyShape::Directions(directions);
        let error = solve(&mesh, &BodiesOptions { shape, ..options(6) }).unwrap_err();
        assert!(error.to_string().contains(expected), "{directions:?}: {error}");
    }
}
