//! The checker of surfaces against brute force in exact arithmetic: balls, crossings, insides, topology.

use proptest::collection::vec;
use proptest::prelude::*;
use surface::{Case, Point, oracle};
use taut_certify::{Apex, SurfaceViolation, Violation};

use crate::surface;

/// Places on a small grid, all different, each coordinate moved by an ulp or not.
fn places(count: std::ops::Range<usize>, side: i32) -> impl Strategy<Value = Vec<Point>> {
    let cell = (0..side, prop_oneof![4 => Just(0i64), 1 => -1i64..2]);
    (vec([cell.clone(), cell.clone(), cell], count), any::<bool>(), -3i32..4).prop_map(
        |(cells, is_moved, power)| {
            let mut places: Vec<Point> = vec![];
            for cell in cells {
                let place = cell.map(|(cell, ulps)| {
                    let x = (f64::from(cell) * 0.125 + 1.0) * 2f64.powi(power * 150);
                    if is_moved { f64::from_bits((x.to_bits() as i64 + ulps) as u64) } else { x }
                });
                if !places.contains(&place) {
                    places.push(place);
                }
            }
            places
        },
    )
}

/// Different triangles of different rows.
fn triangles(rows: usize, numbers: &[usize]) -> Vec<[u32; 3]> {
    let mut triangles: Vec<[u32; 3]> = vec![];
    for three in numbers.as_chunks::<3>().0 {
        let [a, b, c] = three.map(|number| (number % rows) as u32);
        let is_new = triangles.iter().all(|t| ![a, b, c].iter().all(|row| t.contains(row)));
        if a != b && b != c && c != a && is_new {
            triangles.push([a, b, c]);
        }
    }
    triangles
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: crate::test_length::long_or(1500, 600), ..ProptestConfig::default() })]

    /// Each ball of a triangle is accepted just where exact arithmetic finds it empty.
    #[test]
    fn balls_are_empty_where_exact_arithmetic_says_so(
        places in places(4..12, 4), left_out in vec(any::<bool>(), 12), numbers in vec(0usize..100, 3),
    ) {
        let Some(&triangle) = triangles(places.len(), &numbers).first() else { return Ok(()) };
        let mut case = Case::of(places.clone(), vec![triangle]);
        let rows = 0..places.len() as u32;
        let is_outlier = |&row: &u32| left_out[row as usize] && !triangle.contains(&row);
        case.answer().unused.outliers = rows.clone().filter(is_outlier).collect();
        case.fit();
        let sites: Vec<u32> = rows.clone().filter(|row| !is_outlier(row)).collect();
        let is_flat = !oracle::is_embedded(&places, &[triangle]);
        (case.certificate().embedded, case.certificate().outward) = (!is_flat, !is_flat);
        for apex in rows.map(Apex::Row).chain([Apex::Hull, Apex::Gabriel]) {
            case.certificate().apexes = vec![apex];
            let expected = oracle::is_empty(&places, &sites, triangle, apex);
            match case.check() {
                Ok(verdict) => prop_assert!(expected && verdict.is_delaunay, "{apex:?}"),
                Err(Violation::Surface(violation)) => {
                    let is_of_balls = matches!(
                        violation,
                        SurfaceViolation::Ball { .. } | SurfaceViolation::Hull { .. } | SurfaceViolation::NoBall { .. }
                    );
                    prop_assert!(!expected && is_of_balls, "{apex:?}: {violation}");
                }
                Err(other) => prop_assert!(false, "{other}"),
            }
        }
    }

    /// A soup of triangles is embedded just where exact arithmetic says so, and its topology is that of another crate.
    #[test]
    fn soups_meet_where_exact_arithmetic_says_so(
        places in places(3..9, 3), numbers in vec(0usize..100, 3..18),
    ) {
        let triangles = triangles(places.len(), &numbers);
        let embedded = oracle::is_embedded(&places, &triangles);
        let mut case = Case::of(places, triangles);
        case.certificate().apexes = vec![];
        case.certificate().embedded = embedded;
        let topology = &case.solution.answer.topology;
        let (is_surface, is_oriented) = (topology.is_manifold(), topology.is_oriented());
        case.certificate().outward = embedded && is_surface && is_oriented;
        match case.check() {
            Ok(verdict) => {
                prop_assert_eq!(verdict.is_embedded, embedded);
                prop_assert_eq!((verdict.is_manifold, verdict.is_oriented), (is_surface, is_oriented));
            }
            // A small closed surface may face inwards.
            Err(violation) => {
                let is_facing = matches!(violation, Violation::Surface(SurfaceViolation::NotOutward { .. }));
                prop_assert!(is_facing && case.certificate().outward, "{violation}");
            }
        }
        case.certificate().embedded = !embedded;
        case.certificate().outward = false;
        prop_assert!(case.check().is_err());
    }

    /// A tetrahedron faces outwards or not, and a point is inside, on it or outside.
    #[test]
    fn insides_are_those_of_exact_arithmetic(places in places(5..8, 4), turned in any::<bool>()) {
        let [a, b, c, d] = [0, 1, 2, 3];
        let mut sides = vec![[a, c, b], [a, b, d], [b, c, d], [c, a, d]];
        if turned {
            sides.iter_mut().for_each(|t| t.swap(0, 1));
        }
        if places.len() < 5 || !oracle::is_embedded(&places, &sides) {
            return Ok(());
        }
        let corners = [0, 1, 2, 3].map(|k: usize| places[k]);
        let mut case = Case::of(places.clone(), sides).closed();
        case.certificate().apexes = vec![];
        let is_outward = case.check().is_ok();
        case.answer().triangles.iter_mut().for_each(|t| t.swap(0, 1));
        prop_assert_eq!(case.check().is_err(), is_outward);
        case.certificate().outward = !is_outward;
        for row in 4..places.len() as u32 {
            let place = oracle::place_in_tetrahedron(&corners, &places[row as usize]);
            case.answer().unused.interior = vec![row];
            case.fit();
            match (case.check(), place) {
                (Ok(_), 1) => {}
                (Err(Violation::Surface(SurfaceViolation::Interior { problem, .. })), 0) => {
                    prop_assert_eq!(problem, "lies on the surface");
                }
                (Err(Violation::Surface(SurfaceViolation::Interior { problem, .. })), -1) => {
                    prop_assert_eq!(problem, "lies outside of the closed components");
                }
                (other, _) => prop_assert!(false, "{other:?} at {place}"),
            }
        }
    }
}

/// Rational arithmetic on its own: shapes of which everything is known.
#[test]
fn exact_arithmetic_knows_what_is_known() {
    let cube = surface::cube();
    let (rows, triangles) = (&cube.rows, &cube.solution.answer.triangles);
    assert!(oracle::is_embedded(rows, triangles));
    let sites: Vec<u32> = (0..8).collect();
    for (&triangle, &apex) in triangles.iter().zip(&cube.solution.certificate.apexes) {
        assert!(oracle::is_empty(rows, &sites, triangle, apex));
    }
    assert!(!oracle::is_empty(rows, &sites, [0, 3, 5], Apex::Hull));
    assert!(!oracle::is_empty(rows, &sites, [0, 1, 3], Apex::Row(2)));
    assert!(!oracle::is_embedded(rows, &[[0, 3, 5], [1, 2, 4]]));
    assert!(!oracle::is_embedded(rows, &[[0, 1, 3], [0, 1, 2]]));
    assert!(oracle::is_embedded(rows, &[[0, 1, 3], [0, 1, 4]]));
    let corners = [rows[0], rows[1], rows[2], rows[4]];
    for (q, place) in [([0.1, 0.1, 0.1], 1), ([0.5, 0.5, 0.0], 0), ([1.0, 1.0, 1.0], -1)] {
        assert_eq!(oracle::place_in_tetrahedron(&corners, &q), place);
    }
}
