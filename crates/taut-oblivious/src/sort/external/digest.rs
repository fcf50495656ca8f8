//! The hash of a multiset of records: a sum of hashes of records, so that order does not count and parts add up.
//!
//! *Definition.* A record is a row of words of 64 bits, least significant byte first, the last one filled up with zeros.
//! For each of two lanes, h := START; for each word x: h := (h ⊕ x)·FACTOR, h := h ⊕ ⌊h/2³²⌋; at the end
//! h := h ⊕ ⌊h/2²⁹⌋, h := h·FINAL, h := h ⊕ ⌊h/2³²⌋. The second lane is the upper half of the hash.
//! *Guarantee.* Each step is a bijection of words, so records of one word never collide. Others do by chance, with a
//! probability of some 2⁻¹²⁸ for two multisets that are given.

use super::Multiset;

const START: [u64; 2] = [0x243F_6A88_85A3_08D3, 0x1319_8A2E_0370_7344];
const FACTOR: [u64; 2] = [0x9E37_79B9_7F4A_7C15, 0xD6E8_FEB8_6659_FD93];
const FINAL: [u64; 2] = [0xBF58_476D_1CE4_E5B9, 0x94D0_49BB_1331_11EB];

#[inline]
fn step(lanes: [u64; 2], word: u64) -> [u64; 2] {
    std::array::from_fn(|i| {
        let h = (lanes[i] ^ word).wrapping_mul(FACTOR[i]);
        h ^ h >> 32
    })
}

/// The hash of one record.
#[inline]
pub(super) fn hash(record: &[u8]) -> u128 {
    let (words, rest) = record.as_chunks::<8>();
    let mut lanes = words.iter().fold(START, |lanes, word| step(lanes, u64::from_le_bytes(*word)));
    if !rest.is_empty() {
        let mut word = [0; 8];
        word[..rest.len()].copy_from_slice(rest);
        lanes = step(lanes, u64::from_le_bytes(word));
    }
    let [low, high] = std::array::from_fn(|i| {
        let h = (lanes[i] ^ lanes[i] >> 29).wrapping_mul(FINAL[i]);
        h ^ h >> 32
    });
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
