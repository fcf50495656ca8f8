use std::cell::{Cell, RefCell};
use std::cmp::Reverse;
use std::collections::BinaryHeap;
use std::io::{self, ErrorKind};

use proptest::prelude::*;

use super::*;
use crate::Store;

/// A file in memory that is interrupted, reads and writes in parts, and fails in some calls.
struct Faulty {
    bytes: RefCell<Vec<u8>>,
    calls: Cell<u64>,
    /// Of the first 3000 calls each one of so many fails; 0 for none.
    fails: u64,
}

impl Faulty {
    fn call(&self, n: usize) -> io::Result<usize> {
        self.calls.set(self.calls.get() + 1);
        match self.calls.get() {
            call if call < 3000 && self.fails > 0 && call % self.fails == 0 => {
                Err(ErrorKind::StorageFull.into())
            }
            call if call % 7 == 0 => Err(ErrorKind::Interrupted.into()),
            call if call % 3 == 0 => Ok(n.div_ceil(2)),
            _ => Ok(n),
        }
    }
}

impl Store for Faulty {
    fn read_at(&self, buffer: &mut [u8], at: u64) -> io::Result<usize> {
        let n = self.call(buffer.len())?;
        buffer[..n].copy_from_slice(&self.bytes.borrow()[at as usize..][..n]);
        Ok(n)
    }

    fn write_at(&self, part: &[u8], at: u64) -> io::Result<usize> {
        let n = self.call(part.len())?;
        let mut bytes = self.bytes.borrow_mut();
        let end = (at as usize + n).max(bytes.len());
        bytes.resize(end, 0);
        bytes[at as usize..][..n].copy_from_slice(&part[..n]);
        Ok(n)
    }
}

fn faulty(limit: usize, fails: u64) -> Blocks<Faulty> {
    let file = Faulty { bytes: RefCell::default(), calls: Cell::new(0), fails };
    Blocks::over::<u32>(file, Path::new("memory"), limit)
}

/// Numbers without pattern.
fn random(state: &mut u64) -> u64 {
    *state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
    *state >> 20
}

/// Pushes and pops as a heap does, and compares each key; values tell which key they came with.
fn compare<S: spill::Spill<u32>>(
    mut queue: Core<u32, S>,
    operations: usize,
    mut key: impl FnMut(usize) -> u64,
    seed: u64,
) where
    S::Error: std::fmt::Debug,
{
    let mut heap = BinaryHeap::new();
    let mut pushed = Vec::new();
    let mut state = seed;
    let retry = |queue: &mut Core<u32, S>| {
        for _ in 0..10_000 {
            if let Ok(found) = queue.pop() {
                return found;
            }
        }
        panic!("it fails endlessly");
    };
    for i in 0..operations {
        // More pushes in the first half, more pops in the second.
        if random(&mut state) % 10 < if 2 * i < operations { 7 } else { 4 } {
            // A failure to spill loses nothing.
            let _ = queue.push(key(i), pushed.len() as u32);
            pushed.push(Some(key(i)));
            heap.push(Reverse(key(i)));
        } else {
            let (found, expected) = (retry(&mut queue), heap.pop());
            assert_eq!(found.map(|(key, _)| key), expected.map(|Reverse(key)| key));
            if let Some((key, value)) = found {
                assert_eq!(pushed[value as usize].take(), Some(key));
            }
        }
        assert_eq!(queue.len(), heap.len() as u64);
    }
    while let Some((key, value)) = retry(&mut queue) {
        assert_eq!(heap.pop(), Some(Reverse(key)));
        assert_eq!(pushed[value as usize].take(), Some(key));
    }
    assert!(heap.is_empty());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(if cfg!(miri) { 2 } else { 40 }))]
    #[test]
    fn pops_what_a_heap_pops(
        operations in 0usize..4000, range in 1u64..5000, seed: u64, limit in 256usize..1200, fails in 0u64..40,
    ) {
        let operations = if cfg!(miri) { operations % 200 } else { operations };
        let fails = if fails < 10 { 0 } else { fails };
        let key = |i: usize| {
            let mut state = seed ^ i as u64;
            random(&mut state);
            random(&mut state) % range
        };
        compare(Core::new(NoSpill), operations, key, seed);
        compare(Core::new(faulty(limit, fails)), operations, key, seed);
    }
}

#[test]
#[cfg_attr(miri, ignore = "large")]
fn orders_that_are_hard_for_pivots() {
    let orders: [fn(usize) -> u64; 6] = [
        |_| 7,
        |_| u64::MAX,
        |i| i as u64,
        |i| u64::MAX - i as u64,
        |i| (i % 2) as u64 * u64::MAX,
        |i| (i as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15),
    ];
    for order in orders {
        compare(Core::new(NoSpill), 20_000, order, 1);
        compare(Core::new(faulty(512, 0)), 20_000, order, 1);
    }
}

#[test]
fn keys_of_all_kinds_leave_in_order() {
    fn check<K: Key>(sorted: &[K]) {
        let mut queue = PriorityQueue::new();
        for (place, &key) in sorted.iter().enumerate().rev() {
            queue.push(key, place);
        }
        for (place, &key) in sorted.iter().enumerate() {
            let (found, with) = queue.pop().unwrap();
            assert_eq!((format!("{found:?}"), with), (format!("{key:?}"), place));
        }
        assert!(queue.is_empty());
    }
    check(&[0u64, 1, u64::MAX]);
    check(&[0u32, 1, u32::MAX]);
    check(&[i64::MIN, -1, 0, 1, i64::MAX]);
    check(&[i32::MIN, -1, 0, 1, i32::MAX]);
    check(&[-f64::NAN, -1.0, -5e-324, -0.0, 0.0, 5e-324, f64::INFINITY, f64::NAN]);
    check(&[-f32::NAN, f32::NEG_INFINITY, -1.0, -1e-45, -0.0, 0.0, 1e-45, f32::NAN]);
}

#[test]
#[cfg_attr(miri, ignore = "files")]
fn the_memory_is_kept_and_the_file_is_reused() {
    let folder = tempfile::tempdir().unwrap();
    let memory = 4 << 20;
    assert!(SpillingQueue::<u64, u64>::new(folder.path(), memory - 1).is_err());
    assert!(SpillingQueue::<u64, [u64; 96]>::new(folder.path(), 6830 * 776 - 1).is_err());
    assert!(SpillingQueue::<u64, [u64; 96]>::new(folder.path(), 6830 * 776).is_ok());
    assert!(SpillingQueue::<u64, u64>::new(&folder.path().join("none"), memory).is_err());
    let mut queue = SpillingQueue::<u64, [u64; 3]>::new(folder.path(), memory).unwrap();
    let (n, entries) = (150_000u64, memory as u64 / 32 / 10 * 3);
    let key = |i: u64| i.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 8;
    for i in 0..n {
        queue.push(key(i), [i, i + 1, i + 2]).unwrap();
        assert!(queue.len() - queue.spilled() <= entries);
        assert!(queue.core.room() * 32 <= memory / 2);
    }
    let mut sorted: Vec<u64> = (0..n).map(key).collect();
    sorted.sort_unstable();
    for (k, &expected) in sorted.iter().enumerate() {
        assert_eq!(queue.peek().unwrap().map(|(key, _)| key), Some(expected));
        let (found, [i, ..]) = queue.pop().unwrap().expect("an entry");
        assert_eq!((found, key(i)), (expected, expected));
        assert_eq!(queue.len(), n - 1 - k as u64);
        assert!(queue.len() - queue.spilled() <= entries);
        assert!(queue.core.room() * 32 <= memory / 2);
    }
    assert_eq!(queue.pop().unwrap(), None);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0, "the file has no name");
}

/// Pushes groups of keys below all earlier ones and pops one after each, as a search does that goes for the best first.
fn groups_below<S: spill::Spill<u32>>(
    queue: &mut Core<u32, S>,
    (n, group): (u64, u64),
    mut each: impl FnMut(&Core<u32, S>),
) where
    S::Error: std::fmt::Debug,
{
    let mut key = u64::MAX / 2;
    while queue.len() < n {
        for _ in 0..group {
            key -= 1;
            queue.push(key, (key % 1000) as u32).unwrap();
            each(queue);
        }
        let smallest = queue.pop().unwrap();
        assert_eq!(smallest, Some((key, (key % 1000) as u32)));
        each(queue);
    }
}

#[test]
#[cfg_attr(miri, ignore = "large")]
fn groups_below_all_earlier_keys_leave_few_buckets() {
    for group in [2, 15, 16, 17, 18, 33, 100] {
        for n in [1000u64, 20_000, 80_000] {
            let mut queue = Core::new(NoSpill);
            groups_below(&mut queue, (n, group), |queue| {
                let (buckets, _) = queue.buckets_and_work();
                assert!(buckets <= 10 + 2 * n.ilog2() as usize, "{buckets} of {n}");
            });
            // Each push and each pop, and then all that is left.
            let operations = n + 2 * n / (group - 1);
            let (_, work) = queue.buckets_and_work();
            let bound = 6 * operations * u64::from(n.ilog2());
            assert!(work <= bound, "{work} for {n} by {group}, bound {bound}");
            let mut before = 0;
            while let Some((key, _)) = queue.pop().unwrap() {
                assert!(key > before);
                before = key;
            }
            let (_, work) = queue.buckets_and_work();
            assert!(work <= 2 * bound, "{work} for {n} by {group}, bound {bound}");
        }
    }
}

#[test]
#[cfg_attr(miri, ignore = "large")]
fn groups_below_all_earlier_keys_go_to_the_file() {
    for group in [2, 17, 100] {
        let limit = 1638;
        let mut queue = Core::new(faulty(limit, 0));
        groups_below(&mut queue, (50_000, group), |queue| {
            assert!(queue.len() - queue.spilled() <= limit as u64);
            assert!(
                queue.room() <= limit + limit / 2 + 4 * queue.buckets_and_work().0,
                "{}",
                queue.room()
            );
        });
        assert!(queue.spilled() > 45_000);
        let (mut n, mut before) = (queue.len(), 0);
        while let Some((key, value)) = queue.pop().unwrap() {
            assert!(key > before && u64::from(value) == key % 1000);
            (before, n) = (key, n - 1);
            assert!(queue.len() - queue.spilled() <= limit as u64);
            assert!(
                queue.room() <= limit + limit / 2 + 4 * queue.buckets_and_work().0,
                "{}",
                queue.room()
            );
        }
        assert_eq!(n, 0);
    }
}

#[test]
#[cfg_attr(miri, ignore = "large")]
fn keys_between_many_equal_ones_do_not_mix_with_them() {
    let (n, rounds) = (20_000u64, 20_000u64);
    for between in [6, 8] {
        let mut queue = Core::new(NoSpill);
        for _ in 0..n {
            queue.push(7, 0).unwrap();
        }
        assert_eq!(queue.pop().unwrap(), Some((7, 0)));
        for i in 0..rounds {
            queue.push(if i % 2 == 0 { between } else { 7 }, 1).unwrap();
            let (key, _) = queue.pop().unwrap().unwrap();
            assert_eq!(key, if i % 2 == 0 { between.min(7) } else { 7 });
        }
        let (_, work) = queue.buckets_and_work();
        assert!(work <= 40 * (n + rounds), "{work}");
        let mut left = Vec::new();
        while let Some((key, _)) = queue.pop().unwrap() {
            left.push(key);
        }
        assert!(left.is_sorted() && left.len() as u64 == n - 1);
    }
}
