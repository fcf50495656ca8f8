//! The order of the records of one chunk, by one word for each.
//!
//! *Idea.* A word holds the leading bits of a rank above the lowest one, and the number of the record; the words are
//! sorted by vectors. Where words agree in these bits, the keys themselves are compared.
//! *Guarantee.* Stable. Eight bytes beside each record, and nothing else.
//! *Trap.* The numbers take the room of trailing bits of ranks: 22 bits of 64 for four million records, so that
//! ranks closer than that must be looked up.

use super::layout::RecordLayout;
use crate::sort::sort;

/// Replaces `words`, one for each record, by the numbers of the records in order, in the lower [`number_bits`] bits.
pub(super) fn order(records: &[u8], layout: &RecordLayout, words: &mut [u64]) {
    for (word, record) in words.iter_mut().zip(records.chunks_exact(layout.width)) {
        *word = layout.rank(record);
    }
    let ends = |(low, high): (u64, u64), &rank: &u64| (low.min(rank), high.max(rank));
    let (low, high) = words.iter().fold((u64::MAX, 0), ends);
    let number_bits = number_bits(words.len());
    let span = 64 - high.saturating_sub(low).leading_zeros();
    let shift = (span + number_bits).saturating_sub(64);
    for (number, word) in words.iter_mut().enumerate() {
        *word = (*word - low) >> shift << number_bits | number as u64;
    }
    sort(words);
    if shift > 0 || layout.is_long() {
        let mask = (1 << number_bits) - 1;
        let record = |word: u64| &records[(word & mask) as usize * layout.width..][..layout.width];
        for run in words.chunk_by_mut(|a, b| (a ^ b) >> number_bits == 0) {
            if run.len() > 1 {
                run.sort_unstable_by(|&a, &b| {
                    let (x, y) = (record(a), record(b));
                    let ranks = layout.rank(x).cmp(&layout.rank(y));
                    ranks.then_with(|| layout.compare_rest(x, y)).then(a.cmp(&b))
                });
            }
        }
    }
}

/// Bits that number so many records.
pub(super) fn number_bits(records: usize) -> u32 {
    usize::BITS - records.saturating_sub(1).leading_zeros()
}
