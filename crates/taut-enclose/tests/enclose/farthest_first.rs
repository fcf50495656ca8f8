//! The farthest-first traversal against its definition, and the same bytes however it is called.

use std::ops::Range;

use common::families::Random;
use covering::{judge, optima};
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};
use taut_certify::Placement;
use taut_enclose::{Error, FarthestFirst, FarthestFirstOptions, farthest_first};
use taut_points::{
    Distribution, InputError, PointSource, Points, ReadError, Rows, Scalar, ScalarKind, Scratch,
    generate,
};

use crate::common;
use crate::covering;
use crate::test_length::long_or;

fn seeded(cases: u32) -> Config {
    Config { cases, rng_seed: RngSeed::Fixed(5), failure_persistence: None, ..Config::default() }
}

/// Points that are read block by block, as from a file.
struct Stored<S>(S);

impl<S: PointSource> PointSource for Stored<S> {
    fn len(&self) -> u64 {
        self.0.len()
    }

    fn dim(&self) -> usize {
        self.0.dim()
    }

    fn scalar(&self) -> ScalarKind {
        self.0.scalar()
    }

    fn read<'a>(
        &'a self,
        range: Range<u64>,
        scratch: &'a mut Scratch,
    ) -> Result<Rows<'a>, ReadError> {
        self.0.read(range, scratch)
    }
}

fn traverse<T: Scalar>(values: &[T], dim: usize, count: u64) -> FarthestFirst {
    let points = Points::new(values, dim).unwrap();
    farthest_first(&points, count, &FarthestFirstOptions::default()).unwrap()
}

/// Order, squared radii and next row by the definition, in integers.
fn by_definition(
    values: &[i64],
    dim: usize,
    count: usize,
    start: usize,
) -> (Vec<u64>, Vec<i64>, Option<u64>) {
    let row = |i: usize| &values[i * dim..(i + 1) * dim];
    let square = |a: usize, b: usize| -> i64 {
        row(a).iter().zip(row(b)).map(|(a, b)| (a - b) * (a - b)).sum()
    };
    let n = values.len() / dim;
    let mut least = vec![i64::MAX; n];
    let (mut order, mut radii, mut next) = (vec![], vec![], start);
    loop {
        order.push(next as u64);
        for i in 0..n {
            least[i] = least[i].min(square(i, next));
        }
        let farthest = *least.iter().max().unwrap();
        radii.push(farthest);
        next = least.iter().position(|&v| v == farthest).unwrap();
        if farthest == 0 {
            return (order, radii, None);
        }
        if order.len() == count {
            return (order, radii, Some(next as u64));
        }
    }
}

proptest! {
    #![proptest_config(seeded(300))]

    /// Integers have exact distances and many ties: every choice is the one that the definition makes.
    #[test]
    fn each_choice_is_the_farthest_and_of_equals_the_first(
        dim in prop_oneof![1usize..=5, Just(9usize), Just(100usize)],
        side in 1i64..40,
        bits in vec(any::<u32>(), 1..1200),
        count in 1usize..60,
        start in any::<usize>(),
    ) {
        // A hundred dimensions want more numbers than the list has: it is gone through again with another step.
        let n = (bits.len() / dim.min(10)).max(1);
        let values: Vec<i64> = (0..n * dim)
            .map(|i| i64::from(bits[i * (1 + i / bits.len()) % bits.len()]) % side)
            .collect();
        let start = start % n;
        let wanted = by_definition(&values, dim, count, start);
        let reals: Vec<f64> = values.iter().map(|&v| v as f64).collect();
        let options = FarthestFirstOptions { start: start as u64, ..Default::default() };
        let points = Points::new(&reals, dim).unwrap();
        let found = farthest_first(&points, count as u64, &options).unwrap();
        prop_assert_eq!(&found.order, &wanted.0);
        let radii: Vec<f64> = wanted.1.iter().map(|&v| (v as f64).sqrt()).collect();
        prop_assert_eq!(&found.radii, &radii);
        prop_assert_eq!(found.next, wanted.2);
        let stored = farthest_first(&Stored(points), count as u64, &options);
        let stored = stored.unwrap();
        prop_assert_eq!((&stored.order, &stored.radii, stored.next), (&found.order, &found.radii, found.next));
    }

    /// Every prefix has at most twice the optimal radius, and its bound is one.
    #[test]
    fn every_prefix_is_within_twice_the_optimum(
        dim in 1usize..=3,
        values in prop_oneof![vec(-1.0..1.0f64, 3..24), vec((-3..4i32).prop_map(f64::from), 3..24)],
    ) {
        let n = (values.len() / dim).min(8);
        let values = &values[..n * dim];
        let points = Points::new(values, dim).unwrap();
        let found = traverse(values, dim, n as u64);
        for (k, best) in (1..).zip(optima(values, dim, n)) {
            for placement in [Placement::Free, Placement::Rows] {
                let prefix = found.solution(k, placement, &points).unwrap();
                judge(&prefix, values, dim);
                let (upper, lower) = (prefix.answer.radius, prefix.answer.lower_bound);
                prop_assert!(lower <= best * (1.0 + 1e-14), "{} above {}", lower, best);
                prop_assert!(upper <= 2.0 * best * (1.0 + 1e-14), "{} for {}", upper, best);
                prop_assert!(upper <= 2.0 * lower * (1.0 + 2e-12));
                prop_assert_eq!(prefix.answer.rows.is_empty(), placement == Placement::Free);
            }
        }
    }
}

/// Order, radii to the last bit, and the next row.
fn essence(found: &FarthestFirst) -> (Vec<u64>, Vec<u64>, Option<u64>) {
    (found.order.clone(), found.radii.iter().map(|r| r.to_bits()).collect(), found.next)
}

fn same_for_all_threads_and_media<T: Scalar>(values: &[T], dim: usize, count: u64) {
    let points = Points::new(values, dim).unwrap();
    let mut wanted: Option<(FarthestFirst, FarthestFirst)> = None;
    for threads in 1..=3 {
        let options =
            FarthestFirstOptions { start: 1, threads: Some(threads), ..Default::default() };
        let memory = farthest_first(&points, count, &options).unwrap();
        let stored = farthest_first(&Stored(points), count, &options).unwrap();
        assert_eq!(essence(&memory), essence(&stored), "dimension {dim}");
        assert_eq!(memory.points_hash, stored.points_hash);
        // Counters are part of it.
        match &wanted {
            Some(wanted) => assert_eq!(wanted, &(memory, stored)),
            None => wanted = Some((memory, stored)),
        }
    }
}

#[test]
fn threads_and_media_change_nothing() {
    for &dim in long_or(&[1, 2, 3, 4, 7, 8, 20, 96, 97, 130][..], &[3, 8, 97]) {
        let n = 60_000 / dim + 3;
        let clusters = Distribution::Clusters { count: 12, spread: 0.01 };
        for distribution in [Distribution::Normal, Distribution::Poisson, clusters] {
            let wide: Vec<f64> = generate(distribution, n, dim, 11).unwrap();
            same_for_all_threads_and_media(&wide, dim, 40);
            let narrow: Vec<f32> = generate(distribution, n, dim, 11).unwrap();
            same_for_all_threads_and_media(&narrow, dim, 40);
        }
    }
}

/// Single precision is not another problem: its exact copy in double precision has the same order.
#[test]
fn single_precision_is_its_copy_in_double_precision() {
    for dim in [2, 3, 6, 120] {
        let narrow: Vec<f32> = generate(Distribution::Normal, 2000, dim, 3).unwrap();
        let wide: Vec<f64> = narrow.iter().map(|&v| v.into()).collect();
        assert_eq!(traverse(&narrow, dim, 50), traverse(&wide, dim, 50));
    }
}

/// Powers of two change nothing but the radii, from one end of the numbers to the other.
#[test]
fn sizes_of_all_kinds() {
    for dim in [1, 3, 5] {
        let values: Vec<f64> = generate(Distribution::Uniform, 500, dim, 2).unwrap();
        // A grid, so that the smallest numbers hold all digits.
        let values: Vec<f64> = values.iter().map(|v| (v * 4096.0).round()).collect();
        let plain = traverse(&values, dim, 30);
        for exponent in [-1074, -1000, -500, -200, 200, 500, 1000, 1009] {
            // In two steps, as the smallest powers of two are beyond powi.
            let half = exponent / 2;
            let scale = |v: f64| v * 2f64.powi(half) * 2f64.powi(exponent - half);
            let scaled: Vec<f64> = values.iter().map(|&v| scale(v)).collect();
            let found = traverse(&scaled, dim, 30);
            assert_eq!((&found.order, found.next), (&plain.order, plain.next), "2^{exponent}");
            for (radius, plain) in found.radii.iter().zip(&plain.radii) {
                assert_eq!(*radius, scale(*plain), "2^{exponent}");
            }
            let points = Points::new(&scaled, dim).unwrap();
            let stored = farthest_first(&Stored(points), 30, &FarthestFirstOptions::default());
            assert_eq!(essence(&stored.unwrap()), essence(&found));
        }
    }
}

/// A column of one large value, beside columns whose squares vanish.
#[test]
fn a_constant_column_is_no_burden() {
    let values = [1e300, 0.0, 1e300, 3e-300, 1e300, 1e-300];
    let found = traverse(&values, 2, 2);
    assert_eq!((found.order, found.next), (vec![0, 1], Some(2)));
    assert_eq!(found.radii, [3e-300, 1e-300]);
}

#[test]
fn copies_end_the_order() {
    for dim in [1, 3, 4] {
        for n in [1, 2, 700] {
            let found = traverse(&vec![2.5f64; n * dim], dim, 5);
            assert_eq!(
                (&found.order[..], &found.radii[..], found.next),
                (&[0][..], &[0.0][..], None)
            );
            let points = vec![2.5; n * dim];
            let points = Points::new(&points, dim).unwrap();
            let one = found.solution(5, Placement::Rows, &points).unwrap();
            assert_eq!((one.answer.radius, one.answer.lower_bound), (0.0, 0.0));
            assert_eq!(one.answer.rows, [0]);
            judge(&one, points.values(), dim);
        }
    }
    // −0 is 0.
    let found = traverse(&[0.0, 1.0, -0.0, 1.0, 0.0], 1, 4);
    assert_eq!((found.order, found.radii, found.next), (vec![0, 1], vec![1.0, 0.0], None));
}

#[test]
fn more_points_asked_for_than_there_are() {
    let found = traverse(&[3.0, 1.0, 2.0], 1, 100);
    assert_eq!((found.order, found.radii), (vec![0, 1, 2], vec![2.0, 1.0, 0.0]));
    let exactly = traverse(&[3.0, 1.0, 2.0], 1, 3);
    assert_eq!(exactly.next, None);
}

#[test]
fn what_is_no_input_is_named() {
    let values = [0.0, 1.0, f64::NAN, 2.0];
    for dim in [1, 2] {
        let points = Points::new(&values, dim).unwrap();
        let options = FarthestFirstOptions::default();
        let memory = farthest_first(&points, 2, &options).unwrap_err();
        let stored = farthest_first(&Stored(points), 2, &options).unwrap_err();
        for error in [memory, stored] {
            let (row, column) = (2 / dim as u64, 2 % dim);
            let Error::Input(InputError::NonFinite { row: r, column: c, value }) = error else {
                panic!("{error}")
            };
            assert_eq!((r, c, value.is_nan()), (row, column, true));
        }
    }
    let points = Points::new(&values[..2], 1).unwrap();
    let wrong = |count, start, threads| {
        farthest_first(
            &points,
            count,
            &FarthestFirstOptions { start, threads, ..Default::default() },
        )
        .unwrap_err()
    };
    assert!(matches!(wrong(0, 0, None), Error::Input(InputError::Option { name: "count", .. })));
    assert!(matches!(wrong(1, 2, None), Error::Input(InputError::Option { name: "start", .. })));
    assert!(matches!(
        wrong(1, 0, Some(0)),
        Error::Input(InputError::Option { name: "threads", .. })
    ));
    let empty = Points::new(&values[..0], 1).unwrap();
    let empty = farthest_first(&empty, 1, &FarthestFirstOptions::default());
    assert!(matches!(empty, Err(Error::Empty)));
    let found = traverse(&[0.0, 1.0, 3.0], 1, 2);
    let points = Points::new(&[0.0, 1.0, 3.0], 1).unwrap();
    for k in [0, 3] {
        let wrong = found.solution(k, Placement::Free, &points);
        assert!(matches!(wrong, Err(Error::Input(InputError::Option { name: "k", .. }))));
    }
}

/// No order is claimed among points that squares cannot tell apart.
#[test]
fn differences_that_vanish_are_refused_and_only_they() {
    let values = [0.0, 1.0, 1e-300];
    let points = Points::new(&values, 1).unwrap();
    let options = FarthestFirstOptions::default();
    for count in 1..=3 {
        for found in [
            farthest_first(&points, count, &options),
            farthest_first(&Stored(points), count, &options),
        ] {
            match count {
                1 => assert_eq!(found.unwrap().radii, [1.0]),
                _ => assert!(matches!(found, Err(Error::Overflow))),
            }
        }
    }
    let far = [-f64::MAX, f64::MAX];
    let far = Points::new(&far, 1).unwrap();
    assert!(matches!(farthest_first(&far, 1, &options), Err(Error::Overflow)));
}

/// What is skipped is most of it.
#[test]
fn few_distances_are_evaluated() {
    // Blocks are read again only when they may hold the next point.
    let many: Vec<f32> = generate(Distribution::Kuzmin, 400_000, 2, 1).unwrap();
    let many = Points::new(&many, 2).unwrap();
    let options = FarthestFirstOptions::default();
    let found = farthest_first(&Stored(many), 300, &options).unwrap();
    assert!(found.trace.passes < 200, "{}", found.trace.passes);
    let n = 40_000;
    let share = |found: &FarthestFirst| found.trace.counters["distances"] as f64 / (n * 300) as f64;
    for dim in [2, 3] {
        let values: Vec<f64> = generate(Distribution::Uniform, n, dim, 1).unwrap();
        let found = traverse(&values, dim, 300);
        assert!(share(&found) < 0.3, "{dim}: {}", share(&found));
    }
    let values: Vec<f32> = generate(Distribution::Normal, n, 40, 1).unwrap();
    let found = traverse(&values, 40, 300);
    assert!(share(&found) < 0.3, "{}", share(&found));
    let clusters = Distribution::Clusters { count: 40, spread: 0.001 };
    let values: Vec<f32> = generate(clusters, n, 16, 1).unwrap();
    let found = traverse(&values, 16, 300);
    assert!(share(&found) < 0.3, "{}", share(&found));
}

/// A long way from the origin the order is that of the differences.
#[test]
fn far_from_the_origin() {
    let mut random = Random(4);
    let near: Vec<f64> = (0..900).map(|_| random.below(1 << 20) as f64).collect();
    let far: Vec<f64> = near.iter().map(|v| v + 2f64.powi(40)).collect();
    for dim in [3, 5] {
        let (near, far) = (traverse(&near, dim, 40), traverse(&far, dim, 40));
        assert_eq!(essence(&near), essence(&far));
    }
}
