//! The order of the records of one chunk, by one word for each; or in their own place.
//!
//! *Idea.* A word holds the leading bits of a rank above the lowest one, and the number of the record; the words are
//! sorted by vectors. Where words agree in these bits, the keys themselves are compared.
//! *Guarantee.* Stable. Eight bytes beside each record, and nothing else.
//! *Trap.* The numbers take the room of trailing bits of ranks: 22 bits of 64 for four million records, so that
//! ranks closer than that must be looked up.

use super::layout::RecordLayout;
use crate::probe::NoProbe;
use crate::sort::{self, records::Rooms};

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
    sort::sort(words);
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
fn number_bits(records: usize) -> u32 {
    usize::BITS - records.saturating_sub(1).leading_zeros()
}

/// Copies the records whose numbers are in `words` to the front of `to`; [`order`] was given `all` records.
pub(super) fn gather(records: &[u8], words: &[u64], all: usize, to: &mut [u8], width: usize) {
    let mask = (1 << number_bits(all)) - 1;
    match width {
        8 => gather_width::<8>(records, words, mask, to),
        16 => gather_width::<16>(records, words, mask, to),
        32 => gather_width::<32>(records, words, mask, to),
        _ => {
            for (place, word) in to.chunks_exact_mut(width).zip(words) {
                place.copy_from_slice(&records[(word & mask) as usize * width..][..width]);
            }
        }
    }
}

fn gather_width<const W: usize>(records: &[u8], words: &[u64], mask: u64, to: &mut [u8]) {
    let records = records.as_chunks::<W>().0;
    for (place, word) in to.as_chunks_mut::<W>().0.iter_mut().zip(words) {
        *place = records[(word & mask) as usize];
    }
}

/// Whether [`sort`] can: the key is no longer than its rank, and the width is one that it knows.
pub(super) fn sorts(layout: &RecordLayout) -> bool {
    matches!(layout.width, 8 | 16 | 24 | 32 | 64) && !layout.is_long()
}

/// Sorts records of which [`sorts`] is true in their own place, on so many threads at most.
pub(super) fn sort(records: &mut [u8], layout: &RecordLayout, threads: usize) {
    match layout.width {
        8 => sort_width::<8>(records, layout, threads),
        16 => sort_width::<16>(records, layout, threads),
        24 => sort_width::<24>(records, layout, threads),
        32 => sort_width::<32>(records, layout, threads),
        _ => sort_width::<64>(records, layout, threads),
    }
}

fn sort_width<const W: usize>(records: &mut [u8], layout: &RecordLayout, threads: usize) {
    let (records, rooms) = (records.as_chunks_mut::<W>().0, Rooms::most(threads));
    sort::records::sort(records, &|record: &[u8; W]| layout.rank(record), &rooms, &mut NoProbe);
}
