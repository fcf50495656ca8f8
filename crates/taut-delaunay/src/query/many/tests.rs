use std::collections::BTreeSet;

use taut_points::{InputError, Monitor, Points};

use super::{NOWHERE, TriangulationIndex};
use crate::numbers::numbers;
use crate::{DelaunayOptions, Error, Location, Plane, Space};

fn plane(values: &[f64]) -> TriangulationIndex<2, 3> {
    let points = Points::new(values, 2).expect("whole rows");
    Plane::build(&points, &DelaunayOptions::default()).expect("finite").into()
}

fn space(values: &[f64]) -> TriangulationIndex<3, 4> {
    let points = Points::new(values, 3).expect("whole rows");
    Space::build(&points, &DelaunayOptions::default()).expect("finite").into()
}

/// The number of the simplex that a single question finds.
macro_rules! single {
    ($index:expr, $point:expr) => {
        match $index.triangulation().locator().locate($point) {
            Location::Inside(slot) => slot,
            _ => NOWHERE,
        }
    };
}

#[test]
fn many_answers_are_those_of_single_questions() {
    let index = plane(&numbers(4000, 1));
    let queries: Vec<f64> = numbers(6000, 2).iter().map(|x| x * 1.2 - 0.1).collect();
    let queries = Points::new(&queries, 2).expect("whole rows");
    let found = index.locate(&queries, &Monitor::silent()).expect("not stopped");
    let nearest = index.nearest(&queries, &Monitor::silent()).expect("not stopped");
    let locator = index.triangulation().locator();
    for ((q, simplex), row) in queries.rows().zip(found).zip(nearest) {
        assert_eq!(simplex, single!(index, [q[0], q[1]]));
        let site = locator.nearest([q[0], q[1]]).expect("there are sites");
        assert_eq!(row, index.triangulation().row(site));
    }
    let index = space(&numbers(3000, 3));
    let queries = numbers(3000, 4);
    let queries = Points::new(&queries, 3).expect("whole rows");
    let found = index.locate(&queries, &Monitor::silent()).expect("not stopped");
    for (q, simplex) in queries.rows().zip(found) {
        assert_eq!(simplex, single!(index, [q[0], q[1], q[2]]));
    }
}

#[test]
fn points_of_another_dimension_are_refused() {
    let (index, silent) = (plane(&numbers(40, 1)), Monitor::silent());
    let values = vec![0.0; index.triangulation().site_count()];
    for dim in [1, 3] {
        let numbers = numbers(30_000, 2);
        let points = Points::new(&numbers, dim).expect("whole rows");
        let refused = |result: Option<Error>| {
            let is_refused = |error| match error {
                Error::Input(InputError::Dimension { dim: found, .. }) => found == dim,
                _ => false,
            };
            assert!(result.is_some_and(is_refused), "{dim}");
        };
        refused(index.locate(&points, &silent).err());
        refused(index.nearest(&points, &silent).err());
        refused(index.natural_coordinates(&points, &silent).err());
        refused(index.interpolate(&values, &points, &silent).err());
    }
    let points = Points::new(&[0.0, 0.0], 2).expect("whole rows");
    assert!(space(&numbers(60, 1)).locate(&points, &silent).is_err());
    assert!(plane(&[]).locate(&Points::new(&[0.0], 1).expect("whole rows"), &silent).is_err());
}

/// Points along a curve, which are answered as they come, and the same points shuffled, which are sorted.
#[test]
fn the_order_of_points_does_not_matter() {
    let index = space(&numbers(3000, 5));
    let curve = |i: u32| {
        let t = f64::from(i) * 1e-3;
        [0.5 + 0.6 * t.sin(), 0.5 + 0.4 * (1.7 * t).cos(), 0.1 + 0.08 * t]
    };
    const COUNT: u32 = 10_007;
    let in_order: Vec<f64> = (0..COUNT).flat_map(curve).collect();
    let shuffled: Vec<f64> = (0..COUNT).flat_map(|i| curve(i * 4099 % COUNT)).collect();
    let [in_order, shuffled] = [&in_order, &shuffled].map(|values| {
        let points = Points::new(values, 3).expect("whole rows");
        index.locate(&points, &Monitor::silent()).expect("not stopped")
    });
    let inside = in_order.iter().filter(|&&number| number != NOWHERE).count();
    assert!(inside > 3000 && inside < 9000, "{inside}");
    for (i, &number) in (0..COUNT).zip(&shuffled) {
        assert_eq!(number, in_order[(i * 4099 % COUNT) as usize]);
    }
}

/// A point on the boundary of several simplices is in the lowest, whatever else is asked.
#[test]
fn ties_go_to_the_lowest_simplex() {
    let grid: Vec<f64> = (0..216).flat_map(|i| [i % 6, i / 6 % 6, i / 36].map(f64::from)).collect();
    let index = space(&grid);
    let halves: Vec<f64> = (0..1331)
        .flat_map(|i| [i % 11, i / 11 % 11, i / 121].map(|x| 0.5 * f64::from(x)))
        .collect();
    let queries = Points::new(&halves, 3).expect("whole rows");
    let found = index.locate(&queries, &Monitor::silent()).expect("not stopped");
    for (q, &simplex) in halves.chunks_exact(3).zip(&found) {
        let alone = Points::new(q, 3).expect("one row");
        assert_eq!(index.locate(&alone, &Monitor::silent()).expect("not stopped"), [simplex]);
        let corners = |number: u32| {
            let vertices = index.triangulation().vertices(number);
            vertices.map(|v| index.triangulation().site(v))
        };
        let holds = |number: u32| {
            (0..4).all(|i| {
                let mut with_q = corners(number);
                with_q[i] = [q[0], q[1], q[2]];
                !taut_predicates::space::orient(with_q[0], with_q[1], with_q[2], with_q[3])
                    .is_negative()
            })
        };
        assert_eq!(index.slots().find(|&number| holds(number)), Some(simplex));
    }
    let outside = [9.0, 0.0, 0.0, f64::NAN, 0.0, 0.0];
    let outside = Points::new(&outside, 3).expect("whole rows");
    assert_eq!(index.locate(&outside, &Monitor::silent()).expect("not stopped"), [NOWHERE; 2]);
}

#[test]
fn groups_of_grids_are_cubes() {
    let grid: Vec<f64> = (0..64).flat_map(|i| [i % 4, i / 4 % 4, i / 16].map(f64::from)).collect();
    let groups: BTreeSet<u32> = space(&grid).cospherical_groups().into_iter().collect();
    assert_eq!(groups.len(), 27);
    let squares: BTreeSet<u32> =
        plane(&(0..25).flat_map(|i| [i % 5, i / 5].map(f64::from)).collect::<Vec<_>>())
            .cospherical_groups()
            .into_iter()
            .collect();
    assert_eq!(squares.len(), 16);
    let general = space(&numbers(600, 9)).cospherical_groups();
    assert!(general.iter().enumerate().all(|(number, &group)| number == group as usize));
}

/// The corners of finite regions are those of the cells clipped to a box that holds them.
#[test]
fn regions_are_the_cells() {
    let values = numbers(1000, 6);
    let index = plane(&values);
    let diagram = index.voronoi();
    let locator = index.triangulation().locator();
    let sites = index.triangulation().sites_of_rows();
    let mut finite = 0;
    for (region, &row) in diagram.region_rows.iter().enumerate() {
        let range =
            diagram.region_starts[region] as usize..diagram.region_starts[region + 1] as usize;
        let corners = &diagram.region_vertices[range];
        if corners.contains(&u32::MAX) {
            continue;
        }
        finite += 1;
        let cell = locator.voronoi_cell(sites[row as usize], [-1e6; 2], [1e6; 2]);
        let area = |corners: &[[f64; 2]]| {
            let n = corners.len();
            let term = |i: usize| {
                let ([a, b], [c, d]) = (corners[i], corners[(i + 1) % n]);
                a * d - b * c
            };
            0.5 * (0..n).map(term).sum::<f64>()
        };
        let places: Vec<[f64; 2]> = corners.iter().map(|&v| diagram.vertices[v as usize]).collect();
        let (found, expected) = (area(&places), area(&cell.corners));
        assert!((found - expected).abs() <= 1e-6 * expected.max(1.0), "{row}: {found} {expected}");
    }
    assert!(finite > 400);
}

/// Cubes: 27 vertices, and a ridge for each pair of cells with a common face; no ridge for diagonals.
#[test]
fn diagrams_of_grids_have_no_needless_ridges() {
    let grid: Vec<f64> = (0..64).flat_map(|i| [i % 4, i / 4 % 4, i / 16].map(f64::from)).collect();
    let diagram = space(&grid).voronoi();
    assert_eq!((diagram.vertices.len(), diagram.ridge_rows.len()), (27, 144));
    assert!(diagram.vertices.iter().flatten().all(|x| (x - x.floor() - 0.5).abs() < 1e-12));
    for [a, b] in &diagram.ridge_rows {
        assert!([1, 4, 16].contains(&(b - a)));
    }
    let flat: Vec<f64> = (0..25).flat_map(|i| [i % 5, i / 5].map(f64::from)).collect();
    let diagram = plane(&flat).voronoi();
    assert_eq!((diagram.vertices.len(), diagram.ridge_rows.len()), (16, 40));
    assert!(plane(&[0.0, 0.0, 1.0, 1.0]).voronoi().vertices.is_empty());
}

/// Each finite ridge of general points lies halfway between its two rows, and its plane is at a right angle to their difference.
#[test]
fn ridges_are_between_their_rows() {
    let values = numbers(900, 7);
    let diagram = space(&values).voronoi();
    let at = |row: u32| -> [f64; 3] { std::array::from_fn(|k| values[3 * row as usize + k]) };
    for (ridge, &[a, b]) in diagram.ridge_rows.iter().enumerate() {
        let range = diagram.ridge_starts[ridge] as usize..diagram.ridge_starts[ridge + 1] as usize;
        for &v in &diagram.ridge_vertices[range] {
            if v != u32::MAX {
                let center = diagram.vertices[v as usize];
                let distance = |row: u32| -> f64 {
                    (0..3).map(|k| (center[k] - at(row)[k]).powi(2)).sum::<f64>().sqrt()
                };
                let (from_a, from_b) = (distance(a), distance(b));
                assert!((from_a - from_b).abs() <= 1e-6 * from_a.max(1.0), "{ridge}");
            }
        }
    }
}

#[test]
fn linear_functions_are_reproduced_at_many_points() {
    let values = numbers(1000, 23);
    let index = plane(&values);
    let heights: Vec<f64> = values.chunks(2).map(|p| 3.0 * p[0] - 2.0 * p[1]).collect();
    let queries: Vec<f64> = numbers(800, 24).iter().map(|x| 0.1 + 0.8 * x).collect();
    let points = Points::new(&queries, 2).expect("whole rows");
    let found = index.interpolate(&heights, &points, &Monitor::silent()).expect("as many values");
    let neighbors = index.natural_coordinates(&points, &Monitor::silent()).expect("not stopped");
    for (i, q) in queries.chunks(2).enumerate() {
        assert!((found[i] - (3.0 * q[0] - 2.0 * q[1])).abs() < 1e-9);
        let range = neighbors.starts[i] as usize..neighbors.starts[i + 1] as usize;
        assert!((neighbors.weights[range].iter().sum::<f64>() - 1.0).abs() < 1e-12);
    }
    assert!(index.interpolate(&heights[1..], &points, &Monitor::silent()).is_err());
}
