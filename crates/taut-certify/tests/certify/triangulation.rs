//! Triangulations that are right are accepted, whatever the points.

use mesh::{Case, Dice, brute_force, certify, set, solved};
use taut_certify::{AnySolution, MeshViolation, check_simplices};
use taut_certify::{CheckError, Violation};
use taut_points::{Monitor, Points};

use crate::mesh;

fn is_accepted(case: &Case) {
    let verdict = case.solution.check(&case.points());
    let verdict = verdict.unwrap_or_else(|error| panic!("{}: {error}\n{case:?}", case.name));
    assert_eq!(verdict.counts, case.solution.certificate.counts, "{}", case.name);
    assert_eq!(verdict.fingerprint, case.solution.certificate.fingerprint, "{}", case.name);
    let mut without = case.solution.clone();
    without.certificate.neighbors.clear();
    assert_eq!(without.check(&case.points()).unwrap(), verdict, "{}: neighbors found", case.name);
    for solution in [&case.solution, &without] {
        match AnySolution::from_json(&solution.to_json()) {
            Ok(AnySolution::Triangulation(again)) => assert_eq!(again, *solution),
            other => panic!("{}: {other:?}\n{}", case.name, solution.to_json()),
        }
    }
    let width = case.solution.answer.vertices_per_simplex();
    if !case.solution.answer.simplices.is_empty() {
        // Every other simplex faces the other way, and the last comes first.
        let simplices = &case.solution.answer.simplices;
        let mut simplices: Vec<u32> = simplices.rchunks(width).flatten().copied().collect();
        simplices.chunks_mut(width).step_by(2).for_each(|simplex| simplex.swap(0, width - 1));
        let found = check_simplices(&case.points(), &simplices, width, &Monitor::silent());
        assert_eq!(found.unwrap().fingerprint, verdict.fingerprint, "{}: as a mesh", case.name);
    }
}

#[test]
fn grids_and_lattices() {
    let grid = |side: i32, d: usize| -> Vec<f64> {
        let cell = |i: i32| (0..d as u32).map(move |k| f64::from(i / side.pow(k) % side));
        (0..side.pow(d as u32)).flat_map(cell).collect()
    };
    is_accepted(&solved("square", &grid(2, 2), 2));
    is_accepted(&solved("3 × 3", &grid(3, 2), 2));
    is_accepted(&solved("4 × 4", &grid(4, 2), 2));
    let cube = solved("cube", &grid(2, 3), 3);
    is_accepted(&cube);
    assert_eq!(cube.solution.answer.len(), 6);
    assert!(cube.solution.check(&cube.points()).unwrap().ties > 0);
    let thirds: Vec<f64> = grid(3, 2).iter().map(|x| x / 3.0).collect();
    is_accepted(&solved("thirds, which are no grid", &thirds, 2));
    let octahedron = [1., 0., 0., -1., 0., 0., 0., 1., 0., 0., -1., 0., 0., 0., 1., 0., 0., -1.];
    is_accepted(&solved("octahedron", &octahedron, 3));
    let with_center = [octahedron.as_slice(), &[0.0; 3]].concat();
    is_accepted(&solved("octahedron with its center", &with_center, 3));
}

#[test]
fn random_points_of_the_plane() {
    let mut dice = Dice(1);
    for round in 0..60 {
        let count = 3 + dice.below(7);
        let side = [2, 3, 4, 6, 1000][round % 5];
        let name = format!("{count} of {side} × {side}, round {round}");
        is_accepted(&solved(&name, &dice.grid(2 * count, side), 2));
        is_accepted(&solved(&name, &dice.numbers(2 * count), 2));
    }
}

#[test]
fn random_points_of_space() {
    let mut dice = Dice(2);
    for round in 0..24 {
        let count = 4 + dice.below(5);
        let side = [2, 3, 4, 1000][round % 4];
        let name = format!("{count} of {side}³, round {round}");
        is_accepted(&solved(&name, &dice.grid(3 * count, side), 3));
        is_accepted(&solved(&name, &dice.numbers(3 * count), 3));
    }
}

#[test]
fn points_of_lower_dimension() {
    let mut dice = Dice(3);
    for d in [2, 3] {
        is_accepted(&solved("none", &[], d));
        is_accepted(&solved("one", &dice.grid(d, 9), d));
        is_accepted(&solved("one, three times", &dice.grid(d, 9).repeat(3), d));
        for _ in 0..6 {
            let (from, along) = (dice.grid(d, 9), dice.grid(d, 3));
            let line: Vec<f64> = (0..6)
                .flat_map(|_| {
                    let at = dice.below(5) as f64;
                    (0..d).map(|k| from[k] + at * along[k]).collect::<Vec<_>>()
                })
                .collect();
            is_accepted(&solved("on a line", &line, d));
        }
    }
    for plane in 0..24 {
        let axes: Vec<f64> = match plane % 4 {
            0 => vec![1., 0., 0., 0., 0., 1.],
            1 => vec![0., 1., 0., 0., 0., 1.],
            2 => vec![1., 1., 0., 0., 0., 1.],
            _ => dice.grid(6, 3),
        };
        let points: Vec<f64> = (0..7)
            .flat_map(|_| {
                let (s, t) = (dice.below(4) as f64 - 1.0, dice.below(4) as f64);
                (0..3).map(|k| 5.0 + s * axes[k] + t * axes[3 + k]).collect::<Vec<_>>()
            })
            .collect();
        is_accepted(&solved("on a plane", &points, 3));
    }
}

/// Edges and single vertices as a file of a mesh has them.
#[test]
fn wrong_meshes_of_collinear_points_are_refused() {
    let line = [0.0, 0.0, 2.0, 2.0, 1.0, 1.0, 3.0, 3.0, 1.0, 1.0];
    let judge = |values: &[f64], simplices: &[u32], width| {
        let points = Points::new(values, 2).unwrap();
        match check_simplices(&points, simplices, width, &Monitor::silent()) {
            Ok(found) => Ok(found.counts.hull),
            Err(CheckError::Rejected(Violation::Mesh(violation))) => Err(violation),
            Err(other) => panic!("{other}"),
        }
    };
    // Any order, either way, and of equal points any one.
    assert_eq!(judge(&line, &[3, 1, 0, 2, 1, 2], 2), Ok(2));
    assert_eq!(judge(&line, &[3, 1, 0, 4, 1, 4], 2), Ok(2));
    let chain = |position| Err(MeshViolation::Chain { position });
    assert_eq!(judge(&line, &[3, 1, 0, 2, 4, 1], 2), chain(2), "two ids for one place");
    assert_eq!(judge(&line, &[0, 1, 2, 1, 1, 3], 2), chain(1), "an edge over a point");
    assert_eq!(judge(&line, &[0, 2, 2, 1, 1, 3, 1, 2], 2), chain(3), "an edge twice");
    assert_eq!(judge(&line, &[0, 2, 1, 3], 2), chain(1), "a gap");
    assert_eq!(judge(&line, &[0, 2, 2, 1], 2), Err(MeshViolation::Missing { row: 3 }));
    assert_eq!(judge(&line, &[0, 0, 2, 1, 1, 3], 2), chain(0), "a loop");
    let dimension = |claimed, found| Err(MeshViolation::HullDimension { claimed, found });
    assert_eq!(judge(&line, &[0, 1, 2, 3], 1), dimension(Some(0), Some(1)));
    assert_eq!(judge(&[0., 0., 1., 0., 0., 1.], &[0, 1, 1, 2], 2), dimension(Some(1), Some(2)));
    assert_eq!(judge(&[5.0; 6], &[1], 1), Ok(0));
    assert_eq!(judge(&[5.0; 6], &[1, 2], 1), chain(1));
    assert_eq!(judge(&[], &[], 1), dimension(Some(0), None));
    let none = MeshViolation::Dimension { claimed: 0, found: 2 };
    assert_eq!(judge(&line, &[], 0), Err(none));
}

/// Scales at which squares or fifth powers leave the range of f64, and sets that mix them.
#[test]
fn extreme_coordinates() {
    let mut dice = Dice(4);
    let scales = [1e-320, 1e300, 1e-150, 1e-300, 1e-60, 1e60, 1e150];
    for scale in scales.into_iter().take(crate::test_length::long_or(7, 3)) {
        for d in [2, 3] {
            let points: Vec<f64> = dice.grid(7 * d, 3).iter().map(|x| (x - 1.0) * scale).collect();
            is_accepted(&solved(&format!("grid times {scale:e}"), &points, d));
        }
    }
    let mixed = [-0.0, 0.0, 1e300, 0.0, 0.0, 1e-300, 1.0, 1.0, -1e-310, -1e300, 0.0, -0.0];
    is_accepted(&solved("mixed", &mixed, 2));
    let near: Vec<f64> = dice.grid(18, 3).iter().map(|x| 1.0 + x * f64::EPSILON).collect();
    is_accepted(&solved("neighbors at 1, in the plane", &near, 2));
    is_accepted(&solved("neighbors at 1, in space", &near, 3));
}

/// Points named in reports against other programs.
#[test]
fn known_traps() {
    // Of four points, two are nearly the same.
    is_accepted(&solved("near-duplicates", &[0.0, 0.0, 0.056, 0.0, 0.024, 4.8e-18, 0.03, 1.0], 2));
    // Whole points on one circle: 25² = 7² + 24² = 15² + 20².
    let circle =
        [25., 0., 7., 24., 24., 7., 15., 20., 20., 15., 0., 25., -7., 24., -25., 0., 0., -25.];
    is_accepted(&solved("circle", &circle, 2));
    let sphere =
        [3., 0., 0., 0., 3., 0., 0., 0., 3., 1., 2., 2., 2., 1., 2., 2., 2., 1., -1., -2., -2.];
    is_accepted(&solved("sphere", &sphere, 3));
}

/// The other diagonal of a square is Delaunay, but not the triangulation that the perturbation selects.
#[test]
fn one_diagonal_is_right() {
    let values = [0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 1.0];
    let right = brute_force(&values, 2);
    let mut wrong = right.clone();
    wrong.simplices = match set(&right).contains([0, 1, 2].as_slice()) {
        true => vec![0, 1, 3, 0, 3, 2],
        false => vec![0, 1, 2, 1, 3, 2],
    };
    let points = Points::new(&values, 2).unwrap();
    match certify(&values, wrong).check(&points) {
        Err(CheckError::Rejected(Violation::Mesh(MeshViolation::Conflict { tie, .. }))) => {
            assert!(tie)
        }
        other => panic!("{other:?}"),
    }
}

/// Differences that are no `f64`, and some of 2⁶³ and more of the least bit of all: exact signs must not take a short cut.
#[test]
fn coordinates_of_very_different_size() {
    let (x, g) = (2f64.powi(89), 262_144.0);
    let flat = [g, 1., 0., x, 1., 0., 0., 1., 2., -x, 0., 0., -2. * x, 2., 1., 2. * x, 2., 2.];
    let simplices = [4, 3, 0, 2, 4, 2, 0, 5, 4, 0, 1, 5, 3, 2, 1, 0, 2, 0, 5, 1];
    let points = Points::new(&flat, 3).unwrap();
    assert!(check_simplices(&points, &simplices, 4, &Monitor::silent()).is_ok());

    let (y, z, a, b) = (2f64.powi(75), 2f64.powi(74), 2f64.powi(20), 2f64.powi(47));
    let values =
        [[0., 0., 0.], [2. * a, y, y], [a, 0., y], [0., -a, 0.], [0., -z, z], [a, b, a], [a, z, b]];
    let simplices = [4, 3, 0, 5, 4, 0, 2, 5, 0, 5, 6, 2, 0, 6, 1, 2, 5, 6, 2, 1];
    let points = Points::new(values.as_flattened(), 3).unwrap();
    assert!(check_simplices(&points, &simplices, 4, &Monitor::silent()).is_ok());
}

#[test]
fn f32_points_are_read_as_what_they_are() {
    let narrow: Vec<f32> = vec![0.1, 0.2, 0.9, 0.3, 0.5, 0.8, 0.4, 0.4];
    let wide: Vec<f64> = narrow.iter().map(|&x| x.into()).collect();
    let found = solved("narrow", &wide, 2);
    assert!(found.solution.check(&Points::new(&narrow, 2).unwrap()).is_ok());
}

#[test]
fn the_document_is_this_one() {
    let mut found = solved("triangle", &[0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0], 2).solution;
    found.certificate.points_hash = taut_points::PointsHash(0xfeed);
    let text = r#"{
  "schema": 1,
  "kind": "delaunay",
  "answer": {
    "dimension": 2,
    "hull_dimension": 2,
    "simplices": [
      [0, 1, 2]
    ],
    "hull": [
      [1, 2],
      [2, 0],
      [0, 1]
    ],
    "duplicates": [
      [3, 1]
    ]
  },
  "certificate": {
    "neighbors": [
      [-1, -1, -1]
    ],
    "fingerprint": "FINGERPRINT",
    "points_hash": "000000000000feed",
    "counts": {
      "sites": 3,
      "simplices": 1,
      "hull": 3
    }
  },"#;
    let text = text.replace("FINGERPRINT", &found.certificate.fingerprint.to_string());
    assert!(found.to_json().starts_with(&text), "{}", found.to_json());
    for (known, wrong) in [
        ("[0, 1, 2]", "[0, 1]"),
        ("[0, 1, 2]", "[0, 1, 2, 3, 4]"),
        ("[0, 1, 2]", "[0, 1, 4294967296]"),
        ("[1, 2]", "[1, 2, 3]"),
        ("[1, 2]", "[]"),
        ("[3, 1]", "[3]"),
        ("\"hull_dimension\": 2,", ""),
        ("\"hull_dimension\": 2", "\"hull_dimension\": null"),
        ("\"dimension\": 2", "\"note\": 1, \"dimension\": 2"),
        ("\"sites\": 3", "\"note\": 1, \"sites\": 3"),
    ] {
        let other = found.to_json().replacen(known, wrong, 1);
        assert!(AnySolution::from_json(&other).is_err(), "{other}");
    }
}
