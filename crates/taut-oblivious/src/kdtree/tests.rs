//! Nearest points against a look at all.

use proptest::prelude::*;

use super::query::nearest_by_all;
use super::*;

fn distance2<const D: usize>(p: [f64; D], q: [f64; D]) -> f64 {
    (0..D).map(|i| (p[i] - q[i]) * (p[i] - q[i])).sum()
}

/// All points by distance and then by row.
fn by_distance<const D: usize>(points: &[[f64; D]], place: [f64; D]) -> Vec<Nearest> {
    let found = |(row, &p): (u32, &[f64; D])| Nearest { row, distance2: distance2(p, place) };
    let mut all: Vec<Nearest> = (0..).zip(points).map(found).collect();
    all.sort_by(|a, b| a.distance2.total_cmp(&b.distance2).then(a.row.cmp(&b.row)));
    all
}

fn agrees<const D: usize>(points: &[[f64; D]], places: &[[f64; D]]) {
    let orders = [
        TreeOrder::VanEmdeBoas,
        TreeOrder::PreOrder,
        TreeOrder::BreadthFirst,
        TreeOrder::Blocked { nodes: 3 },
    ];
    for order in orders {
        let tree = KdTree::with_order(points, order).unwrap();
        assert_eq!(tree.len(), points.len());
        assert_eq!(tree.is_empty(), points.is_empty());
        let all = tree.nearest_all(places);
        for (&place, &in_all) in places.iter().zip(&all) {
            let want = by_distance(points, place);
            assert_eq!(tree.nearest(place), want.first().copied(), "{place:?}");
            assert_eq!(in_all, want.first().copied());
            for found in nearest_by_all(&tree, place) {
                assert_eq!(found.row, want.first().map_or(u32::MAX, |found| found.row));
            }
            for k in [0, 1, 2, 7, points.len(), points.len() + 5] {
                assert_eq!(tree.nearest_k(place, k), want[..k.min(want.len())], "{k} {place:?}");
            }
        }
    }
}

fn random<const D: usize>(len: usize, mut state: u64) -> Vec<[f64; D]> {
    let mut next = || {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    (0..len).map(|_| std::array::from_fn(|_| next())).collect()
}

#[test]
fn sizes_around_those_of_buckets() {
    for len in [0, 1, 2, 31, 32, 33, 63, 64, 65, 95, 97, 128, 129, 300] {
        agrees::<3>(&random(len, 1), &random(8, 2));
        agrees::<2>(&random(len, 3), &random(8, 4));
    }
}

#[test]
fn places_outside_and_points_that_are_far_apart() {
    let mut points: Vec<[f64; 3]> = random(200, 5);
    let places = [[9.0, 9.0, 9.0], [-1e9, 0.5, 0.5], [0.5, 0.5, 1e300], [1e-300, 0.0, 0.0]];
    agrees(&points, &places);
    points.extend([[1e300, 0.0, 0.0], [-1e300, 1e300, 0.0], [5e-324, -0.0, 0.0], [0.0; 3]]);
    agrees(&points, &places);
}

#[test]
fn equal_points_and_lines() {
    agrees(&[[1.0, 2.0, 3.0]; 100], &[[1.0, 2.0, 3.0], [0.0; 3]]);
    let line: Vec<[f64; 3]> = (0..200).map(|i| [0.5, f64::from(i / 10), 0.5]).collect();
    agrees(&line, &[[0.5, 3.0, 0.5], [0.5, 3.5, 0.5], [7.0, 3.5, 0.5]]);
}

#[test]
fn coordinates_that_are_no_numbers() {
    let named = KdTree::new(&[[0.0, 1.0], [0.0, f64::NAN]]).map(drop);
    assert!(matches!(named, Err(Error::NonFinite { row: 1, column: 1, .. })));
    let named = KdTree::new(&[[f64::INFINITY, 0.0]]).map(drop);
    assert!(matches!(named, Err(Error::NonFinite { row: 0, column: 0, .. })));
    let tree = KdTree::new(&random::<2>(100, 1)).unwrap();
    assert_eq!(tree.nearest([f64::NAN, 0.0]), None);
}

proptest! {
    /// Small integers bring ties: the lowest row has to win.
    #[test]
    fn ties_go_to_the_lowest_row(
        flat in prop::collection::vec(-3i8..4, 0..400),
        place in prop::array::uniform3(-8i8..9),
    ) {
        let points: Vec<[f64; 3]> =
            flat.as_chunks::<3>().0.iter().map(|p| p.map(f64::from)).collect();
        agrees(&points, &[place.map(|x| f64::from(x) / 2.0)]);
        let points: Vec<[f64; 2]> =
            flat.as_chunks::<2>().0.iter().map(|p| p.map(f64::from)).collect();
        agrees(&points, &[[f64::from(place[0]) / 2.0, f64::from(place[1])]]);
    }
}

#[test]
fn threads_do_not_change_the_tree() {
    let points: Vec<[f64; 2]> = random(40_000, 9);
    let build = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| KdTree::new(&points)).unwrap()
    };
    let (one, two) = (build(1), build(2));
    assert_eq!(one.rows.words(), two.rows.words());
    assert_eq!(one.nodes.words(), two.nodes.words());
}
