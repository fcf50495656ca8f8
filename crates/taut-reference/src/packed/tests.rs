//! Packed sets and maps against those of the standard library.

use std::collections::{BTreeMap, BTreeSet};

use proptest::prelude::*;

use super::*;

#[derive(Clone, Debug)]
enum Step {
    Insert(u16),
    Remove(u16),
    Batch(Vec<u16>),
    Ascend(u8),
    Hammer(u16, u8),
}

/// A map is put through fewer steps than this, as many as an interpreter has time for.
const STEPS_MAX: usize = if cfg!(miri) { 8 } else { 60 };

fn step() -> impl Strategy<Value = Step> {
    let key = 0u16..600;
    prop_oneof![
        4 => key.clone().prop_map(Step::Insert),
        4 => key.clone().prop_map(Step::Remove),
        1 => prop::collection::vec(key.clone(), 0..300).prop_map(Step::Batch),
        1 => any::<u8>().prop_map(Step::Ascend),
        1 => (key, any::<u8>()).prop_map(|(key, count)| Step::Hammer(key, count)),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(if cfg!(miri) { 2 } else { 256 }))]
    #[test]
    fn steps_give_the_map_of_the_standard_library(steps in prop::collection::vec(step(), 0..STEPS_MAX)) {
        let (mut map, mut want) = (PackedMap::new(), BTreeMap::new());
        let mut clock = 0u32;
        for step in steps {
            clock += 1;
            match step {
                Step::Insert(key) => {
                    prop_assert_eq!(map.insert(u64::from(key), clock), want.insert(u64::from(key), clock));
                }
                Step::Remove(key) => {
                    prop_assert_eq!(map.remove(u64::from(key)), want.remove(&u64::from(key)));
                }
                Step::Batch(keys) => {
                    let entries: Vec<_> =
                        (clock..).zip(&keys).map(|(value, &key)| (u64::from(key), value)).collect();
                    let before = want.len();
                    want.extend(entries.iter().copied());
                    prop_assert_eq!(map.insert_batch(&entries), want.len() - before);
                }
                Step::Ascend(count) => {
                    let last = map.last().map_or(0, |entry| entry.0);
                    for key in last + 1..last + 1 + u64::from(count) {
                        prop_assert_eq!(map.insert(key, clock), want.insert(key, clock));
                    }
                }
                Step::Hammer(key, count) => {
                    for below in 0..u64::from(count) {
                        let key = ((u64::from(key) + 1) << 20) - below;
                        prop_assert_eq!(map.insert(key, clock), want.insert(key, clock));
                    }
                    for below in (0..u64::from(count)).step_by(2) {
                        let key = ((u64::from(key) + 1) << 20) - below;
                        prop_assert_eq!(map.remove(key), want.remove(&key));
                    }
                }
            }
            prop_assert!(map.check().is_ok(), "{:?}", map.check());
            prop_assert_eq!(map.len(), want.len());
        }
        prop_assert!(map.iter().eq(want.iter().map(|(&key, &value)| (key, value))));
        for low in (0..620).step_by(31) {
            for high in [low, low + 1, low + 100, u64::MAX] {
                let wanted = want.range(low..high).map(|(&key, &value)| (key, value));
                prop_assert!(map.range(low..high).eq(wanted));
                let wanted = want.range(low..=high).map(|(&key, _)| key);
                prop_assert!(map.runs(low..=high).flat_map(|run| run.0.to_vec()).eq(wanted));
            }
            prop_assert_eq!(map.get(low), want.get(&low));
        }
    }
}

/// Leaves that are as full as all may be, and more behind them for as long as there is one more leaf.
#[test]
fn when_the_last_leaf_goes_the_others_are_not_too_full() {
    for (last, more) in [(240, 1), (240, 40), (480, 40)] {
        let mut set = PackedSet::<u64>::new();
        (1..=last).for_each(|key| assert!(set.insert(key << 8)));
        set.insert(1 << 40);
        (1..=more).for_each(|key| assert!(set.insert((key << 8) + 1)));
        assert!(set.check().is_ok());
        assert!(set.remove(1 << 40));
        assert!(set.check().is_ok(), "{last} and {more}: {:?}", set.check());
        assert_eq!(set.len(), (last + more) as usize);
    }
}

#[test]
fn nothing_one_key_and_extreme_keys() {
    let mut set = PackedSet::<f64>::new();
    assert!(set.check().is_ok() && set.is_empty() && set.first().is_none());
    assert_eq!(set.iter().count(), 0);
    assert!(!set.remove(0.0));
    for key in [f64::NAN, 0.0, -0.0, f64::NEG_INFINITY, -f64::NAN] {
        assert!(set.insert(key) && !set.insert(key) && set.contains(key));
    }
    assert!(set.check().is_ok());
    let bits: Vec<u64> = set.iter().map(f64::to_bits).collect();
    let want = [-f64::NAN, f64::NEG_INFINITY, -0.0, 0.0, f64::NAN].map(f64::to_bits);
    assert_eq!(bits, want);

    let mut set = PackedSet::<u64>::new();
    set.insert(u64::MAX);
    let n = if cfg!(miri) { 150 } else { 5000 };
    for key in (0..n).rev() {
        assert!(set.insert(key));
    }
    assert!(set.contains(u64::MAX) && set.last() == Some(u64::MAX));
    assert_eq!(set.range(n - 1..=u64::MAX).count(), 2);
    assert_eq!(set.range(n - 1..u64::MAX).count(), 1);
    #[allow(clippy::reversed_empty_ranges, reason = "no panic is what is tested")]
    let none = set.range(10..5).count();
    assert_eq!(none, 0);
    assert!(set.check().is_ok());
    assert!(set.remove(u64::MAX) && !set.contains(u64::MAX));
    for key in 0..n {
        assert!(set.remove(key));
    }
    assert!(set.is_empty() && set.check().is_ok() && set.slots() <= 64);
}

fn random(state: &mut u64) -> u64 {
    *state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
    *state ^ *state >> 29
}

/// Patterns of insertion, each with `n` distinct keys.
fn patterns(n: u64) -> Vec<(&'static str, Vec<u64>)> {
    let mut state = 1;
    let half = 1 << 40;
    let alternating = |i: u64| if i.is_multiple_of(2) { half - i } else { 2 * half - i };
    let mut bisected = vec![(0, 1u64 << 60)];
    for i in 0..n as usize {
        let (low, high) = bisected[i];
        bisected.extend([(low, (low + high) / 2), ((low + high) / 2, high)]);
    }
    vec![
        ("random", (0..n).map(|_| random(&mut state)).collect()),
        ("ascending", (0..n).collect()),
        ("front", (0..n).rev().collect()),
        (
            "middle, descending",
            (0..n / 2).chain((0..n / 2).map(|i| half - i)).chain([half + 1]).collect(),
        ),
        ("middle, ascending", [half].into_iter().chain(0..n).collect()),
        ("two places in turn", (0..n).map(alternating).collect()),
        ("bisection", bisected[..n as usize].iter().map(|(low, high)| (low + high) / 2).collect()),
    ]
}

/// The bound that is stated: 1.5 log² n moves an insertion, whatever the pattern.
#[test]
#[cfg_attr(miri, ignore = "too long for an interpreter")]
fn moves_are_few_in_all_patterns() {
    let n = 30_000;
    let bound = 1.5 * (n as f64).log2().powi(2);
    for (name, keys) in patterns(n) {
        let mut set = PackedSet::new();
        for &key in &keys {
            set.insert(key);
        }
        assert!(set.check().is_ok(), "{name}: {:?}", set.check());
        assert!(set.iter().eq(keys.iter().copied().collect::<BTreeSet<_>>()), "{name}");
        let moves = set.moves() as f64 / keys.len() as f64;
        assert!(moves <= bound, "{name}: {moves} > {bound}");
        // The same backwards.
        for &key in keys.iter().rev() {
            set.remove(key);
        }
        assert!(set.is_empty());
        let both = set.moves() as f64 / keys.len() as f64 - moves;
        assert!(both <= bound, "{name}, removed: {both} > {bound}");
    }
}

/// Insertions and deletions in turn: at the bounds of leaves, of windows and of the whole, where halves are uneven after
/// a place was hammered, and between two places.
#[test]
#[cfg_attr(miri, ignore = "too long for an interpreter")]
fn moves_are_few_where_insertions_and_deletions_alternate() {
    let n = 20_000u64;
    let check = |name: &str, operations: &mut dyn FnMut(&mut PackedSet<u64>) -> u64| {
        let mut set = PackedSet::new();
        let done = operations(&mut set);
        assert!(set.check().is_ok(), "{name}: {:?}", set.check());
        let moves = set.moves() as f64 / done as f64;
        let bound = 1.5 * (n as f64).log2().powi(2);
        assert!(moves <= bound, "{name}: {moves} > {bound}");
    };
    check("back and forth at the front", &mut |set| {
        (0..n).for_each(|i| {
            set.insert(100 * i);
        });
        for round in 0..20 {
            (0..500).for_each(|i| {
                set.insert(100 * i + 1 + round);
            });
            (0..500).for_each(|i| {
                set.remove(100 * i + 1 + round);
            });
        }
        n + 20_000
    });
    check("hammered, then elsewhere", &mut |set| {
        (0..n / 2).for_each(|i| {
            set.insert(1000 * i);
        });
        for i in 0..n / 2 {
            let second = i / 31 % 2;
            set.insert(1_000_001 + 5_000_000 * second + i);
            if i % 3 == 2 {
                set.remove(1_000_001 + 5_000_000 * second + i - 1);
            }
        }
        n + n / 6
    });
    check("emptied from the front", &mut |set| {
        (0..n).for_each(|i| {
            set.insert(i);
        });
        (0..n).for_each(|i| {
            set.remove(i);
        });
        2 * n
    });
    check("thinned to an eighth, then random", &mut |set| {
        (0..n).for_each(|i| {
            set.insert(i);
        });
        (0..n).filter(|i| i % 8 != 0).for_each(|i| {
            set.remove(i);
        });
        let mut state = 7;
        (0..n).for_each(|_| {
            set.insert(random(&mut state));
        });
        3 * n
    });
    check("in and out around the bound of all", &mut |set| {
        (0..n).for_each(|i| {
            set.insert(4 * i);
        });
        let mut k = 0;
        while set.slots() * 3 / 4 > set.len() + 1 {
            set.insert(4 * k + 1);
            k += 1;
        }
        for round in 0..2000u64 {
            let key = |j: u64| 4 * (round % 100) + 2 + j % 2;
            (0..4).for_each(|j| {
                set.insert(key(j));
            });
            (0..4).for_each(|j| {
                set.remove(key(j));
            });
        }
        n + k + 16_000
    });
    check("one key in and out", &mut |set| {
        (0..48 * 400).for_each(|i| {
            set.insert(i);
        });
        for _ in 0..n {
            set.insert(1 << 40);
            set.remove(1 << 40);
        }
        48 * 400 + 2 * n
    });
    check("random in, random out", &mut |set| {
        let (mut ins, mut outs) = (11, 11);
        for i in 0..4 * n {
            set.insert(random(&mut ins));
            if i >= n {
                set.remove(random(&mut outs));
            }
        }
        7 * n
    });
}

#[test]
fn ascending_keys_are_not_moved() {
    let mut set = PackedSet::new();
    let n = if cfg!(miri) { 600 } else { 20_000u64 };
    for key in 0..n {
        set.insert(key);
    }
    assert_eq!(set.moves(), 0);
    assert!(set.slots() < n as usize * 3 / 2);
}

#[test]
fn a_batch_at_one_place_and_one_of_all() {
    let (all, some) = if cfg!(miri) { (300, 80) } else { (20_000, 2000) };
    let mut set: PackedSet<u64> = (0..all).map(|i| i * 1000).collect();
    let batch: Vec<u64> = (0..some).map(|i| 250 * all + 1 + i % 999 + i / 999 * 1000).collect();
    let mut want: BTreeSet<u64> = set.iter().collect();
    let before = want.len();
    want.extend(&batch);
    assert_eq!(set.insert_batch(&batch), want.len() - before);
    assert!(set.check().is_ok(), "{:?}", set.check());
    assert!(set.iter().eq(want.iter().copied()));
    assert_eq!(set.insert_batch(&want.iter().copied().collect::<Vec<_>>()), 0);
    assert!(set.check().is_ok());
    assert_eq!(set.insert_batch(&[]), 0);
}

/// Each field of a set is broken in turn; the checker has to say so.
#[test]
fn the_checker_refuses_what_is_wrong() {
    let broken = |name: &str, breaks: &dyn Fn(&mut PackedMap<u64, ()>)| {
        let mut map = PackedMap::new();
        map.insert_batch(
            &(0..if cfg!(miri) { 300 } else { 1000u64 }).map(|i| (2 * i, ())).collect::<Vec<_>>(),
        );
        assert!(map.check().is_ok());
        breaks(&mut map);
        assert!(map.check().is_err(), "{name}");
    };
    broken("order", &|map| map.keys.words_mut().swap(1, 2));
    broken("equal keys", &|map| map.keys.words_mut()[1] = 0);
    broken("a count", &|map| map.counts[3] -= 1);
    broken("an empty leaf", &|map| {
        map.len -= map.counts[3] as usize;
        map.counts[3] = 0;
    });
    broken("the number of entries", &|map| map.len += 1);
    broken("a separator", &|map| map.separators.set(4, 5, &mut crate::NoProbe));
    broken("a separator above its leaf", &|map| {
        let word = map.separators.get(4).unwrap();
        map.separators.set(4, word + 1, &mut crate::NoProbe);
    });
}
