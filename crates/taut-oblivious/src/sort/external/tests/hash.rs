//! Differences that a hash word by word might lose: few bits, in words that follow each other.

use std::io::Cursor;

use super::*;
use crate::sort::external::digest::hash;

/// The words of a record.
fn record(seed: u64) -> [u64; 3] {
    std::array::from_fn(|i| match seed % 4 {
        // Plain numbers as well as random ones: few bits set, doubles, and what a counter leaves.
        0 => seed >> 2,
        1 => ((seed * 3 + i as u64) as f64 / 8.0).to_bits(),
        _ => word(3 * seed + i as u64),
    })
}

fn lanes(words: &[u64; 3]) -> [u64; 2] {
    let hash = hash(bytemuck::bytes_of(&words.map(u64::to_le)));
    [hash as u64, (hash >> 64) as u64]
}

/// Tests whether the two records differ in each half of the hash.
fn differ(a: [u64; 2], b: [u64; 2]) -> bool {
    a[0] != b[0] && a[1] != b[1]
}

#[test]
fn no_two_bits_of_neighboring_words_cancel() {
    for seed in 0..if cfg!(miri) { 1 } else { 2000 } {
        let words = record(seed);
        let (before, k) = (lanes(&words), (seed / 4 % 2) as usize);
        for first in (0..128).step_by(if cfg!(miri) { 31 } else { 1 }) {
            for second in (first..128).step_by(if cfg!(miri) { 9 } else { 1 }) {
                let mut other = words;
                other[k + first / 64] ^= 1 << (first % 64);
                if second > first {
                    other[k + second / 64] ^= 1 << (second % 64);
                }
                assert!(differ(before, lanes(&other)), "bits {first} and {second} of {words:x?}");
            }
        }
    }
}

/// A bit of one word and two of the next: what a shift by half a word makes of the top bit.
#[test]
fn no_bit_is_undone_by_two_of_the_next_word() {
    for seed in 0..if cfg!(miri) { 0 } else { 16 } {
        let words = record(seed);
        let before = lanes(&words);
        for bit in 0..64 {
            for pair in (0..64 * 64).filter(|pair| pair / 64 < pair % 64) {
                let mut other = words;
                other[0] ^= 1 << bit;
                other[1] ^= 1 << (pair / 64) | 1 << (pair % 64);
                assert!(differ(before, lanes(&other)), "{bit}, {pair} of {words:x?}");
            }
        }
    }
}

/// The records that a hash of low halves alone took for one another.
#[test]
fn two_signs_do_not_cancel() {
    let [a, b] = [[1.5f64, 2.5], [-1.5, -2.500_000_953_674_316_4]]
        .map(|pair| hash(bytemuck::bytes_of(&pair)));
    assert_ne!(a, b);
}

/// Hashes add up: words that change places between records, and parts that are exchanged, change the sum.
#[test]
fn the_sum_tells_which_words_belong_together() {
    let sum = |records: [[u64; 3]; 2]| {
        let mut multiset = Multiset::default();
        records.iter().for_each(|record| multiset.add(bytemuck::bytes_of(record), 24));
        multiset
    };
    for seed in 0..if cfg!(miri) { 30 } else { 3000 } {
        let (a, b) = (record(seed), record(seed + 4));
        let [mut c, mut d] = [a, b];
        let k = seed as usize % 3;
        (c[k], d[k]) = (b[k], a[k]);
        assert_eq!(sum([a, b]), sum([b, a]));
        assert!(a[k] == b[k] || sum([a, b]) != sum([c, d]), "{a:?} {b:?}");
        let [mut c, mut d] = [a, b];
        (c[0], d[0]) = (a[0].wrapping_add(8), b[0].wrapping_sub(8));
        assert_ne!(sum([a, b]), sum([c, d]));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(if cfg!(miri) { 1 } else { 256 }))]
    /// Solver and checker have their own code for the hash.
    #[test]
    fn both_hashes_are_the_same_function(
        bytes in prop::collection::vec(any::<u8>(), 0..200), width in 1usize..40,
    ) {
        let bytes = &bytes[..bytes.len() / width * width];
        let mut multiset = Multiset::default();
        multiset.add(bytes, width);
        let layout = layout(width, 0..width, KeyKind::Bytes);
        let sorted = expected(bytes, &layout);
        verify(&layout, &multiset, Cursor::new(bytes), Cursor::new(sorted));
    }
}

/// The definition of the docs, calculated by hand with numbers of any length.
#[test]
fn the_hash_does_not_change() {
    assert_eq!(hash(&[]), 0x780C_DC0E_26E0_61EA_7719_F822_50FC_BBF7);
    assert_eq!(hash(b"taut"), 0xD688_7B7A_FA24_6251_51E3_3DE5_167E_ABCB);
    assert_eq!(
        hash(b"0123456789abcdef0123456789abcdef"),
        0x4F94_F0C4_4C44_AE91_3554_FDC0_965A_C330
    );
}
