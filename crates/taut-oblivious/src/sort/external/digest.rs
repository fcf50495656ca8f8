//! The hash of a multiset of records: a sum of hashes of records, so that order does not count and parts add up.
//!
//! *Definition.* A record is a row of words of 64 bits, least significant byte first, the last one filled up with zeros.
//! For a product p of 128 bits let fold(p) := ⌊p/2⁶⁴⌋ ⊕ (p mod 2⁶⁴). Lane 0: h := START; for each word x:
//! h := fold((h ⊕ x)·FACTOR). Lane 1, with constants of its own: h := fold((h + y)·FACTOR), y being x with its halves
//! exchanged and the sum modulo 2⁶⁴. At the end h := fold((h ⊕ FINAL)·FACTOR) in both. Lane 1 is the upper half of the hash.
//! *Guarantee.* None that is proved, as for any fixed function: as far as hashes are random numbers, two multisets that
//! are given and differ agree with a probability of 2⁻¹²⁸. It is no defense against somebody who means to deceive.
//! *Trap.* The low half of a product alone lets the top bit of a word change the top bit only, whatever the factor; shifts
//! and a second such lane then have the same pairs of changes that undo each other. The high half brings every bit down
//! before the next word enters, and in the lanes differences are of different kinds: of bits and of sums.
//! *Trap.* fold must not be a sum: that is nearly the product modulo 2⁶⁴ − 1, which is linear.

use super::Multiset;

const START: [u64; 2] = [0x243F_6A88_85A3_08D3, 0x1319_8A2E_0370_7344];
const FACTOR: [u64; 2] = [0x9E37_79B9_7F4A_7C15, 0xD6E8_FEB8_6659_FD93];
const FINAL: [u64; 2] = [0xBF58_476D_1CE4_E5B9, 0x94D0_49BB_1331_11EB];

#[inline(always)]
fn fold(a: u64, b: u64) -> u64 {
    let product = u128::from(a) * u128::from(b);
    (product >> 64) as u64 ^ product as u64
}

#[inline(always)]
fn step([a, b]: [u64; 2], word: u64) -> [u64; 2] {
    [fold(a ^ word, FACTOR[0]), fold(b.wrapping_add(word.rotate_left(32)), FACTOR[1])]
}

/// The hash of one record.
#[inline(always)]
pub(super) fn hash(record: &[u8]) -> u128 {
    let (words, rest) = record.as_chunks::<8>();
    let mut lanes = words.iter().fold(START, |lanes, word| step(lanes, u64::from_le_bytes(*word)));
    if !rest.is_empty() {
        let mut word = [0; 8];
        word[..rest.len()].copy_from_slice(rest);
        lanes = step(lanes, u64::from_le_bytes(word));
    }
    let [low, high] = std::array::from_fn(|i| fold(lanes[i] ^ FINAL[i], FACTOR[i]));
    u128::from(high) << 64 | u128::from(low)
}

impl Multiset {
    /// Adds the records of `width` bytes that `bytes` holds.
    pub(super) fn add(&mut self, bytes: &[u8], width: usize) {
        // Records of constant width compile to straight code.
        let sum = match width {
            8 => sum(bytes.as_chunks::<8>().0.iter().map(|r| r.as_slice())),
            16 => sum(bytes.as_chunks::<16>().0.iter().map(|r| r.as_slice())),
            32 => sum(bytes.as_chunks::<32>().0.iter().map(|r| r.as_slice())),
            _ => sum(bytes.chunks_exact(width)),
        };
        self.records += (bytes.len() / width) as u64;
        self.hash = self.hash.wrapping_add(sum);
    }
}

#[inline(always)]
fn sum<'a>(records: impl Iterator<Item = &'a [u8]>) -> u128 {
    records.fold(0, |sum: u128, record| sum.wrapping_add(hash(record)))
}
