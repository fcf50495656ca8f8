//! Nearest points against a look at all.

use proptest::prelude::*;

use super::query::nearest_by_all;
use super::*;

/// Returns what an interpreter has time for, or else all.
fn miri_or(few: usize, all: usize) -> usize {
    if cfg!(miri) { few } else { all }
}

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
        TreeOrder::Blocked { nodes: 3 },
        TreeOrder::PreOrder,
        TreeOrder::BreadthFirst,
    ];
    for order in orders.into_iter().take(miri_or(1, 4)) {
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
            let counts = [2, points.len() + 5, 0, 1, 7, points.len()];
            for k in counts.into_iter().take(miri_or(2, 6)) {
                assert_eq!(tree.nearest_k(place, k), want[..k.min(want.len())], "{k} {place:?}");
                let falling = tree.nearest_k_by(place, k, |a, b| b.cmp(&a));
                let mut want = want.clone();
                want.sort_by(|a, b| a.distance2.total_cmp(&b.distance2).then(b.row.cmp(&a.row)));
                assert_eq!(falling, want[..k.min(want.len())], "{k} {place:?}");
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
    for len in
        [0, 1, 33, 65, 2, 31, 32, 63, 64, 95, 97, 128, 129, 300].into_iter().take(miri_or(4, 14))
    {
        agrees::<3>(&random(len, 1), &random(miri_or(1, 8), 2));
        agrees::<2>(&random(len, 3), &random(miri_or(1, 8), 4));
    }
}

#[test]
fn places_outside_and_points_that_are_far_apart() {
    let mut points: Vec<[f64; 3]> = random(miri_or(20, 200), 5);
    let places = [[9.0, 9.0, 9.0], [-1e9, 0.5, 0.5], [0.5, 0.5, 1e100], [1e-100, 0.0, -0.0]];
    agrees(&points, &places);
    points.extend([[1e150, 0.0, 0.0], [-1e150, 1e150, 0.0], [1e-120, -0.0, 0.0], [0.0; 3]]);
    agrees(&points, &places);
}

/// Points with integer coordinates, whose squared distances are integers: rows by distance, exactly.
fn by_integers(points: &[[i64; 2]], place: [i64; 2]) -> Vec<u32> {
    let square = |p: [i64; 2]| (p[0] - place[0]).pow(2) + (p[1] - place[1]).pow(2);
    let mut rows: Vec<u32> = (0..points.len() as u32).collect();
    rows.sort_by_key(|&row| (square(points[row as usize]), row));
    rows
}

#[test]
fn coordinates_of_any_size_have_the_order_of_integers() {
    let integers: Vec<[i64; 2]> = random::<2>(miri_or(40, 150), 17)
        .iter()
        .map(|p| p.map(|x| (x * 40.0) as i64 - 20))
        .chain([[700, -650], [-701, 3], [1 << 20, 5], [0, 0]])
        .collect();
    let places = [[0, 0], [3, -7], [690, -640], [-1 << 20, 1 << 20], [1 << 20, 6]];
    let scales =
        [-1074, -1060, -700, -540, -500, -453, -400, 0, 400, 480, 500, 511, 512, 600, 1000];
    for exponent in scales.into_iter().step_by(miri_or(7, 1)) {
        // In two steps: 2⁻¹⁰⁷⁴ is no normal number. From bits: a power that a library calculates need not be exact.
        let power = |e: i32| f64::from_bits(((1023 + e) as u64) << 52);
        let [half, rest] = [power(exponent / 2), power(exponent - exponent / 2)];
        let scale = |p: [i64; 2]| p.map(|x| x as f64 * half * rest);
        let points: Vec<[f64; 2]> = integers.iter().map(|&p| scale(p)).collect();
        let tree = KdTree::new(&points).unwrap();
        for place in places.into_iter().take(miri_or(2, 5)) {
            let want = by_integers(&integers, place);
            let at = scale(place);
            let rows = |found: Vec<Nearest>| found.iter().map(|f| f.row).collect::<Vec<_>>();
            assert_eq!(tree.nearest(at).unwrap().row, want[0], "2^{exponent} {place:?}");
            for k in [1, 2, 9, points.len()] {
                assert_eq!(rows(tree.nearest_k(at, k)), want[..k], "2^{exponent} {place:?}");
            }
            assert_eq!(tree.nearest_all(&[at])[0].unwrap().row, want[0]);
        }
    }
}

#[test]
fn coordinates_of_very_different_sizes() {
    // Along each axis points of all sizes: the nearest to a place between two of them is the smaller one.
    let sizes =
        [0.0, 5e-324, 1e-300, 1e-200, 1e-162, 1e-154, 1e-20, 1.0, 1e20, 1e154, 1e200, 1e308];
    for axis in 0..miri_or(1, 3) {
        let on = |x: f64| std::array::from_fn(|i| if i == axis { x } else { 0.0 });
        let points: Vec<[f64; 3]> = sizes.iter().map(|&x| on(x)).collect();
        let tree = KdTree::new(&points).unwrap();
        for (row, &x) in sizes.iter().enumerate().step_by(miri_or(3, 1)) {
            assert_eq!(tree.nearest(on(x)).unwrap().row, row as u32, "{x}");
            let found = tree.nearest(on(-x)).unwrap();
            assert_eq!(found.row, 0, "{x}");
            let past = tree.nearest_k(on(x * 1.25), 2);
            if (1e-300..1e308).contains(&x) {
                assert_eq!(past[0].row, row as u32, "{x}");
            }
        }
    }
    let tree = KdTree::new(&[[0.0, 0.0], [9e199, 0.0]]).unwrap();
    assert_eq!(tree.nearest([1e200, 0.0]).unwrap().row, 1);
    let tree = KdTree::new(&[[1e-200, 0.0], [0.0, 0.0]]).unwrap();
    assert_eq!(tree.nearest([0.0, 0.0]), Some(Nearest { row: 1, distance2: 0.0 }));
    let tree = KdTree::new(&[[-1.7e308, 1.7e308], [1.7e308, -1.7e308], [1.6e308, 0.0]]).unwrap();
    let rows: Vec<u32> = tree.nearest_k([1.7e308, 1.7e308], 3).iter().map(|f| f.row).collect();
    assert_eq!(rows, [2, 0, 1]);
}

#[test]
fn places_at_infinity_are_equally_far_from_all() {
    let points: Vec<[f64; 2]> = random(100, 3);
    let tree = KdTree::new(&points).unwrap();
    let places = [[f64::INFINITY, 0.0], [0.0, f64::NEG_INFINITY], [f64::INFINITY; 2]];
    let all: Vec<[f64; 2]> = places.into_iter().chain(points.iter().copied().take(9)).collect();
    let found = tree.nearest_all(&all);
    for (place, found) in places.iter().zip(&found) {
        assert_eq!(*found, Some(Nearest { row: 0, distance2: f64::INFINITY }));
        assert_eq!(tree.nearest(*place), *found);
    }
    for row in 0..9 {
        assert_eq!(found[3 + row].unwrap().row, row as u32);
    }
    assert_eq!(tree.nearest([f64::NAN, f64::INFINITY]), None);
    let last: Vec<u32> =
        tree.nearest_k_by(places[0], 3, |a, b| b.cmp(&a)).iter().map(|found| found.row).collect();
    assert_eq!(last, [99, 98, 97]);
    assert!(tree.nearest_k([f64::NAN, 1e300], 5).is_empty());
}

#[test]
fn equal_points_and_lines() {
    agrees(&[[1.0, 2.0, 3.0]; 100][..miri_or(40, 100)], &[[1.0, 2.0, 3.0], [0.0; 3]]);
    let line: Vec<[f64; 3]> =
        (0..miri_or(50, 200) as i32).map(|i| [0.5, f64::from(i / 10), 0.5]).collect();
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
    #![proptest_config(ProptestConfig::with_cases(if cfg!(miri) { 1 } else { 256 }))]
    /// Small integers bring ties: the lowest row has to win.
    #[test]
    fn ties_go_to_the_lowest_row(
        flat in prop::collection::vec(-3i8..4, 0..miri_or(120, 400)),
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
    let points: Vec<[f64; 2]> = random(miri_or(300, 40_000), 9);
    let build = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| KdTree::new(&points)).unwrap()
    };
    let (one, two) = (build(1), build(2));
    assert_eq!(one.rows.words(), two.rows.words());
    assert_eq!(one.nodes.words(), two.nodes.words());
}
