//! Uniformity, by counting all that can happen; the same result for any threads; the ends of every range.

use std::collections::HashMap;
use std::hash::Hash;

use proptest::prelude::*;

use super::divide::{Node, divide};
use super::random::Random;
use super::weights::{binomial, hypergeometric};
use super::*;
use crate::error::Error;
use crate::test_length::long_or;

/// The normal deviate that χ² amounts to (Wilson and Hilferty); above 4.5 it is one of 300 000.
fn deviate<T: Eq + Hash>(seen: &HashMap<T, u32>, expected: &[(T, f64)]) -> f64 {
    let draws: u32 = seen.values().sum();
    let listed: u32 = expected.iter().map(|(what, _)| seen.get(what).copied().unwrap_or(0)).sum();
    assert_eq!(listed, draws, "nothing else was drawn");
    let chi: f64 = expected
        .iter()
        .map(|(what, probability)| {
            let mean = probability * f64::from(draws);
            assert!(mean >= 5.0, "enough draws for χ²");
            (f64::from(seen.get(what).copied().unwrap_or(0)) - mean).powi(2) / mean
        })
        .sum();
    let degrees = expected.len() as f64 - 1.0;
    if degrees == 0.0 {
        return 0.0;
    }
    let spread = 2.0 / (9.0 * degrees);
    ((chi / degrees).cbrt() - (1.0 - spread)) / spread.sqrt()
}

/// All sets of `k` numbers below `n`.
fn sets(n: u64, k: usize) -> Vec<Vec<u64>> {
    (0u32..1 << n)
        .filter(|bits| bits.count_ones() as usize == k)
        .map(|bits| (0..n).filter(|i| bits >> i & 1 == 1).collect())
        .collect()
}

/// Draws sets in some way and holds each of them to the same probability.
fn all_sets_alike(draw: impl Fn(u64, u64, usize) -> Vec<u64>) {
    for n in 0..=if cfg!(miri) { 5 } else { 12 } {
        for k in 0..=n as usize {
            let sets = sets(n, k);
            let mut seen = HashMap::new();
            for seed in 0..if cfg!(miri) { 6 } else { 20 } * sets.len() as u64 {
                *seen.entry(draw(seed, n, k)).or_insert(0) += 1;
            }
            let share = 1.0 / sets.len() as f64;
            let expected: Vec<_> = sets.into_iter().map(|set| (set, share)).collect();
            let z = deviate(&seen, &expected);
            assert!(z < 4.5, "{k} of {n}: {z}");
        }
    }
}

#[test]
fn every_set_is_equally_likely_by_halves() {
    all_sets_alike(|seed, n, k| {
        let mut found = vec![0; k];
        divide::<1>(Node { seed, number: 1, start: 0, n }, &mut found);
        found
    });
}

#[test]
fn every_set_is_equally_likely_in_one_leaf() {
    all_sets_alike(|seed, n, k| sample(seed, n, k as u64).expect("k is at most n"));
}

#[test]
fn every_set_is_equally_likely_one_by_one() {
    all_sets_alike(|seed, n, k| {
        let found = Sequential::new(seed, n, k as u64).expect("k is at most n");
        assert_eq!(found.size_hint(), (k, Some(k)));
        found.collect()
    });
}

#[test]
fn every_set_is_equally_likely_in_a_reservoir() {
    all_sets_alike(|seed, n, k| {
        let mut reservoir = Reservoir::new(seed, k);
        let mut next = 0;
        while next < n {
            // Every other seed leaves out what would pass.
            let out = if seed % 2 == 0 { 0 } else { reservoir.passing().min(n - next) };
            reservoir.leave_out(out);
            next += out;
            if next < n {
                reservoir.push(next);
                next += 1;
            }
        }
        assert_eq!(reservoir.seen(), n);
        let mut items = reservoir.into_items();
        items.sort_unstable();
        items
    });
}

/// Few of many: where double numbers are rare, and distances are drawn.
#[test]
fn pairs_of_many_are_equally_likely() {
    let n = 60;
    let expected: Vec<_> = sets(12, 2).into_iter().map(|set| (set, 1.0 / 66.0)).collect();
    let check = |draw: &dyn Fn(u64) -> Vec<u64>| {
        let mut seen = HashMap::new();
        for seed in 0..if cfg!(miri) { 200 } else { 100_000 } {
            let found: Vec<u64> = draw(seed);
            // Those that lie in the first twelve are again a uniform pair.
            if found.iter().all(|&i| i < 12) {
                *seen.entry(found).or_insert(0) += 1;
            }
        }
        if !cfg!(miri) {
            let z = deviate(&seen, &expected);
            assert!(z < 4.5, "{z}");
        }
    };
    check(&|seed| sample(seed, n, 2).expect("a pair"));
    check(&|seed| Sequential::new(seed, n, 2).expect("a pair").collect());
}

#[test]
fn each_number_is_kept_with_its_probability() {
    for p in [0.25, 0.5, 0.8] {
        let mut seen = HashMap::new();
        for seed in 0..if cfg!(miri) { 60 } else { 40_000 } {
            *seen.entry(bernoulli(seed, 4, p).expect("a probability")).or_insert(0) += 1;
        }
        let expected: Vec<_> = (0..=4)
            .flat_map(|k| sets(4, k))
            .map(|set| {
                let k = set.len() as i32;
                (set, p.powi(k) * (1.0 - p).powi(4 - k))
            })
            .collect();
        if cfg!(miri) {
            continue; // So few say nothing.
        }
        let z = deviate(&seen, &expected);
        assert!(z < 4.5, "{p}: {z}");
    }
}

#[test]
fn every_order_is_equally_likely() {
    fn orders(n: u8) -> Vec<Vec<u8>> {
        if n == 0 {
            return vec![Vec::new()];
        }
        let insert = |order: &Vec<u8>, at: usize| {
            let mut longer = order.clone();
            longer.insert(at, n - 1);
            longer
        };
        orders(n - 1)
            .iter()
            .flat_map(|o| (0..n as usize).map(|at| insert(o, at)).collect::<Vec<_>>())
            .collect()
    }
    let check = |draw: &dyn Fn(&mut [u8], u64)| {
        for n in 0..=if cfg!(miri) { 2 } else { 6 } {
            let orders = orders(n);
            let mut seen = HashMap::new();
            let each = if n < 6 { 60 } else { long_or(60, 12) };
            for seed in 0..if cfg!(miri) { 6 } else { each } * orders.len() as u64 {
                let mut items: Vec<u8> = (0..n).collect();
                draw(&mut items, seed);
                *seen.entry(items).or_insert(0) += 1;
            }
            let share = 1.0 / orders.len() as f64;
            let expected: Vec<_> = orders.into_iter().map(|order| (order, share)).collect();
            let z = deviate(&seen, &expected);
            assert!(z < 4.5, "{n}: {z}");
        }
    };
    check(&|items, seed| shuffle(items, seed));
    // The same by dealing down to three items.
    check(&|items, seed| {
        shuffle::part::<u8, crate::NoProbe, 0>(items, seed, 1, &mut crate::NoProbe)
    });
}

/// Two large numbers: mean and variance within five standard errors.
fn moments(draw: impl Fn(&mut Random) -> u64, mean: f64, variance: f64) {
    let draws = long_or(20_000, 6000);
    let mut random = Random::new(3, 3);
    let found: Vec<f64> = (0..draws).map(|_| draw(&mut random) as f64 - mean).collect();
    let n = f64::from(draws);
    let off = found.iter().sum::<f64>() / n;
    let spread = found.iter().map(|x| x * x).sum::<f64>() / n;
    assert!(off.abs() < 5.0 * (variance / n).sqrt(), "{off} from {mean}");
    assert!((spread / variance - 1.0).abs() < 5.0 * (2.0 / n).sqrt(), "{spread}, not {variance}");
}

#[test]
#[cfg_attr(miri, ignore = "two hundred thousand steps of floating point")]
fn large_numbers_have_the_right_moments() {
    // Up to the whole range, where logarithms of factorials would have no digit left.
    for population in [1 << 20, 1 << 40, u64::MAX] {
        let (first, draws) = (population / 3, 5000);
        let (share, all) = (first as f64 / population as f64, population as f64);
        let mean = f64::from(draws) * share;
        let variance = mean * (1.0 - share) * (all - f64::from(draws)) / (all - 1.0);
        moments(|r| hypergeometric(r, population, first, draws as u64), mean, variance);
    }
    moments(|r| binomial(r, 1 << 50, 1e-11), 1e-11 * 2f64.powi(50), 1e-11 * 2f64.powi(50));
    moments(|r| binomial(r, 1000, 0.7), 700.0, 210.0);
}

/// The differences of a large sample: as many in each of 64 equal parts as there should be.
#[test]
#[cfg_attr(miri, ignore = "a large sample")]
fn a_large_sample_is_spread_evenly() {
    for n in [1 << 18, 1 << 22, 1 << 40, u64::MAX] {
        let k = 1 << 17;
        let found = sample(5, n, k).expect("k is less");
        assert!(found.is_sorted_by(|a, b| a < b) && found[k as usize - 1] < n);
        let mut seen = HashMap::new();
        found.iter().for_each(|&i| {
            *seen.entry((u128::from(i) * 64 / u128::from(n)) as u64).or_insert(0) += 1
        });
        let expected: Vec<_> = (0..64).map(|part| (part, 1.0 / 64.0)).collect();
        assert!(deviate(&seen, &expected) < 4.5);
        let sequential: Vec<u64> = match Sequential::new(5, n.min(1 << 50), k) {
            Ok(found) => found.collect(),
            Err(error) => panic!("{error}"),
        };
        assert!(sequential.is_sorted_by(|a, b| a < b) && sequential.len() == k as usize);
        let mut seen = HashMap::new();
        let all = u128::from(n.min(1 << 50));
        sequential
            .iter()
            .for_each(|&i| *seen.entry((u128::from(i) * 64 / all) as u64).or_insert(0) += 1);
        assert!(deviate(&seen, &expected) < 4.5, "{n}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(if cfg!(miri) { 4 } else { 64 }))]

    #[test]
    fn samples_are_sets_below_n(seed in any::<u64>(), n in 0..if cfg!(miri) { 1000 } else { 40_000u64 }, share in 0.0..=1.0) {
        let k = (n as f64 * share) as u64;
        let found = sample(seed, n, k).expect("k is at most n");
        prop_assert_eq!(found.len() as u64, k);
        prop_assert!(found.is_sorted_by(|a, b| a < b));
        prop_assert!(found.last().is_none_or(|&last| last < n));
        prop_assert_eq!(&found, &sample(seed, n, k).expect("k is at most n"));
        let mut items: Vec<u64> = (0..n).collect();
        shuffle(&mut items, seed);
        items.sort_unstable();
        prop_assert!(items.into_iter().eq(0..n));
    }
}

#[test]
fn threads_change_nothing() {
    let k = if cfg!(miri) { 500 } else { 100_000 };
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        pool.install(|| {
            let mut items: Vec<u32> = (0..k as u32).collect();
            shuffle(&mut items, 4);
            (sample(4, 1 << 50, k), bernoulli(4, 1 << 30, k as f64 / 2f64.powi(30)), items)
        })
    };
    let (sampled, kept, items) = on(1);
    let (sampled, kept) = (sampled.expect("a sample"), kept.expect("a sample"));
    assert!(!items.is_sorted());
    for threads in [2, 3, 8] {
        let other = on(threads);
        assert_eq!(sampled, other.0.expect("a sample"));
        assert_eq!(kept, other.1.expect("a sample"));
        assert_eq!(items, other.2);
    }
}

/// Keys and values that are shuffled apart stay together, whatever they weigh, where all are exchanged and where not.
#[test]
#[cfg_attr(miri, ignore = "two hundred thousand items")]
fn the_order_does_not_depend_on_the_size_of_an_item() {
    for n in [100, 5000, 50_000, 200_000] {
        let mut places: Vec<u32> = (0..n).collect();
        let mut wide: Vec<[u32; 9]> = (0..n).map(|i| [i; 9]).collect();
        let mut bytes: Vec<u8> = (0..n).map(|i| i as u8).collect();
        shuffle(&mut places, 9);
        shuffle(&mut wide, 9);
        shuffle(&mut bytes, 9);
        assert!(!places.is_sorted());
        assert!(places.iter().eq(wide.iter().map(|item| &item[8])), "{n}");
        assert!(places.iter().map(|&i| i as u8).eq(bytes), "{n}");
    }
}

/// The same on every machine and in every version, or a CHANGELOG entry says otherwise.
#[test]
fn samples_do_not_change() {
    assert_eq!(sample(1, 1 << 40, 4).expect("a sample"), GOLDEN_SAMPLE);
    let mut items: Vec<u64> = (0..8).collect();
    shuffle(&mut items, 1);
    assert_eq!(items, GOLDEN_ORDER);
    if cfg!(miri) {
        return; // The large ones take an interpreter too long.
    }
    let large = sample(1, u64::MAX, 10_000).expect("a sample");
    assert_eq!(
        large.iter().fold(0, |sum: u64, i| sum.wrapping_mul(31).wrapping_add(*i)),
        GOLDEN_SUM
    );
    // More than are exchanged all over.
    let mut many: Vec<u32> = (0..40_000).collect();
    shuffle(&mut many, 1);
    assert_eq!(
        many.iter().fold(0, |sum: u64, i| sum.wrapping_mul(31).wrapping_add(u64::from(*i))),
        GOLDEN_ORDER_SUM
    );
}

const GOLDEN_SAMPLE: [u64; 4] =
    [410_210_869_080, 502_395_611_716, 607_016_772_173, 764_878_170_149];
const GOLDEN_SUM: u64 = 3_457_985_094_995_008_156;
const GOLDEN_ORDER_SUM: u64 = 16_645_899_823_467_553_858;
const GOLDEN_ORDER: [u64; 8] = [0, 1, 7, 6, 5, 2, 4, 3];

#[test]
fn the_ends_of_every_range() {
    assert!(sample(1, 0, 0).expect("nothing").is_empty());
    assert_eq!(sample(1, 1, 1).expect("all"), [0]);
    let n = if cfg!(miri) { 300 } else { 10_000 };
    assert!(sample(1, n, n).expect("all").into_iter().eq(0..n));
    assert_eq!(sample(1, n, n - 1).expect("all but one").len() as u64, n - 1);
    assert!(matches!(sample(1, 3, 4), Err(Error::Option { name: "k", .. })));
    assert!(matches!(sample(1, u64::MAX, u64::MAX), Err(Error::Option { name: "k", .. })));
    assert!(matches!(Sequential::new(1, 3, 4), Err(Error::Option { name: "k", .. })));
    assert!(matches!(Sequential::new(1, u64::MAX, 4), Err(Error::Option { name: "n", .. })));
    for p in [-0.1, 1.1, f64::NAN] {
        assert!(matches!(bernoulli(1, 9, p), Err(Error::Option { name: "p", .. })));
    }
    assert!(bernoulli(1, u64::MAX, 0.5).is_err());
    assert!(bernoulli(1, 9, 0.0).expect("none").is_empty());
    assert_eq!(bernoulli(1, 9, 1.0).expect("all").len(), 9);
    let mut none = Reservoir::new(1, 0);
    (0..10).for_each(|i| none.push(i));
    none.leave_out(5);
    assert_eq!((none.items(), none.seen()), (&[][..], 15));
    none.leave_out(none.passing());
    none.leave_out(none.passing());
    none.push(1);
    assert_eq!((none.items(), none.seen()), (&[][..], u64::MAX));
    // Items without a size are dealt, too.
    let many = if cfg!(miri) { 2000 } else { 40_000 };
    let mut nothing = vec![(); many];
    shuffle(&mut nothing, 1);
    assert_eq!(nothing.len(), many);
    let mut one = [7];
    shuffle(&mut one, 1);
    shuffle::<u8>(&mut [], 1);
    assert_eq!(one, [7]);
}
