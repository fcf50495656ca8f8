//! Streams and partitions against the optimum, in orders that are made to be hard.

use common::families::Random;
use covering::{judge, least_distance, optima, optimum_on_a_line, radius};
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngSeed};
use taut_certify::{Centers, Placement, Solution};
use taut_enclose::{
    CentersMethod, CentersOptions, CoreSetSummary, Error, StreamingCenters, StreamingOptions,
    StreamingReport, centers,
};
use taut_points::{Distribution, InputError, Monitor, Points, generate, hash_points};

use crate::common;
use crate::covering;

fn seeded(cases: u32) -> Config {
    Config { cases, rng_seed: RngSeed::Fixed(8), failure_persistence: None, ..Config::default() }
}

/// Centers by one pass and a measuring one.
fn streamed(options: StreamingOptions) -> CentersOptions<'static> {
    CentersOptions { method: CentersMethod::Stream(options), ..Default::default() }
}

/// Checks what holds at every moment, whatever the optimum is.
fn sound(
    found: &StreamingReport,
    values: &[f64],
    dim: usize,
    k: usize,
    options: &StreamingOptions,
) {
    assert!(found.centers.len() <= k && found.centers.len() == found.rows.len());
    for (center, &row) in found.centers.iter().zip(&found.rows) {
        assert_eq!(center, &values[row as usize * dim..][..dim]);
    }
    assert!(radius(values, dim, &found.centers) <= found.radius);
    let factor = options.factor() * (1.0 + 1e-9);
    assert!(found.radius <= factor * found.lower_bound, "{} / {}", found.radius, found.lower_bound);
    if found.lower_bound > 0.0 {
        assert_eq!(found.separated.len(), k + 1);
        assert!(least_distance(values, dim, &found.separated) >= 2.0 * found.lower_bound);
    }
}

const INSTANCES: [usize; 4] = [1, 2, 8, 16];

proptest! {
    #![proptest_config(seeded(120))]

    /// At every moment of a short stream the bounds are on either side of the optimum.
    #[test]
    fn bounds_hold_at_every_moment(
        dim in 1usize..=3,
        values in prop_oneof![
            vec(-1.0..1.0f64, 3..27),
            vec((-3..4i32).prop_map(f64::from), 3..27),
            vec((-40..40i32).prop_map(|e| 2f64.powi(e)), 3..27),
        ],
        k in 1usize..4,
        instances in prop::sample::select(&INSTANCES[..]),
    ) {
        let options = StreamingOptions { instances };
        let n = (values.len() / dim).min(8);
        let mut cover = StreamingCenters::new(dim, k, &options).unwrap();
        for i in 0..n {
            cover.add(&Points::new(&values[i * dim..(i + 1) * dim], dim).unwrap()).unwrap();
            let seen = &values[..(i + 1) * dim];
            let found = cover.covered();
            sound(&found, seen, dim, k, &options);
            let best = *optima(seen, dim, k).last().unwrap();
            prop_assert!(found.lower_bound <= best * (1.0 + 1e-13));
            prop_assert!(found.radius <= options.factor() * best * (1.0 + 1e-9));
            prop_assert!(found.radius >= best * (1.0 - 1e-13));
        }
    }
}

/// Orders in which each point is an unpleasant surprise.
fn hard_orders(random: &mut Random) -> Vec<(&'static str, Vec<f64>)> {
    let geometric: Vec<f64> = (0..600).map(|i| 1.07f64.powi(i)).collect();
    let falling: Vec<f64> = geometric.iter().rev().copied().collect();
    let both_ways: Vec<f64> = geometric.iter().flat_map(|&v| [v, -v]).collect();
    // Clusters that keep growing, each beginning before the last one ends.
    let growing: Vec<f64> =
        (0..800).map(|i| 1e4 * (i % 7) as f64 + 0.01 * (i * i) as f64).collect();
    // Just below and above twice the last guess of a doubling.
    let teasing: Vec<f64> = (0..500)
        .map(|i| 2f64.powi(i / 10) * [1.0, 2.0 - 1e-9, 2.0 + 1e-9, 1.5, 1e-6][i as usize % 5])
        .collect();
    let mut shuffled = geometric.clone();
    for i in (1..shuffled.len()).rev() {
        shuffled.swap(i, random.below(i + 1));
    }
    vec![
        ("geometric", geometric),
        ("falling", falling),
        ("both ways", both_ways),
        ("growing clusters", growing),
        ("teasing", teasing),
        ("shuffled", shuffled),
    ]
}

/// Hundreds of points on a line, where the optimum is known.
#[test]
fn the_factor_holds_on_hard_orders() {
    let mut random = Random(9);
    for (name, values) in hard_orders(&mut random) {
        for k in [1, 3, 10] {
            for instances in INSTANCES {
                let options = StreamingOptions { instances };
                let mut cover = StreamingCenters::new(1, k, &options).unwrap();
                for (i, part) in values.chunks(37).enumerate() {
                    cover.add(&Points::new(part, 1).unwrap()).unwrap();
                    let seen = &values[..(37 * (i + 1)).min(values.len())];
                    let found = cover.covered();
                    sound(&found, seen, 1, k, &options);
                    let best = optimum_on_a_line(seen, k);
                    assert!(found.lower_bound <= best * (1.0 + 1e-12), "{name}");
                    let factor = options.factor() * (1.0 + 1e-9);
                    assert!(found.radius <= factor * best, "{name}, k = {k}, {instances}");
                }
                let all = Points::new(&values, 1).unwrap();
                let found = cover.solution(Placement::Rows, &all, &Monitor::silent()).unwrap();
                judge(&found, &values, 1);
                assert!(found.answer.radius <= cover.covered().radius * (1.0 + 1e-13));
            }
        }
    }
}

/// The factors that are promised, by their closed form.
#[test]
fn the_factors() {
    let factor = |instances| StreamingOptions { instances }.factor();
    assert_eq!(factor(1), 8.0);
    assert!((factor(8) - 2.961).abs() < 1e-3 && (factor(64) - 2.168).abs() < 1e-3);
    assert!((1..1000).all(|m| factor(m + 1) < factor(m) && factor(m) > 2.0));
}

#[test]
fn blocks_media_and_threads_change_nothing() {
    let values: Vec<f64> =
        generate(Distribution::Clusters { count: 9, spread: 0.02 }, 30_000, 3, 5).unwrap();
    let points = Points::new(&values, 3).unwrap();
    let options = StreamingOptions::default();
    let mut wanted = StreamingCenters::new(3, 6, &options).unwrap();
    wanted.add(&points).unwrap();
    for rows in [1, 7, 1000] {
        let mut cover = StreamingCenters::new(3, 6, &options).unwrap();
        for part in values.chunks(3 * rows) {
            cover.add(&Points::new(part, 3).unwrap()).unwrap();
        }
        assert_eq!(cover, wanted);
    }
    let silent = &Monitor::silent();
    let found = centers(&points, 6, &streamed(options)).unwrap();
    assert_eq!(found, wanted.solution(Placement::Free, &points, silent).unwrap());
    judge(&found, &values, 3);
    for threads in [1, 2, 3] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let again = pool.install(|| centers(&points, 6, &streamed(options)));
        assert_eq!(again.unwrap(), found);
    }
}

#[test]
fn sizes_of_all_kinds() {
    for size in [1e-300, 1e-160, 1.0, 1e160, 1e300] {
        let values: Vec<f64> = (0..300).map(|i| size * f64::from(i * i % 101)).collect();
        let options = StreamingOptions { instances: 4 };
        let mut cover = StreamingCenters::new(2, 5, &options).unwrap();
        cover.add(&Points::new(&values, 2).unwrap()).unwrap();
        let found = cover.covered();
        assert!(found.radius <= options.factor() * found.lower_bound * (1.0 + 1e-9), "{size}");
        let unit: Vec<f64> = values.iter().map(|v| v / size).collect();
        let measured = size * radius(&unit, 2, &scaled(&found.centers, 1.0 / size));
        assert!(measured <= found.radius * (1.0 + 1e-14));
        let points = Points::new(&values, 2).unwrap();
        let exact = cover.solution(Placement::Free, &points, &Monitor::silent()).unwrap();
        assert!((exact.answer.radius - measured).abs() <= 1e-13 * measured, "{size}");
    }
}

fn scaled(rows: &[Vec<f64>], by: f64) -> Vec<Vec<f64>> {
    rows.iter().map(|row| row.iter().map(|v| v * by).collect()).collect()
}

#[test]
fn few_different_points_are_all_centers() {
    let mut cover = StreamingCenters::new(1, 3, &StreamingOptions::default()).unwrap();
    assert!(cover.is_empty());
    for value in [4.0, 4.0, 1.0, -0.0, 0.0, 4.0, 1.0] {
        cover.add(&Points::new(&[value], 1).unwrap()).unwrap();
    }
    let found = cover.covered();
    assert_eq!((found.rows, found.radius, found.lower_bound), (vec![0, 2, 3], 0.0, 0.0));
    cover.add(&Points::new(&[2.0], 1).unwrap()).unwrap();
    let found = cover.covered();
    assert!((found.lower_bound - 0.5).abs() < 1e-12 && found.radius >= 0.5);
    assert_eq!(cover.len(), 8);
}

#[test]
fn what_is_no_input_is_named() {
    let options = StreamingOptions::default();
    for (dim, k, instances, wrong) in
        [(0, 1, 1, "dim"), (1, 0, 1, "k"), (1, 1, 0, "instances"), (1, 1, 1001, "instances")]
    {
        let found = StreamingCenters::new(dim, k, &StreamingOptions { instances });
        assert!(
            matches!(found, Err(Error::Input(InputError::Option { name, .. })) if name == wrong)
        );
    }
    let mut cover = StreamingCenters::new(2, 1, &options).unwrap();
    cover.add(&Points::new(&[0.0; 6], 2).unwrap()).unwrap();
    let wrong = cover.add(&Points::new(&[1.0, 2.0, 3.0, f64::NAN], 2).unwrap());
    assert!(matches!(wrong, Err(Error::Input(InputError::NonFinite { row: 4, column: 1, .. }))));
    assert_eq!(cover.len(), 3, "none of a block with such a row is counted");
    let wrong = cover.add(&Points::new(&[1.0; 3], 3).unwrap());
    assert!(matches!(wrong, Err(Error::Input(InputError::Option { name: "points", .. }))));
    let other = Points::new(&[0.0; 4], 2).unwrap();
    let wrong = cover.solution(Placement::Free, &other, &Monitor::silent());
    assert!(matches!(wrong, Err(Error::Input(InputError::Option { name: "source", .. }))));
    let empty = Points::<f64>::new(&[], 2).unwrap();
    let wrong = centers(&empty, 1, &streamed(options));
    assert!(matches!(wrong, Err(Error::Empty)));
    for far in [[-f64::MAX, f64::MAX], [0.0, 5e-324]] {
        let far = Points::new(&far, 1).unwrap();
        let wrong = centers(&far, 1, &streamed(options));
        assert!(matches!(wrong, Err(Error::Overflow)));
    }
}

/// Summaries of parts of `values`, cut at the given rows.
fn summaries(values: &[f64], dim: usize, cuts: &[usize], size: u64) -> Vec<CoreSetSummary> {
    cuts.windows(2)
        .map(|cut| {
            let part = Points::new(&values[cut[0] * dim..cut[1] * dim], dim).unwrap();
            CoreSetSummary::of(&part, cut[0] as u64, size).unwrap()
        })
        .collect()
}

fn merged(summaries: impl IntoIterator<Item = CoreSetSummary>) -> CoreSetSummary {
    summaries.into_iter().fold(CoreSetSummary::default(), |all, one| all.merge(one).unwrap())
}

proptest! {
    #![proptest_config(seeded(120))]

    /// Small enough for the optimum: the bound is one, and k + 1 points of each part are within four times the optimum.
    #[test]
    fn parts_are_within_four_times_the_optimum(
        dim in 1usize..=2,
        values in prop_oneof![vec(-1.0..1.0f64, 18), vec((-3..4i32).prop_map(f64::from), 18)],
        k in 1usize..4,
        cut in 1usize..8,
    ) {
        let values = &values[..9 * dim];
        let points = Points::new(values, dim).unwrap();
        let parts = summaries(values, dim, &[0, cut, 9], k as u64 + 1);
        let root = merged(parts);
        let found = root.solve(k as u64, Placement::Rows, &points, &Monitor::silent()).unwrap();
        judge(&found, values, dim);
        let best = *optima(values, dim, k).last().unwrap();
        prop_assert!(found.answer.lower_bound <= best * (1.0 + 1e-13));
        prop_assert!(found.answer.radius <= 4.0 * best * (1.0 + 1e-13));
        prop_assert!(found.answer.radius <= 6.0 * found.answer.lower_bound * (1.0 + 2e-12));
    }
}

#[test]
fn summaries_may_come_in_any_order() {
    let values: Vec<f64> = generate(Distribution::Normal, 4000, 3, 2).unwrap();
    let points = Points::new(&values, 3).unwrap();
    let parts = summaries(&values, 3, &[0, 100, 1500, 1501, 4000], 20);
    let root = merged(parts.iter().cloned());
    assert_eq!(root, merged(parts.iter().rev().cloned()));
    let halves = [0, 2].map(|i| merged(parts[i..i + 2].iter().cloned()));
    assert_eq!(root, merged(halves));
    assert_eq!((root.len(), root.rows().len()), (4000, 61));
    // Every point is as near as the summary says, and the rows are what they are.
    let chosen: Vec<Vec<f64>> = root.points().unwrap().rows().map(<[f64]>::to_vec).collect();
    for (row, chosen) in root.rows().iter().zip(&chosen) {
        assert_eq!(points.row(*row as usize), chosen);
    }
    let reached = radius(&values, 3, &chosen);
    assert!(reached <= root.radius() && reached > 0.5 * root.radius());
    let fewer = root.clone().reduce(10).unwrap();
    assert_eq!((fewer.rows().len(), fewer.len()), (10, 4000));
    let chosen: Vec<Vec<f64>> = fewer.points().unwrap().rows().map(<[f64]>::to_vec).collect();
    assert!(radius(&values, 3, &chosen) <= fewer.radius());
    assert!(fewer.rows().iter().all(|row| root.rows().contains(row)));
    assert_eq!(root.clone().reduce(61).unwrap(), root);
    let found = root.solve(4, Placement::Rows, &points, &Monitor::silent()).unwrap();
    judge(&found, &values, 3);
}

#[test]
fn summaries_that_do_not_belong_together_are_refused() {
    let one = CoreSetSummary::of(&Points::new(&[1.0, 2.0], 1).unwrap(), 0, 5).unwrap();
    let two = CoreSetSummary::of(&Points::new(&[1.0, 2.0], 2).unwrap(), 9, 5).unwrap();
    assert!(matches!(
        one.clone().merge(two),
        Err(Error::Input(InputError::Option { name: "other", .. }))
    ));
    assert!(matches!(
        one.clone().merge(one.clone()),
        Err(Error::Input(InputError::Option { name: "other", .. }))
    ));
    let nothing = CoreSetSummary::default();
    assert!(nothing.is_empty() && matches!(nothing.points(), Err(Error::Empty)));
    let points = Points::new(&[1.0, 2.0], 1).unwrap();
    let silent = &Monitor::silent();
    assert!(matches!(nothing.solve(1, Placement::Free, &points, silent), Err(Error::Empty)));
    let mut found = one.solve(1, Placement::Free, &points, silent).unwrap();
    found.certificate.core_set = vec![0, 7];
    assert!(matches!(
        lift(&one, found, &points),
        Err(Error::Input(InputError::Option { name: "found", .. }))
    ));
    // Solved for other points.
    let mut found = one.solve(1, Placement::Free, &points, silent).unwrap();
    let others = Points::new(&[1.0, 3.0], 1).unwrap();
    found.certificate.points_hash = hash_points(&others, silent).unwrap();
    assert!(matches!(
        lift(&one, found, &points),
        Err(Error::Input(InputError::Option { name: "found", .. }))
    ));
    // Of 0 and 2 alone no row is nearer than 2 to both; of 0, 1 and 2 there is one.
    let points = Points::new(&[0.0, 2.0, 1.0], 1).unwrap();
    let ends = CoreSetSummary::of(&Points::new(&[0.0, 2.0], 1).unwrap(), 0, 2).unwrap();
    let options = CentersOptions { placement: Placement::Rows, ..Default::default() };
    let found = centers(&ends.points().unwrap(), 1, &options).unwrap();
    assert!(found.answer.lower_bound > 1.9);
    assert!(matches!(
        lift(&ends, found, &points),
        Err(Error::Input(InputError::Option { name: "found", .. }))
    ));
    // Two points of three, and two centers: nothing is proved of the third.
    let points = Points::new(&[1.0, 2.0, 4.0], 1).unwrap();
    let one = CoreSetSummary::of(&points, 0, 2).unwrap();
    let wrong = one.solve(2, Placement::Free, &points, silent);
    assert!(matches!(wrong, Err(Error::Input(InputError::Option { name: "found", .. }))));
    let all = CoreSetSummary::of(&points, 0, 3)
        .unwrap()
        .solve(2, Placement::Free, &points, silent)
        .unwrap();
    judge(&all, points.values(), 1);
}

fn lift(
    summary: &CoreSetSummary,
    found: Solution<Centers>,
    points: &Points<'_, f64>,
) -> Result<Solution<Centers>, Error> {
    summary.lift(found, points, &Monitor::silent())
}
