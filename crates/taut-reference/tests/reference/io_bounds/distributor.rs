//! The k-distributor in both forms.

use taut_reference::algorithms::{Distributor, DistributorForm};

use super::{Shape, largest, log, misses, numbers, row};

const FORMS: [DistributorForm; 2] = [DistributorForm::Recursive, DistributorForm::Unfolded];

/// M ≥ B², at least 512 words and 32 blocks.
const GRID: [Shape; 13] = [
    (512, 8),
    (512, 16),
    (1024, 8),
    (4096, 8),
    (1024, 16),
    (4096, 16),
    (16384, 16),
    (1024, 32),
    (4096, 32),
    (16384, 32),
    (4096, 64),
    (16384, 64),
    (65536, 64),
];

fn distributor(levels: u32, form: DistributorForm) -> Distributor<u64> {
    let splitters: Vec<u64> = (1..1u64 << levels).map(|j| j << (64 - levels)).collect();
    Distributor::new(&splitters, form).expect("ascending")
}

#[test]
fn distributors_are_of_size_4k2() {
    for form in FORMS {
        let beyond = (1..=12).map(|levels| {
            let (k, words) = (2f64.powi(levels as i32), distributor(levels, form).words() as f64);
            (words - 4.0 * k * k) / k
        });
        row(
            &format!("{form:?} distributor, k = 2..4096"),
            "words beyond 4k², by k",
            largest(beyond),
            4.0,
        );
    }
}

fn distributors_keep_the_bound(levels: std::ops::RangeInclusive<u32>) {
    for form in FORMS {
        for levels in levels.clone() {
            let k = 1usize << levels;
            let input = numbers(k * k * k, 1);
            let found = misses(&GRID, |probe| {
                let buckets = distributor(levels, form).distribute_instrumented(&input, probe);
                assert_eq!((0..k).map(|j| buckets.count(j)).sum::<usize>(), k * k * k);
            });
            let bound = |(m, b): Shape| {
                let (k, scan) = (k as f64, (k * k * k) as f64 / b as f64);
                6.0 * scan * (1.0 + log(m as f64, k)) + 4.0 * k
            };
            let ratios = found.into_iter().zip(GRID).map(|(q, shape)| q / bound(shape));
            row(
                &format!("{form:?} distributor, k = {k}"),
                "6(k³/B)(1 + log_M k) + 4k",
                largest(ratios),
                1.0,
            );
        }
    }
}

#[test]
fn distributors_miss_little() {
    distributors_keep_the_bound(1..=5);
}

#[test]
#[ignore = "seconds even when optimized"]
fn distributors_miss_little_at_full_size() {
    distributors_keep_the_bound(6..=7);
}
