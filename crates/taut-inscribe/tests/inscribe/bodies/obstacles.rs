//! Points and surfaces that bodies stay clear of.

use taut_certify::{BodiesVerdict, InscribedBodies, Solution};
use taut_inscribe::{
    BodiesOptions, BodyShape, Error, Objective, Scene, box_rows, inscribed_bodies, point_rows,
};
use taut_points::Points;

use super::shapes::{Mesh, cuboid, free, options, points, proved, solve, wavy};

use crate::test_length::long_or;

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
fn inside(found: &Solution<InscribedBodies>, all: &[[f64; 3]]) -> usize {
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
    for &(count, seed) in long_or(&[(1, 1), (30, 2), (400, 3)][..], &[(30, 2)]) {
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
        let volume = |found: &Solution<InscribedBodies>| {
            found.answer.bodies.iter().map(|body| body.volume).sum::<f64>()
        };
        assert!(volume(&found) > 0.9 * volume(&alone), "{:?}", options.shape);
        more.push([[1e4, 0.0, 0.0]; 3]);
        let error = solve(&more, &options).unwrap_err();
        let far = more.len() as u64 - 1;
        assert!(matches!(error, Error::FarPoint { row, .. } if row == far), "{error}");
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

/// Bodies among obstacles that the checker accepts.
fn proved_in(
    scene: &Scene,
    options: &BodiesOptions<'_>,
) -> (Solution<InscribedBodies>, BodiesVerdict) {
    let points = Points::new(scene.rows(), 10).unwrap();
    let found = inscribed_bodies(&points, options).unwrap();
    let verdict = found.check(&points);
    let verdict = verdict.unwrap_or_else(|error| panic!("{error}: {:?}", found.answer));
    assert_eq!(found.trace.counters["obstacle_solids"], verdict.solids);
    (found, verdict)
}

fn rows_of(mesh: &[[[f64; 3]; 3]]) -> Vec<f64> {
    mesh.as_flattened().as_flattened().to_vec()
}

/// Points on a lattice in the interior of a box.
fn lattice(low: [f64; 3], high: [f64; 3]) -> Vec<[f64; 3]> {
    let at = |k: usize, c: usize| low[c] + (high[c] - low[c]) * (k as f64 + 0.5) / 8.0;
    (0..512).map(|k| [at(k % 8, 0), at(k / 8 % 8, 1), at(k / 64, 2)]).collect()
}

#[test]
fn no_body_is_in_a_solid() {
    let room = ([0.0; 3], [4.0; 3]);
    // In the room, through its floor and roof, beside it, overlapping, nested, the same twice, and around half of the room.
    let solids: [&[([f64; 3], [f64; 3])]; 7] = [
        &[([1.0, 1.0, 0.5], [3.0, 3.0, 3.0])],
        &[([1.0, 1.0, -1.0], [2.0, 2.0, 5.0])],
        &[([5.0, 0.0, 0.0], [7.0, 4.0, 4.0])],
        &[([0.5; 3], [2.5; 3]), ([1.5; 3], [3.5; 3])],
        &[([0.5; 3], [3.0; 3]), ([1.0; 3], [2.0; 3])],
        &[([1.0; 3], [2.0; 3]), ([1.0; 3], [2.0; 3])],
        &[([-1.0, -1.0, -1.0], [2.0, 5.0, 5.0])],
    ];
    for boxes in solids.into_iter().step_by(long_or(1, 3)) {
        let all: Vec<Mesh> = boxes.iter().map(|&(low, high)| cuboid(low, high)).collect();
        let mut apart = Scene::around(&rows_of(&cuboid(room.0, room.1))).unwrap();
        let mut as_one = apart.clone();
        for mesh in &all {
            apart.add_surface(&rows_of(mesh)).unwrap();
        }
        as_one.add_surface(&rows_of(&all.concat())).unwrap();
        let within = |low: [f64; 3], high: [f64; 3], p: &[f64; 3]| {
            (0..3).all(|c| low[c] < p[c] && p[c] < high[c])
        };
        let left: Vec<[f64; 3]> = lattice(room.0, room.1)
            .into_iter()
            .filter(|p| boxes.iter().all(|&(low, high)| !within(low, high, p)))
            .collect();
        let filled: Vec<_> = boxes.iter().flat_map(|&(low, high)| lattice(low, high)).collect();
        for (scene, ways) in [(&apart, shapes()), (&as_one, vec![free(256)])] {
            for options in ways {
                let (found, verdict) = proved_in(scene, &BodiesOptions { count: 5, ..options });
                assert!(verdict.solids > 0 && verdict.walls == 0, "{verdict:?}");
                assert_eq!(inside(&found, &filled), 0, "{boxes:?}, {:?}", options.shape);
                // Of what is outside of the room there is nothing either.
                let beyond = lattice([-2.0; 3], [8.0; 3]);
                let beyond: Vec<_> =
                    beyond.into_iter().filter(|p| !within(room.0, room.1, p)).collect();
                assert_eq!(inside(&found, &beyond), 0, "{boxes:?}, {:?}", options.shape);
                assert!(6 * inside(&found, &left) > left.len(), "{boxes:?}, {:?}", options.shape);
                let counters = &found.trace.counters;
                let covered = counters["covered"] as f64 / counters["sample_points"] as f64;
                assert!(covered > 0.1 && counters["sample_points"] > 30_000, "{counters:?}");
            }
        }
    }
}

#[test]
fn points_in_solids_are_refused_and_full_rooms_have_no_inside() {
    let room = rows_of(&cuboid([0.0; 3], [4.0; 3]));
    let mut scene = Scene::around(&room).unwrap();
    scene.add_surface(&rows_of(&cuboid([1.0; 3], [6.0; 3]))).unwrap();
    let points = Points::new(scene.rows(), 10).unwrap();
    for at in [[2.0; 3], [5.0; 3]] {
        let options = BodiesOptions { at: &[at], ..free(256) };
        let error = inscribed_bodies(&points, &options).unwrap_err();
        assert!(matches!(error, Error::At { at: 0, .. }), "{error}");
    }
    let mut full = Scene::around(&room).unwrap();
    full.add_surface(&rows_of(&cuboid([-1.0; 3], [6.0; 3]))).unwrap();
    for options in shapes().into_iter().step_by(long_or(1, 3)) {
        let found = inscribed_bodies(&Points::new(full.rows(), 10).unwrap(), &options);
        assert!(matches!(found, Err(Error::NoInside)), "{found:?}");
    }
    let mut far = Scene::around(&room).unwrap();
    far.add_surface(&rows_of(&cuboid([1.0; 3], [900.0; 3]))).unwrap();
    let found = inscribed_bodies(&Points::new(far.rows(), 10).unwrap(), &free(256));
    assert!(matches!(found, Err(Error::FarObstacle { row: 12.. })), "{found:?}");
}

#[test]
fn surfaces_are_told_apart_by_their_numbers() {
    let mut scene = Scene::around(&rows_of(&cuboid([0.0; 3], [4.0; 3]))).unwrap();
    scene.add_surface(&rows_of(&cuboid([1.0; 3], [2.0; 3]))).unwrap();
    let with = |row: usize, surface: f64| {
        let mut rows = scene.rows().to_vec();
        rows[10 * row + 9] = surface;
        inscribed_bodies(&Points::new(&rows, 10).unwrap(), &free(256))
    };
    for surface in [-2.0, 0.5, f64::MAX, 0.0] {
        let found = with(13, surface);
        assert!(matches!(found, Err(Error::Surface { row: 13, .. })), "{surface}: {found:?}");
    }
    assert!(matches!(with(13, 7.0), Err(Error::OpenSolid { surface: 1 })));
    assert!(matches!(with(13, -1.0), Err(Error::OpenSolid { surface: 1 })));
    // An answer among obstacles is none for other numbers of their surfaces.
    let (found, _) = proved_in(&scene, &free(256));
    let mut walls = scene.rows().to_vec();
    walls.iter_mut().skip(9).step_by(10).for_each(|surface| *surface = -surface.signum());
    assert!(found.check(&Points::new(&walls, 10).unwrap()).is_err());
}

#[test]
fn open_obstacles_are_walls() {
    let wall = [
        [[1.5, 0.0, 0.0], [1.5, 4.0, 0.0], [1.5, 4.0, 4.0]],
        [[1.5, 0.0, 0.0], [1.5, 4.0, 4.0], [1.5, 0.0, 4.0]],
    ];
    let mut scene = Scene::around(&rows_of(&cuboid([0.0; 3], [4.0; 3]))).unwrap();
    scene.add_surface(&rows_of(&wall)).unwrap();
    for options in [options(6), options(18), free(256)] {
        let (found, verdict) = proved_in(&scene, &options);
        assert!((verdict.largest - 40.0).abs() < 0.1, "{verdict:?}");
        assert_eq!((verdict.triangles, verdict.solids, verdict.walls), (12, 0, 2));
        assert_eq!(found.trace.counters["triangles"], 12);
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
