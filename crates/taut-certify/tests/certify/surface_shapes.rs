//! Known surfaces: what is true of them is confirmed, and what keeps one from being certified is named.

use surface::{Case, band, both, cube, reversed, sphere, tetrahedron, torus};
use taut_certify::{
    AnySolution, AnyVerdict, Apex, SurfaceDoubt, SurfaceMode, SurfaceViolation, Violation,
};
use taut_points::{Monitor, Points};

use crate::surface;

#[test]
fn known_surfaces_are_certified() {
    let nested = both(&sphere([0.0; 3], 4.0, 2), &reversed(sphere([0.5, 0.25, 0.0], 1.5, 2)));
    let thrice = both(&nested, &sphere([0.5, 0.25, 0.0], 0.5, 2));
    for (name, case, components, genus) in [
        ("tetrahedron", tetrahedron(), 1, 0),
        ("cube", cube(), 1, 0),
        ("cube at 1e150", cube().scaled(1e150), 1, 0),
        ("cube at 1e-150", cube().scaled(1e-150), 1, 0),
        ("sphere", sphere([3.0, 1.0, 7.0], 0.1, 3), 1, 0),
        ("two spheres", nested, 2, 0),
        ("three spheres", thrice, 3, 0),
    ] {
        let verdict = case.check().unwrap_or_else(|e| panic!("{name}: {e}"));
        assert_eq!(verdict.doubt, None, "{name}");
        assert!(verdict.certified && verdict.is_closed && verdict.is_delaunay, "{name}");
        assert_eq!((verdict.components, verdict.genus), (components, Some(genus)), "{name}");
    }
}

#[test]
fn handles_and_loops_are_counted() {
    let verdict = torus(24, 16).check().unwrap();
    assert_eq!((verdict.genus, verdict.boundary_loops), (Some(1), 0));
    assert!(verdict.is_closed && verdict.is_embedded && verdict.is_outward && !verdict.certified);
    assert_eq!(verdict.doubt, Some(SurfaceDoubt::NoBalls));
    let verdict = band(24, false).check().unwrap();
    assert_eq!((verdict.genus, verdict.boundary_loops), (Some(0), 2));
    assert!(!verdict.is_closed);
}

#[test]
fn a_band_with_one_side_is_named() {
    let mut case = band(24, true);
    assert_eq!(case.answer().topology.genus, None);
    assert!(matches!(
        case.violation(),
        SurfaceViolation::NotOutward { doubt: SurfaceDoubt::OneSided { component: 0 } }
    ));
    case.certificate().outward = false;
    let verdict = case.check().unwrap();
    assert_eq!(verdict.doubt, Some(SurfaceDoubt::OneSided { component: 0 }));
    assert!(
        !verdict.certified && verdict.is_manifold && verdict.is_embedded && verdict.is_delaunay
    );
    case.answer().topology.components[0].orientable = true;
    assert!(matches!(case.violation(), SurfaceViolation::Topology { .. }));
}

#[test]
fn what_faces_the_wrong_way_is_named() {
    let (outer, inner) = (sphere([0.0; 3], 4.0, 2), sphere([0.5, 0.25, 0.0], 1.5, 2));
    for (case, component, depth) in [
        (reversed(outer.clone()), 0, 0),
        (both(&outer, &inner), 1, 1),
        (both(&inner, &outer), 0, 1),
        (both(&outer, &reversed(sphere([9.0, 0.0, 0.0], 1.0, 2))), 1, 0),
        (reversed(cube()).scaled(1e-150), 0, 0),
    ] {
        let expected = SurfaceDoubt::Inward { component, depth };
        let mut case = case;
        case.certificate().apexes = vec![];
        assert!(
            matches!(case.violation(), SurfaceViolation::NotOutward { doubt } if doubt == expected)
        );
        case.certificate().outward = false;
        assert_eq!(case.check().unwrap().doubt, Some(expected));
    }
    let mut fine = outer;
    fine.certificate().outward = false;
    assert_eq!(fine.violation(), SurfaceViolation::Outward);
}

/// Two tetrahedra with the vertices that are given for the second.
fn joined(second: [u32; 4]) -> Case {
    let mut rows = vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    rows.extend([[-1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]]);
    let sides = |[a, b, c, d]: [u32; 4]| [[a, c, b], [a, b, d], [b, c, d], [c, a, d]];
    let triangles = sides([0, 1, 2, 3]).into_iter().chain(sides(second)).collect();
    let mut case = Case::of(rows, triangles).closed();
    // The triangle opposite the origin is on the hull.
    [2, 6].into_iter().for_each(|triangle| case.certificate().apexes[triangle] = Apex::Hull);
    case
}

#[test]
fn what_is_no_manifold_is_named() {
    // 0 alone in common, and the edge from 0 to 1.
    let mut pinched = joined([0, 4, 6, 5]);
    pinched.certificate().outward = false;
    let verdict = pinched.check().unwrap();
    assert_eq!(verdict.doubt, Some(SurfaceDoubt::NonManifoldVertex { row: 0, fans: 2 }));
    assert!(verdict.is_embedded && verdict.is_delaunay && !verdict.certified);
    let mut edge = joined([0, 1, 5, 6]);
    edge.certificate().outward = false;
    let verdict = edge.check().unwrap();
    let expected = SurfaceDoubt::NonManifoldEdge { edge: [0, 1], triangles: 4 };
    assert_eq!(verdict.doubt, Some(expected));
    edge.certificate().outward = true;
    assert!(
        matches!(edge.violation(), SurfaceViolation::NotOutward { doubt } if doubt == expected)
    );
}

#[test]
fn a_triangle_turned_over_is_named() {
    let mut case = cube();
    case.answer().triangles[5].swap(0, 1);
    assert!(matches!(case.violation(), SurfaceViolation::Topology { .. }));
    case.topology();
    case.certificate().outward = false;
    let Some(SurfaceDoubt::NotOriented { triangles }) = case.check().unwrap().doubt else {
        panic!()
    };
    assert!(triangles.contains(&5));
}

#[test]
fn a_missing_triangle_leaves_a_loop() {
    let mut case = cube();
    case.answer().triangles.remove(4);
    case.certificate().apexes.remove(4);
    assert!(matches!(case.violation(), SurfaceViolation::Topology { .. }));
    case.topology();
    assert!(matches!(case.violation(), SurfaceViolation::Open { .. }));
    case.certificate().mode = SurfaceMode::Open;
    let verdict = case.check().unwrap();
    assert_eq!((verdict.boundary_loops, verdict.certified), (1, true));
}

#[test]
fn a_triangle_given_twice_is_named() {
    let mut case = cube();
    let [a, b, c] = case.answer().triangles[7];
    case.answer().triangles.push([c, b, a]);
    case.certificate().apexes.push(Apex::Hull);
    case.topology();
    assert_eq!(case.violation(), SurfaceViolation::Twice { triangle: 12, first: 7 });
}

#[test]
fn rows_inside_are_told_from_those_outside() {
    let sphere = sphere([0.0; 3], 2.0, 2);
    let with = |row: [f64; 3]| {
        let mut case = sphere.clone();
        case.rows.push(row);
        let number = case.rows.len() as u32 - 1;
        case.answer().unused.interior = vec![number];
        case.fit();
        case
    };
    assert!(with([0.25, 0.0, 0.5]).check().unwrap().certified);
    // Level with vertices and edges, whichever way the ray goes.
    assert!(with([0.0; 3]).check().unwrap().certified);
    let problem = |row| match with(row).violation() {
        SurfaceViolation::Interior { problem, .. } => problem,
        other => panic!("{other}"),
    };
    assert_eq!(problem([-3.0, 0.0, 0.0]), "lies outside of the closed components");
    // The middle of an edge, exactly, is not empty of the ball: so no balls are claimed.
    let mut on = cube();
    on.rows.push([0.5, 0.0, 0.25]);
    on.answer().unused.interior = vec![8];
    on.certificate().apexes = vec![];
    on.fit();
    let expected = SurfaceViolation::Interior { row: 8, problem: "lies on the surface" };
    assert_eq!(on.violation(), expected);
}

#[test]
fn a_point_inside_a_ball_by_one_ulp_is_found() {
    // The sphere of the cube passes (0.5, 0.5, 0.5 + √3/2), which is no f64; that of (3, 4, 0) and its like passes the
    // integer point (0, 0, 5) exactly.
    let rows = vec![[3.0, 4.0, 0.0], [-4.0, 3.0, 0.0], [0.0, -5.0, 0.0], [0.0, 0.0, -5.0]];
    let sides = vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    let with = |z: f64| {
        let mut rows = rows.clone();
        rows.push([0.0, 0.0, z]);
        let mut case = Case::of(rows, sides.clone());
        case.certificate().outward = false;
        case.certificate().apexes = vec![Apex::Row(3), Apex::Row(2), Apex::Row(0), Apex::Row(1)];
        case
    };
    assert!(with(5.0).check().unwrap().is_delaunay);
    assert!(with(5.0f64.next_up()).check().unwrap().is_delaunay);
    let expected = SurfaceViolation::Ball { triangle: 0, ball: "through its apex", row: 4 };
    assert_eq!(with(5.0f64.next_down()).violation(), expected);
    for factor in [498, -498, -1000].map(|k| 2f64.powi(k)) {
        assert!(with(5.0).scaled(factor).check().unwrap().is_delaunay);
        assert_eq!(with(5.0f64.next_down()).scaled(factor).violation(), expected);
    }
}

#[test]
fn coordinates_of_all_sizes_are_judged() {
    // Beside a cube a point so far or so near to 0 that nothing but whole numbers tells its sides.
    for far in [[1e300, -1e300, 1e300], [-5e-324, -5e-324, -5e-324], [-1e-300, 1e200, 3.0]] {
        let mut case = cube();
        case.rows.push(far);
        case.fit();
        if far[1] > 0.0 {
            case.certificate().apexes.fill(Apex::Gabriel);
        }
        match case.check() {
            Ok(verdict) => assert!(verdict.certified, "{far:?}"),
            // Facets of the hull are none once there is a point beyond them.
            Err(violation) => {
                assert!(
                    matches!(
                        violation,
                        Violation::Surface(
                            SurfaceViolation::Hull { .. } | SurfaceViolation::Ball { .. }
                        )
                    ),
                    "{violation}"
                );
                case.certificate().apexes.fill(Apex::Gabriel);
                assert!(case.check().unwrap().certified, "{far:?}");
            }
        }
    }
}

#[test]
fn pairs_that_meet_are_found() {
    let base = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];
    for (name, other) in [
        ("crossing", [[1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [9.0, 1.0, 0.0]]),
        ("touching in a point", [[1.0, 1.0, 0.0], [1.0, 1.0, 1.0], [2.0, 1.0, 1.0]]),
        ("touching at a vertex", [[0.0, 0.0, 0.0], [1.0, 1.0, 1.0], [2.0, 1.0, 1.0]]),
        ("overlapping in the plane", [[1.0, 1.0, 0.0], [5.0, 1.0, 0.0], [1.0, 5.0, 0.0]]),
        ("within, in the plane", [[0.5, 0.5, 0.0], [1.0, 0.5, 0.0], [0.5, 1.0, 0.0]]),
        ("along an edge", [[1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 0.0, 3.0]]),
    ] {
        let mut rows = base.to_vec();
        rows.extend(other);
        let mut case = Case::of(rows, vec![[0, 1, 2], [3, 4, 5]]);
        case.certificate().apexes = vec![];
        if name == "touching at a vertex" {
            // Equal places are duplicates, which no triangle names.
            let listed = case.violation();
            assert!(matches!(listed, SurfaceViolation::Unused { .. }), "{listed}");
            continue;
        }
        let doubt = SurfaceDoubt::Crossing { triangles: [0, 1] };
        assert_eq!(case.violation(), SurfaceViolation::NotEmbedded { doubt }, "{name}");
        case.certificate().embedded = false;
        assert_eq!(case.violation(), SurfaceViolation::NotOutward { doubt }, "{name}");
        case.certificate().outward = false;
        let verdict = case.check().unwrap();
        assert_eq!((verdict.doubt, verdict.is_embedded), (Some(doubt), false), "{name}");
    }
}

#[test]
fn flat_triangles_are_named() {
    let rows = vec![[0.0; 3], [1.0, 1.0, 1.0], [3.0, 3.0, 3.0]];
    let mut case = Case::of(rows, vec![[0, 1, 2]]);
    let doubt = SurfaceDoubt::Flat { triangle: 0 };
    assert_eq!(case.violation(), SurfaceViolation::NotEmbedded { doubt });
    (case.certificate().embedded, case.certificate().outward) = (false, false);
    let problem = "it is flat";
    assert_eq!(case.violation(), SurfaceViolation::NoBall { triangle: 0, problem });
    case.certificate().apexes = vec![];
    assert_eq!(case.check().unwrap().doubt, Some(doubt));
}

#[test]
fn circles_are_measured_against_the_radius_exactly() {
    // A right triangle: half of its longest side, 5.
    let rows = vec![[0.0; 3], [6.0, 0.0, 0.0], [0.0, 8.0, 0.0]];
    for factor in [1.0, 2f64.powi(500), 2f64.powi(-520)] {
        let with = |radius: f64| {
            let mut case = Case::of(rows.clone(), vec![[0, 1, 2]]).scaled(factor);
            case.certificate().mode = SurfaceMode::Alpha { radius };
            case
        };
        let radius = 5.0 * factor;
        assert!(with(radius).check().is_ok() && with(radius.next_up()).check().is_ok());
        assert!(with(f64::MAX).check().is_ok());
        for radius in [radius.next_down(), 0.0, f64::MIN_POSITIVE / 4.0] {
            let expected = SurfaceViolation::Radius { triangle: 0, radius };
            assert_eq!(with(radius).violation(), expected);
        }
    }
}

#[test]
fn moved_points_are_judged_in_their_new_places() {
    let mut case = cube();
    case.answer().vertices = case.rows.iter().map(|p| [p[0] + 0.25, p[1], p[2]]).collect();
    assert!(matches!(case.violation(), SurfaceViolation::Displacement { .. }));
    case.certificate().displacement = 0.25;
    let verdict = case.check().unwrap();
    assert!(verdict.certified && (0.25..0.250001).contains(&verdict.displacement));
    case.answer().vertices[7] = [0.5, 0.5, 0.75];
    case.certificate().displacement = 0.5f64.hypot(0.5).hypot(0.25);
    assert!(case.check().is_err());
    case.answer().vertices[7][2] = f64::NAN;
    assert!(matches!(case.check(), Err(Violation::Number { .. })));
    case.answer().vertices.pop();
    assert!(matches!(case.check(), Err(Violation::Length { .. })));
}

#[test]
fn balls_may_hold_outliers_and_nothing_else() {
    let mut case = cube();
    case.certificate().apexes.fill(Apex::Gabriel);
    case.rows.push([0.5, 0.5, 0.25]);
    case.fit();
    assert!(matches!(case.violation(), SurfaceViolation::Ball { row: 8, .. }));
    case.answer().unused.outliers = vec![8];
    case.fit();
    let verdict = case.check().unwrap();
    assert_eq!((verdict.outliers, verdict.certified), (1, true));
}

#[test]
fn nothing_is_a_surface_too() {
    for rows in [vec![], vec![[1.0; 3], [1.0; 3]]] {
        let case = Case::of(rows, vec![]).closed();
        let verdict = case.check().unwrap();
        assert_eq!((verdict.doubt, verdict.certified), (Some(SurfaceDoubt::Empty), false));
    }
}

#[test]
fn documents_survive_the_way_through_json() {
    let mut moved = cube();
    moved.answer().vertices = moved.rows.clone();
    let mut alpha = tetrahedron();
    alpha.certificate().mode = SurfaceMode::Alpha { radius: 0.9 };
    for case in [cube(), tetrahedron(), moved, alpha, Case::of(vec![], vec![])] {
        let text = case.solution.to_json();
        let read = AnySolution::from_json(&text).unwrap();
        assert_eq!(read, AnySolution::Surface(case.solution.clone()));
        assert_eq!(read.to_json(), text);
        let points = Points::new(case.rows.as_flattened(), 3).unwrap();
        let verdict = read.check(&points, &Monitor::silent()).unwrap();
        assert_eq!(verdict, AnyVerdict::Surface(case.check().unwrap()));
    }
    let text = tetrahedron().solution.to_json();
    for (from, to) in [
        ("\"closed\"", "\"shut\""),
        ("    -2\n", "    -3\n"),
        ("    -2\n", "    4294967296\n"),
        ("\"embedded\": true,", ""),
        ("\"duplicates\": [],", ""),
        ("\"tree\"", "\"guess\""),
        ("\"closed\"", "{\"alpha\": {\"radius\": 9, \"more\": 1}}"),
        ("\"closed\"", "{\"alpha\": {}}"),
        ("      \"genus\": 0,\n      \"components\"", "      \"components\""),
    ] {
        assert!(text.contains(from), "{from}");
        assert!(AnySolution::from_json(&text.replacen(from, to, 1)).is_err(), "{from}");
    }
}

/// The violation named is that of the first triangle, whichever thread finds one.
#[test]
fn the_first_violation_is_named_for_any_number_of_threads() {
    let mut case = sphere([0.0; 3], 1.0, 5);
    for k in 0..40 {
        case.rows.push(
            case.rows[case.solution.answer.triangles[k * 97 + 11][0] as usize].map(|x| 0.999 * x),
        );
    }
    case.fit();
    let judge = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| case.violation())
    };
    let expected = judge(1);
    assert!(matches!(expected, SurfaceViolation::Ball { .. }), "{expected}");
    assert_eq!((judge(2), judge(8)), (expected.clone(), expected));
}
