//! The algorithms of the literature against plain ones.

use proptest::prelude::*;
use taut_reference::algorithms::{
    Distributor, DistributorForm, LIST_END, MatrixSizes, columnsort, distribution_sort,
    distribution_sort_over_library, distributor_sort, funnelsort, list_ranks, mergesort, multiply,
    quicksort, reverse, select, strassen, transpose,
};

/// Many lengths, many ties.
fn arrays() -> impl Strategy<Value = Vec<u32>> {
    let length = prop_oneof![0usize..70, 0usize..1500];
    (length, 1u32..2000).prop_flat_map(|(n, spread)| prop::collection::vec(0..spread, n))
}

const FORMS: [DistributorForm; 2] = [DistributorForm::Recursive, DistributorForm::Unfolded];

/// A key that is compared and a number that is not.
#[derive(Clone, Copy, Debug)]
struct Tagged(u32, usize);

impl PartialEq for Tagged {
    fn eq(&self, other: &Self) -> bool {
        self.0 == other.0
    }
}

impl Eq for Tagged {}

impl PartialOrd for Tagged {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Tagged {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.cmp(&other.0)
    }
}

fn leads_to(next: &[u32], mut element: usize, end: usize) -> bool {
    while element != end && next[element] != LIST_END {
        element = next[element] as usize;
    }
    element == end
}

fn sorted(mut array: Vec<u32>, sort: impl FnOnce(&mut [u32])) -> Vec<u32> {
    sort(&mut array);
    array
}

fn sorts_agree(array: &[u32], seed: u64) {
    let array = array.to_vec();
    let expected = sorted(array.clone(), |a| a.sort_unstable());
    assert_eq!(sorted(array.clone(), mergesort), expected, "mergesort");
    assert_eq!(sorted(array.clone(), |a| quicksort(a, seed)), expected, "quicksort");
    assert_eq!(sorted(array.clone(), funnelsort), expected, "funnelsort");
    assert_eq!(sorted(array.clone(), |a| distribution_sort(a, seed)), expected, "distribution");
    for levels in 0..3 {
        let found = sorted(array.clone(), |a| distribution_sort_over_library(a, seed, levels));
        assert_eq!(found, expected, "distribution, {levels} levels over the library's sort");
    }
    for form in FORMS {
        let found = sorted(array.clone(), |a| distributor_sort(a, form, seed));
        assert_eq!(found, expected, "distributor, {form:?}");
    }
    assert_eq!(sorted(array, columnsort), expected, "columnsort");
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 150, ..ProptestConfig::default() })]

    #[test]
    fn sorts_sort(array in arrays(), seed in any::<u64>()) {
        sorts_agree(&array, seed);
    }

    #[test]
    fn stable_sorts_are_stable(array in arrays()) {
        let tagged: Vec<Tagged> = array.iter().enumerate().map(|(i, &x)| Tagged(x, i)).collect();
        for sort in [mergesort::<Tagged>, funnelsort::<Tagged>] {
            let mut found = tagged.clone();
            sort(&mut found);
            prop_assert!(found.windows(2).all(|w| (w[0].0, w[0].1) < (w[1].0, w[1].1)));
        }
    }

    /// Each bucket has its elements, in the order of the input; also with far more than k³ of them, and with few.
    #[test]
    fn distributors_deal(array in arrays(), mut splitters in prop::collection::vec(0u32..2000, 0..70)) {
        splitters.sort_unstable();
        let tagged: Vec<Tagged> = array.iter().enumerate().map(|(i, &x)| Tagged(x, i)).collect();
        let limits: Vec<Tagged> = splitters.iter().map(|&x| Tagged(x, 0)).collect();
        for form in FORMS {
            let distributor = Distributor::new(&limits, form).expect("ascending");
            let buckets = distributor.distribute(&tagged);
            prop_assert_eq!(buckets.len(), splitters.len() + 1);
            for j in 0..buckets.len() {
                let belongs = |x: u32| {
                    (j == 0 || splitters[j - 1] <= x) && (j == splitters.len() || x < splitters[j])
                };
                let expected: Vec<usize> = (0..array.len()).filter(|&i| belongs(array[i])).collect();
                let found: Vec<usize> = buckets.bucket(j).into_iter().map(|x| x.1).collect();
                prop_assert_eq!(buckets.count(j), expected.len());
                prop_assert_eq!(found, expected);
            }
        }
    }

    #[test]
    fn selection_selects(array in arrays(), k in 0usize..1500) {
        let mut part = array.clone();
        let expected = sorted(array, |a| a.sort_unstable());
        prop_assert_eq!(select(&mut part, k), expected.get(k).copied());
        if let Some(x) = expected.get(k) {
            prop_assert!(part[..k].iter().all(|y| y <= x) && part[k..].iter().all(|y| y >= x));
            prop_assert_eq!(sorted(part, |a| a.sort_unstable()), expected);
        }
    }

    #[test]
    fn transposition_transposes(rows in 0usize..40, columns in 0usize..40, base in 1usize..9) {
        let from: Vec<usize> = (0..rows * columns).collect();
        let mut to = vec![0; from.len()];
        transpose(&from, &mut to, rows, columns, base).expect("sizes fit");
        for i in 0..rows {
            for j in 0..columns {
                prop_assert_eq!(to[j * rows + i], from[i * columns + j]);
            }
        }
    }

    /// Small integers, so that sums are exact in any order.
    #[test]
    fn products_equal_the_definition(
        (n, m, p) in (0usize..20, 0usize..20, 0usize..20),
        base in 1usize..6,
        seed in any::<u32>(),
    ) {
        let entry = |i: usize| f64::from((seed.wrapping_mul(i as u32 * 2 + 1) >> 24) as i8);
        let define = |a: &[f64], b: &[f64], m: usize, p: usize, i: usize, j: usize| -> f64 {
            (0..m).map(|k| a[i * m + k] * b[k * p + j]).sum()
        };
        let a: Vec<f64> = (0..n * m).map(entry).collect();
        let b: Vec<f64> = (0..m * p).map(|i| entry(i + 1000)).collect();
        let mut c = vec![1.0; n * p];
        let sizes = MatrixSizes { rows: n, inner: m, columns: p };
        multiply(&a, &b, &mut c, sizes, base).expect("sizes fit");
        for i in 0..n * p {
            prop_assert_eq!(c[i], 1.0 + define(&a, &b, m, p, i / p, i % p));
        }
        let a: Vec<f64> = (0..n * n).map(entry).collect();
        let b: Vec<f64> = (0..n * n).map(|i| entry(i + 500)).collect();
        let mut c = vec![7.0; n * n];
        strassen(&a, &b, &mut c, n, base).expect("sizes fit");
        for i in 0..n * n {
            prop_assert_eq!(c[i], define(&a, &b, n, n, i / n, i % n));
        }
    }

    /// Each element points to an earlier one in a random order, or to none: lists that may run into one another.
    #[test]
    fn ranks_are_steps_to_the_end(
        (n, jump) in (0usize..400, 1usize..50),
        keys in prop::collection::vec(any::<u32>(), 400),
        seed in any::<u64>(),
    ) {
        let mut order: Vec<usize> = (0..n).collect();
        order.sort_by_key(|&i| keys[i]);
        let mut next = vec![LIST_END; n];
        let mut expected = vec![0u64; n];
        for place in 0..n {
            let back = 1 + keys[place] as usize % jump;
            if back <= place {
                next[order[place]] = order[place - back] as u32;
                expected[order[place]] = expected[order[place - back]] + 1;
            }
        }
        prop_assert_eq!(list_ranks(&next, seed).expect("no circle"), expected);
        if n > 0 {
            // From an end to an element that leads to it, or to itself.
            let end = order[0];
            let last = (0..n).rev().map(|p| order[p]).find(|&e| leads_to(&next, e, end));
            next[end] = last.expect("the end leads to itself") as u32;
            let message = list_ranks(&next, seed).expect_err("a circle").to_string();
            prop_assert!(message.contains("circle"), "{}", message);
        }
    }

    #[test]
    fn reversal_reverses(array in arrays()) {
        let mut found = array.clone();
        reverse(&mut found);
        prop_assert!(found.iter().eq(array.iter().rev()));
    }
}

#[test]
fn sorts_sort_all_patterns() {
    for n in [0, 1, 2, 3, 31, 32, 33, 63, 64, 65, 127, 128, 129, 1023, 1024, 1025, 4097] {
        let patterns: [fn(u32, u32) -> u32; 8] = [
            |_, _| 5,
            |i, _| i,
            |i, n| n - i,
            |i, _| i % 2,
            |i, n| i * 7919 % n,
            |i, n| i.min(n - i),
            |i, n| if i == n / 2 { 1 } else { 0 },
            |i, _| i.wrapping_mul(2_654_435_761) >> 30,
        ];
        for pattern in patterns {
            let array: Vec<u32> = (0..n).map(|i| pattern(i, n)).collect();
            sorts_agree(&array, 1);
        }
    }
}

#[test]
fn wrong_sizes_are_refused_by_name() {
    assert!(Distributor::new(&vec![1; 1 << 14], DistributorForm::Recursive).is_err());
    assert!(Distributor::new(&[2, 1], DistributorForm::Unfolded).is_err());
    assert!(list_ranks(&[1, 2], 1).is_err());
    let mut c = [0.0; 6];
    let message = transpose(&[0.0; 6], &mut c, 4, 2, 1).expect_err("6 is not 8").to_string();
    assert_eq!(
        message,
        "option `from` is 6 elements for 4 x 2: expected as many elements as rows times columns"
    );
    assert!(transpose(&[0.0; 8], &mut c, 4, 2, 1).is_err());
    assert!(transpose(&[0.0; 6], &mut c, 3, 2, 0).is_err());
    assert!(transpose(&[0.0; 0], &mut [], usize::MAX, 2, 1).is_err());
    assert!(transpose(&[0.0; 0], &mut [], usize::MAX, 0, 1).is_ok());
    let long = MatrixSizes { rows: usize::MAX, inner: 0, columns: 0 };
    assert!(multiply(&[], &[], &mut [], long, 1).is_ok());
    assert!(strassen(&[0.0; 4], &[0.0; 4], &mut c, 2, 1).is_err());
    assert!(multiply(&[0.0; 4], &[0.0; 4], &mut c, MatrixSizes::square(2), 1).is_err());
}

/// A comparison that panics leaves an array of elements that were there before.
#[test]
fn sorts_survive_a_comparison_that_panics() {
    use std::cell::Cell;
    use std::cmp::Ordering;
    use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};

    thread_local! {
        static LEFT: Cell<u32> = const { Cell::new(0) };
    }

    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    struct Fuse(u32);

    impl PartialOrd for Fuse {
        fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
            Some(self.cmp(other))
        }
    }

    impl Ord for Fuse {
        fn cmp(&self, other: &Self) -> Ordering {
            let left = LEFT.get();
            if left == 0 {
                resume_unwind(Box::new("the fuse is burnt"));
            }
            LEFT.set(left - 1);
            self.0.cmp(&other.0)
        }
    }

    let sorts: [fn(&mut [Fuse]); 7] = [
        mergesort,
        funnelsort,
        columnsort,
        |a| quicksort(a, 1),
        |a| distribution_sort(a, 1),
        |a| distributor_sort(a, DistributorForm::Unfolded, 1),
        |a| assert!(select(a, 100).is_some()),
    ];
    for sort in sorts {
        for fuse in [0, 1, 10, 100, 1000] {
            let mut array: Vec<Fuse> = (0..300).map(|i| Fuse(i * 7919 % 300)).collect();
            LEFT.set(fuse);
            assert!(catch_unwind(AssertUnwindSafe(|| sort(&mut array))).is_err(), "{fuse}");
            assert!(array.iter().all(|x| x.0 < 300));
        }
    }
}
