//! Queries where squares overflow or vanish, in the order of integers.

use taut_certify::Items;
use taut_points::{Points, generate};
use taut_search::{QueryOptions, SphereSearch, SphereSearchOptions};

fn tree(values: &[f64], columns: usize, inputs: Items) -> SphereSearch {
    let options = SphereSearchOptions { inputs, ..Default::default() };
    SphereSearch::new(&Points::new(values, columns).unwrap(), &options).unwrap()
}

fn square(p: &[i64], q: &[i64]) -> i64 {
    p.iter().zip(q).map(|(x, y)| (x - y) * (x - y)).sum()
}

/// Powers of two are exact, so that the order of integers is that of numbers of any size.
#[test]
fn sizes_of_all_kinds_have_the_order_of_integers() {
    let draws: Vec<f64> = generate(taut_points::Distribution::Uniform, 150, 2, 17).unwrap();
    let integers: Vec<i64> = draws.iter().map(|x| (x * 40.0) as i64 - 20).collect();
    let places = [[0, 0], [3, -7], [690, -640], [-1 << 20, 1 << 20]];
    let options = QueryOptions::default();
    for exponent in [-1074, -1060, -700, -540, -498, -400, 0, 480, 498, 511, 700, 1000] {
        // In two steps: 2⁻¹⁰⁷⁴ is no normal number.
        let [half, rest] = [exponent / 2, exponent - exponent / 2].map(|e| 2f64.powi(e));
        let scaled =
            |values: &[i64]| values.iter().map(|&x| x as f64 * half * rest).collect::<Vec<_>>();
        let tree = tree(&scaled(&integers), 2, Items::Points);
        for place in places {
            let by = |sign: i64| {
                let mut rows: Vec<u64> = (0..150).collect();
                rows.sort_by_key(|&row| sign * square(&integers[row as usize * 2..][..2], &place));
                rows
            };
            let at = scaled(&place);
            let queries = Points::new(&at, 2).unwrap();
            let near = tree.nearest_k(&queries, 150, &options).unwrap().remove(0);
            let rows: Vec<u64> = near.iter().map(|found| found.row).collect();
            assert_eq!(rows, by(1), "2^{exponent} {place:?}");
            assert_eq!(tree.nearest_to(&at).unwrap().row, rows[0]);
            let far = tree.farthest(&queries, 0.0, &options).unwrap()[0];
            assert_eq!(far.row, by(-1)[0], "2^{exponent} {place:?}");
            let radius = near[70].distance;
            let within = tree.within(&queries, radius, &options).unwrap().remove(0);
            let count = near.iter().filter(|found| found.distance <= radius).count();
            assert_eq!(within, near[..count]);
        }
        let mut widest = (-1, [0, 0]);
        for i in 0..150 {
            for j in i..150 {
                let far = square(&integers[i * 2..][..2], &integers[j * 2..][..2]);
                if far > widest.0 {
                    widest = (far, [i as u64, j as u64]);
                }
            }
        }
        assert_eq!(tree.diameter(0.0, &options).unwrap().rows, widest.1, "2^{exponent}");
    }
}

#[test]
fn sizes_that_meet_in_one_set() {
    let sizes =
        [0.0, 5e-324, 1e-300, 1e-200, 1e-162, 1e-154, 1e-20, 1.0, 1e20, 1e154, 1e200, 1e308];
    let options = QueryOptions::default();
    for axis in 0..3 {
        let on = |x: f64| -> [f64; 3] { std::array::from_fn(|i| if i == axis { x } else { 0.0 }) };
        let values: Vec<f64> = sizes.iter().flat_map(|&x| on(x)).collect();
        let tree = tree(&values, 3, Items::Points);
        for (row, &x) in sizes.iter().enumerate() {
            assert_eq!(tree.nearest_to(&on(x)).unwrap().row, row as u64, "{x}");
            assert_eq!(tree.nearest_to(&on(-x)).unwrap().row, 0, "{x}");
        }
        let found = tree.diameter(0.0, &options).unwrap();
        assert_eq!((found.rows, found.distance), ([0, 11], 1e308));
    }
    let ends = [-f64::MAX, f64::MAX, f64::MAX, -f64::MAX, 1.6e308, 0.0];
    let tree = tree(&ends, 2, Items::Points);
    let place = [f64::MAX, f64::MAX];
    let near = tree.nearest_k(&Points::new(&place, 2).unwrap(), 3, &options).unwrap().remove(0);
    assert_eq!(near.iter().map(|found| found.row).collect::<Vec<_>>(), [2, 0, 1]);
    assert_eq!(tree.diameter(0.0, &options).unwrap().distance, f64::INFINITY);
}

#[test]
fn balls_and_rays_of_any_size() {
    let options = QueryOptions::default();
    for exponent in [-900, -520, 0, 520, 1000] {
        let size = 2f64.powi(exponent);
        let balls: Vec<f64> =
            [0, 0, 1, 3, 0, 2, 9, 0, 1, 0, 4, 2].map(|x| f64::from(x) * size).to_vec();
        let tree = tree(&balls, 3, Items::Balls);
        let ray = [-5.0 * size, 0.0, size, 0.0];
        let hits = tree.hits(&Points::new(&ray, 4).unwrap(), 0.0, &options).unwrap().remove(0);
        let hits: Vec<(u64, f64)> = hits.iter().map(|hit| (hit.row, hit.distance / size)).collect();
        assert_eq!(hits, [(0, 4.0), (1, 6.0), (2, 13.0)], "2^{exponent}");
        let touching: Vec<[u64; 2]> =
            tree.pairs(0.0, &options).unwrap().iter().map(|pair| pair.rows).collect();
        assert_eq!(touching, [[0, 1]], "2^{exponent}");
        let near = tree.nearest_to(&[size, 0.0]).unwrap();
        assert_eq!((near.row, near.distance), (0, 0.0));
    }
}
