//! Centers against a brute force over all colorings, and every proof replayed by code of its own.

use centers::{brute_force, judge};
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};
use taut_certify::Items;
use taut_enclose::{CentersMethod, CentersOptions, centers};
use taut_points::Points;

use crate::centers;
use crate::test_length::long_or;

fn seeded(cases: u32) -> Config {
    Config { cases, rng_seed: RngSeed::Fixed(50), failure_persistence: None, ..Config::default() }
}

/// All colorings are gone through of at most this many items.
const ITEMS_MAX: usize = 12;

/// Small integers for ties, copies and lines, or reals; with their dimension. One time in three as many as there may be.
fn few_points() -> impl Strategy<Value = (Vec<f64>, usize)> {
    (1usize..=3, prop_oneof![2 => 1..=ITEMS_MAX, 1 => Just(ITEMS_MAX)]).prop_flat_map(|(dim, n)| {
        let grid = vec((-2i32..3).prop_map(f64::from), n * dim);
        let integers = vec((-9i32..10).prop_map(f64::from), n * dim);
        let reals = vec(-1.0f64..1.0, n * dim);
        (prop_oneof![grid, integers, reals], Just(dim))
    })
}

fn solve(
    values: &[f64],
    columns: usize,
    items: Items,
    k: usize,
    options: &CentersOptions<'_>,
) -> f64 {
    let points = Points::new(values, columns).unwrap();
    let found = centers(&points, k, &CentersOptions { inputs: items, ..*options }).unwrap();
    if let Err(why) = judge(values, columns, k, options, &found) {
        panic!("{why}\nk = {k}, {options:?}\n{values:?}\n{found:?}");
    }
    found.check(&points).unwrap_or_else(|why| panic!("{why}\n{values:?}\n{found:?}"));
    let gap = found.certificate.gap;
    assert!(gap <= options.epsilon.max(2e-11), "gap {gap} of {found:?} for {values:?}");
    found.answer.radius
}

fn close(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-9 * a.abs().max(b.abs())
}

proptest! {
    #![proptest_config(seeded(long_or(40, 12)))]

    #[test]
    fn points((values, dim) in few_points(), epsilon in prop_oneof![Just(0.0), Just(1e-9)]) {
        let wanted = brute_force(&values, dim, Items::Points, false);
        let n = values.len() / dim;
        for k in 1..=n + 1 {
            let options = CentersOptions { epsilon, assignment: true, ..Default::default() };
            let radius = solve(&values, dim, Items::Points, k, &options);
            prop_assert!(close(radius, wanted(k, 0)), "k = {k}: {radius} against {}", wanted(k, 0));
        }
    }

    #[test]
    fn points_with_outliers((values, dim) in few_points(), z in 1usize..5) {
        let wanted = brute_force(&values, dim, Items::Points, false);
        let n = values.len() / dim;
        prop_assume!(z < n);
        for k in 1..=n {
            let options = CentersOptions { epsilon: 1e-9, outliers: z as u64, ..Default::default() };
            let radius = solve(&values, dim, Items::Points, k, &options);
            prop_assert!(close(radius, wanted(k, z)), "k = {k}: {radius} against {}", wanted(k, z));
        }
    }

    #[test]
    fn by_the_thesis((values, dim) in few_points()) {
        let wanted = brute_force(&values, dim, Items::Points, false);
        let n = values.len() / dim;
        for k in 1..=n {
            let options = CentersOptions { epsilon: 1e-9, method: CentersMethod::Thesis, ..Default::default() };
            let radius = solve(&values, dim, Items::Points, k, &options);
            prop_assert!(close(radius, wanted(k, 0)), "k = {k}: {radius} against {}", wanted(k, 0));
        }
    }

    #[test]
    fn weighted((mut values, dim) in few_points(), weights in vec(prop_oneof![Just(1.0), Just(2.0), 0.1f64..9.0], ITEMS_MAX), z in 0usize..3) {
        let n = values.len() / dim;
        prop_assume!(z < n);
        for row in (0..n).rev() {
            values.insert((row + 1) * dim, weights[row]);
        }
        let wanted = brute_force(&values, dim + 1, Items::Points, true);
        for k in 1..=n {
            let options = CentersOptions { epsilon: 1e-9, weights: true, outliers: z as u64, ..Default::default() };
            let radius = solve(&values, dim + 1, Items::Points, k, &options);
            prop_assert!(close(radius, wanted(k, z)), "k = {k}: {radius} against {}", wanted(k, z));
        }
    }

    #[test]
    fn balls((mut values, dim) in few_points(), radii in vec(prop_oneof![Just(0.0), Just(1.0), 0.0f64..3.0], ITEMS_MAX), z in 0usize..3) {
        let n = values.len() / dim;
        prop_assume!(z < n);
        for row in (0..n).rev() {
            values.insert((row + 1) * dim, radii[row]);
        }
        let wanted = brute_force(&values, dim + 1, Items::Balls, false);
        for k in 1..=n {
            let options = CentersOptions { epsilon: 1e-9, outliers: z as u64, ..Default::default() };
            let radius = solve(&values, dim + 1, Items::Balls, k, &options);
            prop_assert!(close(radius, wanted(k, z)), "k = {k}: {radius} against {}", wanted(k, z));
        }
    }
}
