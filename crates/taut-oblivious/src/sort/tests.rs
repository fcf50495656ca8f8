//! Against the standard library, on the inputs that sorts fear.

use std::collections::HashMap;

use proptest::prelude::*;

use super::*;
use crate::probe::Access;

/// A generator of words (splitmix64), so that each test names its seed.
struct Words(u64);

impl Words {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ z >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ z >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ z >> 31
    }

    fn take(&mut self, n: usize) -> Vec<u64> {
        (0..n).map(|_| self.next()).collect()
    }
}

const PATTERNS: usize = 14;

/// The inputs that sorts are measured on, and two that leave vectors half full.
fn pattern(kind: usize, n: usize, seed: u64) -> Vec<u64> {
    let mut words = Words(seed);
    let m = n as u64;
    match kind {
        0 => words.take(n),
        1 => (0..m).collect(),
        2 => (0..m).rev().collect(),
        3 => vec![u64::MAX; n],
        4 => words.take(n).iter().map(|w| w % (m.isqrt() + 1)).collect(),
        // Zipf's law: the logarithm of a rank is uniform.
        5 => words
            .take(n)
            .iter()
            .map(|w| (n as f64).powf(*w as f64 / 2f64.powi(64)) as u64)
            .collect(),
        6 => {
            let mut keys: Vec<u64> = (0..m).collect();
            for _ in 0..n / 100 {
                let (i, j) = (words.next() % m, words.next() % m);
                keys.swap(i as usize, j as usize);
            }
            keys
        }
        7 => (0..m).map(|i| i % 37).collect(),
        8 => (0..m).map(|i| i.min(m - i)).collect(),
        9 => words.take(n).iter().map(|w| odd_number(*w).to_bits()).collect(),
        // Bentley and McIlroy: a comb, its second half reversed and dithered.
        10 => (0..m).map(|i| (if i < m / 2 { i } else { m - i } * 7) % 61 + i % 5).collect(),
        // Musser's sequence against the median of three.
        11 => (0..m)
            .map(|i| match i {
                _ if i >= m / 2 => 2 * (i - m / 2) + 2,
                _ if i % 2 == 0 => i + 1,
                _ => m / 2 + i,
            })
            .collect(),
        12 => words.take(n).iter().map(|w| w & 1).collect(),
        _ => words.take(n).iter().map(|w| if w % 8 == 0 { u64::MAX } else { w >> 40 }).collect(),
    }
}

/// Floating-point numbers of all kinds.
fn odd_number(word: u64) -> f64 {
    match word % 9 {
        0 => f64::NAN,
        1 => -f64::NAN,
        2 => 0.0,
        3 => -0.0,
        4 => f64::INFINITY,
        5 => f64::NEG_INFINITY,
        6 => f64::from_bits(word >> 12),
        7 => f64::from_bits(word),
        _ => (word >> 32) as f64 - 2e9,
    }
}

/// Lengths where something changes: networks, chunks, samples, powers of two.
fn lengths() -> impl Iterator<Item = usize> {
    let bends = [0, 1, 2, 16, 32, 64, 96, 128, 160, 192, 256, 1024, 4096, 8192];
    bends.into_iter().flat_map(|n: usize| n.saturating_sub(1)..=n + 1).chain(18..23)
}

fn check(keys: &[u64]) {
    let (mut sorted, mut expected) = (keys.to_vec(), keys.to_vec());
    sort(&mut sorted);
    expected.sort_unstable();
    assert!(sorted == expected, "{} keys", keys.len());
}

#[test]
fn equals_the_standard_sort_on_every_pattern() {
    for n in lengths().filter(|&n| !cfg!(miri) || n < 34) {
        for kind in (0..PATTERNS).step_by(if cfg!(miri) { 3 } else { 1 }) {
            check(&pattern(kind, n, n as u64));
        }
    }
    for kind in (0..PATTERNS).step_by(if cfg!(miri) { 4 } else { 1 }) {
        check(&pattern(kind, if cfg!(miri) { 300 } else { 100_000 }, 5));
    }
}

/// A network that sorts all zeros and ones sorts everything; one column of each network has 2⁸ and 2¹⁶ of these.
#[test]
fn networks_sort_zeros_and_ones() {
    let mut words = Words(1);
    for _ in 0..if cfg!(miri) { 2 } else { 3000 } {
        for n in [17, 40, 64, 65, 100, 127, 128] {
            let (a, b) = (words.next(), words.next());
            check(
                &(0..n)
                    .map(|i| if i < 64 { a >> i } else { b >> (i - 64) } & 1)
                    .collect::<Vec<_>>(),
            );
        }
    }
}

macro_rules! kinds_of_numbers {
    ($($name:ident: $key:ty, $of:expr, $compare:expr;)+) => {
        proptest! {
            #![proptest_config(ProptestConfig::with_cases(if cfg!(miri) { 2 } else { 64 }))]
            $(#[test]
            fn $name(seed in any::<u64>(), n in 0usize..if cfg!(miri) { 300 } else { 700 }, shift in 0u32..64) {
                let of: fn(u64) -> $key = $of;
                let compare: fn(&$key, &$key) -> std::cmp::Ordering = $compare;
                let mut keys: Vec<$key> =
                    Words(seed).take(n).into_iter().map(|w| of(w >> shift)).collect();
                let mut expected = keys.clone();
                expected.sort_unstable_by(compare);
                sort(&mut keys);
                prop_assert_eq!(bytemuck::cast_slice::<_, u8>(&keys), bytemuck::cast_slice::<_, u8>(&expected));
            })+
        }
    };
}

kinds_of_numbers! {
    words_are_sorted: u64, |w| w, u64::cmp;
    signed_words_are_sorted: i64, |w| w as i64, i64::cmp;
    doubles_are_sorted: f64, odd_number, f64::total_cmp;
    halves_are_sorted: u32, |w| w as u32, u32::cmp;
    signed_halves_are_sorted: i32, |w| w as i32, i32::cmp;
    singles_are_sorted: f32, |w| if w % 3 == 0 { odd_number(w) as f32 } else { f32::from_bits(w as u32) }, f32::total_cmp;
}

/// A record as large as four words, which carries its place.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Record {
    key: u64,
    rest: [u64; 3],
}

fn check_records(keys: &[u64]) {
    let mut pairs: Vec<(u64, u32)> = keys.iter().enumerate().map(|(i, &k)| (k, i as u32)).collect();
    let mut records: Vec<Record> =
        keys.iter().enumerate().map(|(i, &key)| Record { key, rest: [i as u64; 3] }).collect();
    let (mut expected_pairs, mut expected) = (pairs.clone(), records.clone());
    expected_pairs.sort_by_key(|pair| pair.0);
    expected.sort_by_key(|record| record.key);
    sort_records(&mut pairs, |pair| pair.0);
    sort_records(&mut records, |record| record.key);
    assert!(pairs == expected_pairs && records == expected, "{} records", keys.len());
}

#[test]
fn records_are_sorted_stably_on_every_pattern() {
    for n in lengths().filter(|n| !cfg!(miri) || [0, 1, 17, 33, 129].contains(n)) {
        for kind in (0..PATTERNS).step_by(if cfg!(miri) { 5 } else { 1 }) {
            check_records(&pattern(kind, n, n as u64));
        }
    }
    for kind in 0..if cfg!(miri) { 0 } else { PATTERNS } {
        check_records(&pattern(kind, 70_000, 5));
    }
}

/// A sample that says nothing of the rest: all that is looked at is small, and beyond it a few records are spread wide.
#[test]
#[cfg_attr(miri, ignore = "a hundred thousand records")]
fn records_beyond_a_sample_are_in_order() {
    let n = 100_000;
    for (few, high) in [(10, u64::MAX), (3000, 1 << 40), (n / 2, 1 << 60)] {
        let mut keys: Vec<u64> = Words(7).take(n).iter().map(|w| (1 << 30) + w % 100).collect();
        for (i, word) in Words(8).take(few).into_iter().enumerate() {
            keys[i] = word % high;
        }
        check_records(&keys);
    }
}

/// Words have room for the leading bits of the key only: here all records agree in these, and buckets nest.
#[test]
fn keys_that_differ_in_few_bits_only_are_told_apart() {
    let n = if cfg!(miri) { 200 } else { 50_000 };
    for shift in [0, 8, 40] {
        let mut keys: Vec<u64> = Words(3).take(n).iter().map(|w| w >> 52 << shift).collect();
        keys[n / 2] = u64::MAX;
        check_records(&keys);
        keys[n / 3] = 1 << 50;
        check_records(&keys);
    }
}

#[test]
fn records_by_a_number_with_nan() {
    let mut records: Vec<(f64, usize)> = Words(9)
        .take(if cfg!(miri) { 300 } else { 3000 })
        .iter()
        .enumerate()
        .map(|(i, w)| (odd_number(*w), i))
        .collect();
    let mut expected = records.clone();
    expected.sort_by(|a, b| a.0.total_cmp(&b.0));
    sort_records(&mut records, |record| record.0);
    let bits = |records: &[(f64, usize)]| -> Vec<_> {
        records.iter().map(|r| (r.0.to_bits(), r.1)).collect()
    };
    assert_eq!(bits(&records), bits(&expected));
}

#[test]
fn threads_change_nothing() {
    let n = if cfg!(miri) { 300 } else { 200_000 };
    let keys = pattern(5, n, 8);
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        let mut sorted = keys.clone();
        let mut records: Vec<(u64, usize)> = keys.iter().copied().zip(0..).collect();
        pool.install(|| {
            sort(&mut sorted);
            sort_records(&mut records, |record| record.0);
        });
        (sorted, records)
    };
    let alone = on(1);
    assert!(alone.0.is_sorted());
    for threads in [2, 3, 8] {
        assert!(alone == on(threads), "{threads} threads");
    }
}

#[test]
fn a_key_that_panics_leaves_records_that_can_be_used() {
    let n = if cfg!(miri) { 200 } else { 5000 };
    let mut records: Vec<(u64, u32)> = Words(4).take(n).into_iter().zip(0..).collect();
    let calls = std::sync::atomic::AtomicUsize::new(0);
    for limit in [0, 1, n - 1, n + n / 5 * 2, 4 * n] {
        calls.store(0, std::sync::atomic::Ordering::Relaxed);
        let result = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
            sort_records(&mut records, |record| {
                let call = calls.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
                assert!(call != limit, "the key panics");
                record.0
            });
        }));
        assert!(result.is_err() || limit >= n);
    }
    sort_records(&mut records, |record| record.0);
    assert!(records.is_sorted_by_key(|record| record.0));
}

/// Counts bytes, and holds every access to what was placed.
#[derive(Default)]
struct Count {
    placed: HashMap<usize, usize>,
    read: usize,
    written: usize,
}

impl Probe for Count {
    const IS_RECORDING: bool = true;

    fn place_at(&mut self, address: usize, bytes: usize) {
        self.placed.insert(address, bytes);
    }

    fn lift_from(&mut self, address: usize) {
        self.placed.remove(&address).expect("lifted after it was placed");
    }

    fn record(&mut self, address: usize, bytes: usize, access: Access) {
        let inside =
            |(&from, &len): (&usize, &usize)| from <= address && address + bytes <= from + len;
        assert!(bytes == 0 || self.placed.iter().any(inside), "{bytes} bytes were not placed");
        *(if access == Access::Read { &mut self.read } else { &mut self.written }) += bytes;
    }
}

#[test]
fn accesses_are_told_and_stay_within_what_was_placed() {
    let n = if cfg!(miri) { 400 } else { 40_000 };
    let keys = Words(6).take(n);
    let (mut count, mut sorted) = (Count::default(), keys.clone());
    sort_instrumented(&mut sorted, &mut count);
    // Twenty levels of a partition, at the very most.
    assert!(sorted.is_sorted() && (8 * n..20 * 8 * n).contains(&count.read), "{}", count.read);
    assert!((8 * n..20 * 8 * n).contains(&count.written), "{}", count.written);

    let (mut count, mut records) =
        (Count::default(), keys.iter().map(|&k| [k; 4]).collect::<Vec<_>>());
    sort_records_instrumented(&mut records, |record| record[0], &mut count);
    assert!(records.is_sorted());
    // Dealt, collected, moved out of the way, gathered; and the words. So few as in Miri are not dealt.
    let bounds = if cfg!(miri) { 1 } else { 4 } * 32 * n..9 * 32 * n;
    assert!(bounds.contains(&count.read), "{}", count.read);
    assert!(bounds.contains(&count.written), "{}", count.written);
    assert_eq!(count.placed.len(), 1, "all room is given back");

    let (mut count, mut singles) =
        (Count::default(), keys.iter().map(|&k| k as f32).collect::<Vec<_>>());
    sort_instrumented(&mut singles, &mut count);
    assert!(singles.is_sorted() && count.placed.len() == 1);
}
