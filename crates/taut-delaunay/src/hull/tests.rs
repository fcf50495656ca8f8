use std::collections::BTreeSet;

use taut_points::Points;
use taut_predicates::{Sign, plane, space};

use crate::numbers::numbers;
use crate::{ConvexHull, DelaunayOptions, Plane, Space, convex_hull};

fn hull_of(values: &[f64], dim: usize) -> ConvexHull {
    let points = Points::new(values, dim).expect("whole rows");
    convex_hull(&points, &DelaunayOptions::default()).expect("finite")
}

/// Brute force: no point is beyond a facet, facets close up, and three faces meet in each vertex.
fn check_in_space(values: &[f64]) -> ConvexHull {
    let hull = hull_of(values, 3);
    assert_eq!(hull.hull_dimension, Some(3));
    let points: Vec<[f64; 3]> = values.as_chunks::<3>().0.to_vec();
    let at = |row: u32| points[row as usize];
    let facets: Vec<[u32; 3]> = hull.facets.as_chunks::<3>().0.to_vec();
    for (number, &facet) in facets.iter().enumerate() {
        let [a, b, c] = facet.map(at);
        for &p in &points {
            assert_ne!(space::orient(a, b, c, p), Sign::Positive, "{facet:?} {p:?}");
        }
        for i in 0..3 {
            let other = facets[hull.neighbors[3 * number + i] as usize];
            let (u, v) = (facet[(i + 1) % 3], facet[(i + 2) % 3]);
            assert!((0..3).any(|j| other[(j + 1) % 3] == v && other[(j + 2) % 3] == u));
            let beyond = other.into_iter().find(|w| ![u, v].contains(w)).expect("a third vertex");
            let is_coplanar = space::orient(a, b, c, at(beyond)) == Sign::Zero;
            let is_one_face =
                hull.faces[number] == hull.faces[hull.neighbors[3 * number + i] as usize];
            assert_eq!(is_coplanar, is_one_face);
        }
    }
    let used: BTreeSet<u32> = hull.facets.iter().copied().collect();
    assert_eq!(hull.vertices, used.iter().copied().collect::<Vec<_>>());
    assert_eq!(facets.len(), 2 * hull.vertices.len() - 4);
    for &v in &hull.vertices {
        let faces: BTreeSet<u32> =
            (0..facets.len()).filter(|&f| facets[f].contains(&v)).map(|f| hull.faces[f]).collect();
        assert!(faces.len() >= 3, "{v} is not extreme");
        assert_eq!(points.iter().position(|&p| p == at(v)), Some(v as usize));
    }
    hull
}

#[test]
fn hulls_of_random_points_hold_all() {
    for n in [4, 5, 30, 600, 3000] {
        check_in_space(&numbers(3 * n, n as u64));
    }
}

/// On a sphere every point is extreme, and the hull is that of the triangulation.
#[test]
fn hulls_of_spheres_are_those_of_the_triangulation() {
    let ball: Vec<f64> = numbers(6000, 3)
        .chunks_exact(3)
        .map(|p| [p[0] - 0.5, p[1] - 0.5, p[2] - 0.5])
        .flat_map(|p| {
            let length = (p[0] * p[0] + p[1] * p[1] + p[2] * p[2]).sqrt();
            p.map(|x| x / length)
        })
        .collect();
    let hull = check_in_space(&ball);
    let points = Points::new(&ball, 3).expect("whole rows");
    let space = Space::build(&points, &DelaunayOptions::default()).expect("finite");
    let sorted = |mut facet: [u32; 3]| {
        facet.sort_unstable();
        facet
    };
    let expected: BTreeSet<[u32; 3]> =
        space.hull().map(|facet| sorted(facet.map(|site| space.row(site)))).collect();
    let found = hull.facets.as_chunks::<3>().0.iter().map(|&facet| sorted(facet)).collect();
    assert_eq!(expected, found);
}

/// Faces with points within them and within their edges, each point twice, and in an order that is no order.
#[test]
fn only_corners_of_grids_are_extreme() {
    for steps in [2u32, 3, 9] {
        let count = steps.pow(3);
        let grid: Vec<f64> = (0..2 * count)
            .map(|i| i * 7919 % count)
            .flat_map(|i| [i % steps, i / steps % steps, i / steps / steps].map(f64::from))
            .collect();
        let hull = check_in_space(&grid);
        assert_eq!((hull.vertices.len(), hull.facets.len()), (8, 36));
        assert_eq!(hull.faces.iter().max(), Some(&5));
    }
}

#[test]
fn integers_with_many_ties_are_solved_exactly() {
    for seed in 0..30 {
        let size = [3.0, 5.0, 9.0][seed as usize % 3];
        let small: Vec<f64> = numbers(120, seed).iter().map(|x| (x * size).floor()).collect();
        check_in_space(&small);
        let more: Vec<f64> = numbers(1800, seed).iter().map(|x| (x * size).floor()).collect();
        check_in_space(&more);
    }
}

#[test]
fn scales_do_not_matter() {
    let values = numbers(3000, 8);
    let expected = hull_of(&values, 3);
    for scale in [2f64.powi(-1000), 2f64.powi(-60), 2f64.powi(60), 2f64.powi(1000)] {
        let scaled: Vec<f64> = values.iter().map(|x| x * scale).collect();
        assert_eq!(hull_of(&scaled, 3), expected, "{scale}");
    }
}

#[test]
fn flat_sets_are_polygons_segments_and_points() {
    let square =
        [0.0, 0.0, 1.0, 2.0, 0.0, 1.0, 2.0, 2.0, 1.0, 0.0, 2.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0.0, 1.0];
    let hull = hull_of(&square, 3);
    assert_eq!((hull.hull_dimension, hull.vertices), (Some(2), vec![0, 1, 2, 3]));
    // Points of a plane that lies along the last axis.
    let wall: Vec<f64> =
        numbers(2000, 4).chunks_exact(2).flat_map(|p| [p[0], p[0], p[1]]).collect();
    let shadow: Vec<f64> = wall.chunks_exact(3).flat_map(|p| [p[0], p[2]]).collect();
    let (hull, expected) = (hull_of(&wall, 3), hull_of(&shadow, 2));
    assert_eq!((hull.vertices, hull.facets), (expected.vertices, expected.facets));
    let line: Vec<f64> = (0..1000u32).flat_map(|i| [f64::from(i * 37 % 1000); 3]).collect();
    let hull = hull_of(&line, 3);
    assert_eq!((hull.hull_dimension, hull.vertices), (Some(1), vec![0, 27]));
    assert_eq!(hull_of(&[1.0; 9], 3).vertices, [0]);
    assert_eq!(hull_of(&[], 3), ConvexHull { dimension: 3, ..ConvexHull::default() });
}

#[test]
fn polygons_are_those_of_the_triangulation() {
    for n in [3, 10, 400, 5000] {
        let values = numbers(2 * n, n as u64);
        let hull = hull_of(&values, 2);
        let points = Points::new(&values, 2).expect("whole rows");
        let plane = Plane::build(&points, &DelaunayOptions::default()).expect("finite");
        let expected: BTreeSet<[u32; 2]> =
            plane.hull().map(|facet| facet.map(|site| plane.row(site))).collect();
        let edges = hull.facets.as_chunks::<2>().0;
        assert_eq!(edges.iter().copied().collect::<BTreeSet<_>>(), expected);
        let at = |row: u32| [values[2 * row as usize], values[2 * row as usize + 1]];
        for (number, edge) in edges.iter().enumerate() {
            let next = edges[hull.neighbors[2 * number] as usize];
            assert_eq!(edge[1], next[0]);
            assert_eq!(plane::orient(at(edge[0]), at(edge[1]), at(next[1])), Sign::Positive);
        }
    }
    let grid: Vec<f64> = (0..2500u32).flat_map(|i| [i % 50, i / 50].map(f64::from)).collect();
    assert_eq!(hull_of(&grid, 2).vertices, [0, 49, 2499, 2450]);
    assert_eq!(hull_of(&[0.0, 0.0, 1.0, 1.0, 3.0, 3.0, 2.0, 2.0], 2).vertices, [0, 2]);
}

/// The extremes that the filter is made of lie on a line, and the rest is close to it.
#[test]
fn nearly_flat_sets_are_solved_exactly() {
    let thin: Vec<f64> = numbers(3000, 5)
        .chunks_exact(3)
        .flat_map(|p| [p[0], p[0] + 1e-15 * p[1], p[0] - 1e-15 * p[2]])
        .collect();
    check_in_space(&thin);
}

#[test]
fn wrong_input_is_named() {
    let points = Points::new(&[0.0, 1.0, f64::NAN], 3).expect("whole rows");
    let refused = convex_hull(&points, &DelaunayOptions::default());
    assert!(refused.is_err_and(|error| error.to_string().contains("coordinate 2 of point 0")));
    let points = Points::new(&[0.0; 8], 4).expect("whole rows");
    assert!(convex_hull(&points, &DelaunayOptions::default()).is_err());
}
