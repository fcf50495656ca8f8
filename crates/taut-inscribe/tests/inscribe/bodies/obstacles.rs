//! Points and surfaces that bodies stay clear of.

use taut_inscribe::{BodiesOptions, BodyShape, Error, Objective, box_rows, point_rows};

use super::shapes::{Mesh, cuboid, free, options, points, proved, solve, wavy};

/// Points in the unit cube, from a generator of its own.
fn scattered(count: usize, mut state: u64) -> Vec<[f64; 3]> {
    let mut unit = || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    (0..count).map(|_| [unit(), unit(), unit()]).collect()
}

fn mesh_of(rows: &[f64]) -> Mesh {
    rows.as_chunks::<3>().0.as_chunks::<3>().0.to_vec()
}

/// The shapes of bodies to try.
fn shapes() -> Vec<BodiesOptions<'static>> {
    const SKEW: [[i64; 3]; 4] = [[1, 2, 0], [-2, 1, 0], [0, 1, 3], [1, 1, -1]];
    let skew = BodiesOptions { shape: BodyShape::Directions(&SKEW), ..options(6) };
    vec![options(6), options(18), options(26), free(30), free(256), skew]
}

/// How many points are more than rounding allows inside of a body, by its half-spaces.
fn inside(
    found: &taut_certify::Solution<taut_certify::InscribedBodies>,
    all: &[[f64; 3]],
) -> usize {
    let bodies: Vec<_> =
        found.answer.bodies.iter().map(|body| found.answer.half_spaces(body)).collect();
    let is_in = |p: &&[f64; 3]| {
        bodies
            .iter()
            .any(|sides| sides.iter().all(|(u, b)| u[0] * p[0] + u[1] * p[1] + u[2] * p[2] < *b))
    };
    all.iter().filter(is_in).count()
}

#[test]
fn bodies_among_points_contain_none_of_them() {
    for (count, seed) in [(1, 1), (30, 2), (400, 3)] {
        let all = scattered(count, seed);
        let corners = [[0.0; 3], [1.0; 3]];
        let mut mesh = mesh_of(&box_rows(&corners));
        mesh.extend(mesh_of(&point_rows(&all)));
        for disjoint in [false, true] {
            for options in shapes() {
                let options = BodiesOptions { count: 4, disjoint, ..options };
                let (found, verdict) = proved(&mesh, &options);
                assert_eq!(inside(&found, &all), 0, "{:?}", options.shape);
                assert!(verdict.largest > 0.2 / count as f64, "{verdict:?}");
                assert_eq!(found.trace.counters["obstacle_points"], count as u64);
                assert_eq!(found.trace.counters["triangles"], 12);
                // Without the points the bodies are not proved: their hash is another.
                assert!(found.check(&points(&mesh[..12])).is_err());
            }
        }
    }
}

#[test]
fn one_point_in_a_cube_leaves_half_of_it() {
    let mut mesh = cuboid([0.0; 3], [1.0; 3]);
    mesh.push([[0.5; 3]; 3]);
    // The axes and any plane through the middle: a half. Diagonal facets do not help.
    for options in [options(6), options(18), options(26), free(256)] {
        let (_, verdict) = proved(&mesh, &BodiesOptions { events: 20_000, ..options });
        assert!(verdict.largest > 0.499 && verdict.largest < 0.5 + 1e-6, "{verdict:?}");
    }
}

#[test]
fn a_point_beyond_the_mesh_changes_nothing_and_one_far_beyond_is_refused() {
    let mesh = wavy(12, None);
    for options in shapes() {
        let alone = solve(&mesh, &options).unwrap();
        let mut more = mesh.clone();
        // Beyond the bounding box, on both sides, and in the hole of the torus.
        for p in [[9.0, 0.0, 0.0], [0.0, -80.0, 0.3], [2.1, 0.0, 7.5], [0.0, 0.0, 0.0]] {
            more.push([p; 3]);
        }
        let (found, _) = proved(&more, &options);
        assert_eq!(found.answer.bodies.len(), alone.answer.bodies.len());
        let volume = |found: &taut_certify::Solution<taut_certify::InscribedBodies>| {
            found.answer.bodies.iter().map(|body| body.volume).sum::<f64>()
        };
        assert!(volume(&found) > 0.9 * volume(&alone), "{:?}", options.shape);
        more.push([[1e4, 0.0, 0.0]; 3]);
        let error = solve(&more, &options).unwrap_err();
        let far = more.len() as u64 - 1;
        assert!(matches!(error, Error::FarPoint { row } if row == far), "{error}");
    }
}

#[test]
fn points_alone_have_no_inside() {
    let rows = mesh_of(&point_rows(&scattered(50, 4)));
    let error = solve(&rows, &free(256)).unwrap_err();
    assert!(matches!(error, Error::NoInside), "{error}");
    assert!(box_rows(&[]).is_empty());
    // All points equal, or in a plane: their box has no inside.
    for flat in [vec![[2.0; 3]; 9], vec![[0.0, 0.0, 1.0], [1.0, 2.0, 1.0], [5.0, 0.0, 1.0]]] {
        let mut mesh = mesh_of(&box_rows(&flat));
        mesh.extend(mesh_of(&point_rows(&flat)));
        let error = solve(&mesh, &free(256)).unwrap_err();
        assert!(matches!(error, Error::NoInside), "{error}");
    }
}

#[test]
fn closed_obstacles_take_their_inside_away_and_open_ones_are_walls() {
    let mut mesh = cuboid([0.0; 3], [4.0; 3]);
    mesh.extend(cuboid([1.0, 1.0, 0.0], [3.0, 3.0, 3.0]));
    for options in shapes() {
        let (found, _) = proved(&mesh, &BodiesOptions { count: 6, ..options });
        assert_eq!(inside(&found, &[[2.0, 2.0, 1.0], [1.1, 1.1, 0.1], [2.9, 1.5, 2.9]]), 0);
    }
    // A wall that divides the cube: two triangles, each twice.
    let wall = [
        [[1.5, 0.0, 0.0], [1.5, 4.0, 0.0], [1.5, 4.0, 4.0]],
        [[1.5, 0.0, 0.0], [1.5, 4.0, 4.0], [1.5, 0.0, 4.0]],
    ];
    let mut mesh = cuboid([0.0; 3], [4.0; 3]);
    mesh.extend(wall);
    mesh.extend(wall);
    for options in [options(6), options(18), free(256)] {
        let (_, verdict) = proved(&mesh, &options);
        assert!((verdict.largest - 40.0).abs() < 0.1, "{verdict:?}");
    }
}

#[test]
fn the_thesis_and_lines_know_points_too() {
    let all = scattered(60, 5);
    let mut mesh = cuboid([0.0; 3], [1.0; 3]);
    mesh.extend(mesh_of(&point_rows(&all)));
    let method = taut_inscribe::BodiesMethod::Thesis(Default::default());
    let thesis = BodiesOptions { method, count: 3, ..options(18) };
    let hidden = BodiesOptions { objective: Objective::Occlusion, count: 3, ..options(18) };
    for options in [thesis, hidden] {
        let (found, _) = proved(&mesh, &options);
        assert_eq!(inside(&found, &all), 0, "{:?}", options.method);
    }
}
