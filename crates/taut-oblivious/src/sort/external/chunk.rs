//! The order of records in memory, by one word for each; or by dealing them in their own place.
//!
//! *Idea.* A word holds the leading bits of a rank above the lowest one, and the number of the record; the words are
//! sorted by vectors. Where words agree in these bits, the keys themselves are compared.
//! *Guarantee.* Stable. [`order`] takes eight bytes beside each record, and nothing else.
//! *Trap.* The numbers take the room of trailing bits of ranks: 22 bits of 64 for four million records, so that
//! ranks closer than that must be looked up.

use std::ops::Range;

use super::layout::RecordLayout;
use crate::error::Error;
use crate::pages::Pages;
use crate::sort::{
    self,
    records::{self, BucketBuffers, Parts, bucket_bytes},
};

/// Replaces `words`, the ranks of the records whose numbers are in `parts`, by these numbers in order, in their lower bits.
pub(super) fn order(
    records: &[u8],
    parts: &[Range<usize>],
    layout: &RecordLayout,
    words: &mut [u64],
) {
    let width = layout.width;
    let ends = |(low, high): (u64, u64), &rank: &u64| (low.min(rank), high.max(rank));
    let (low, high) = words.iter().fold((u64::MAX, 0), ends);
    let number_bits = number_bits(records, width);
    let span = u64::BITS - high.saturating_sub(low).leading_zeros();
    let shift = (span + number_bits).saturating_sub(u64::BITS);
    let mut rest = &mut *words;
    for part in parts {
        let words;
        (words, rest) = rest.split_at_mut(part.len());
        for (number, word) in part.clone().zip(words) {
            *word = (*word - low) >> shift << number_bits | number as u64;
        }
    }
    sort::sort(words);
    if shift > 0 || layout.is_long() {
        let mask = (1 << number_bits) - 1;
        let record = |word: u64| &records[(word & mask) as usize * width..][..width];
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

fn number_bits(records: &[u8], width: usize) -> u32 {
    usize::BITS - (records.len() / width).saturating_sub(1).leading_zeros()
}

/// Copies the records whose numbers are in `words`, from [`order`] for the same records, to the front of `to`.
pub(super) fn gather(records: &[u8], words: &[u64], to: &mut [u8], width: usize) {
    let mask = (1 << number_bits(records, width)) - 1;
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

/// Returns true if [`sort`] can: the key is no longer than its rank, and the width is one that it knows.
pub(super) fn sorts(layout: &RecordLayout) -> bool {
    matches!(layout.width, 8 | 16 | 24 | 32 | 64) && !layout.is_long()
}

/// Where sorted records wait until they are written: while one of two places is written, the other one is filled.
pub(super) struct Stage {
    places: [Pages<u8>; 2],
    /// Writes are multiples of so many bytes, but for the end.
    unit: usize,
    /// Once a place holds so many bytes, it is written.
    enough: usize,
}

impl Stage {
    /// Empty places for some bytes of records, of at most [`stage_bytes`] each: none where there is but one bucket.
    ///
    /// Half a block of what is written is `enough`: that is a bucket of the usual size, which is in the cache, and two of them
    /// would push each other out.
    pub(super) fn new(bytes: usize, unit: usize, write_block: usize) -> Result<Self, Error> {
        let size = if bytes > bucket_bytes() { stage_bytes(unit) } else { 0 };
        let place = || Pages::try_zeroed(size);
        Ok(Self { places: [place()?, place()?], unit, enough: write_block / 2 })
    }
}

/// A place has room for a bucket behind what is left over of a unit.
pub(super) fn stage_bytes(unit: usize) -> usize {
    bucket_bytes() + unit
}

/// Sorts records of which [`sorts`] is true, on so many threads at most, and hands them to `write` in order, part by part.
pub(super) fn sort<E: Send>(
    records: &mut [u8],
    layout: &RecordLayout,
    threads: usize,
    stage: &mut Stage,
    write: impl FnMut(&[u8]) -> Result<(), E> + Send,
) -> Result<(), E> {
    match layout.width {
        8 => sort_width::<8, E>(records, layout, threads, stage, write),
        16 => sort_width::<16, E>(records, layout, threads, stage, write),
        24 => sort_width::<24, E>(records, layout, threads, stage, write),
        32 => sort_width::<32, E>(records, layout, threads, stage, write),
        _ => sort_width::<64, E>(records, layout, threads, stage, write),
    }
}

fn sort_width<const W: usize, E: Send>(
    records: &mut [u8],
    layout: &RecordLayout,
    threads: usize,
    stage: &mut Stage,
    mut write: impl FnMut(&[u8]) -> Result<(), E> + Send,
) -> Result<(), E> {
    let (records, rooms) = (records.as_chunks_mut::<W>().0, BucketBuffers::most(threads));
    let rank = |record: &[u8; W]| layout.rank(record);
    let mut buckets = match records::parts(records, &rank, &rooms) {
        Parts::Whole(records) => return write(records.as_flattened()),
        Parts::Buckets(buckets) => buckets,
    };
    let Stage { places: [full, next], unit, enough } = stage;
    // Bytes of the full place to be written, and those that wait in the next one.
    let (mut filled, mut waiting) = (0, 0);
    loop {
        let to = next.words_mut()[waiting..].as_chunks_mut::<W>().0;
        let fill = || buckets.next(to, *enough / W, &rank, &rooms);
        let (put, more) = taut_points::parallel::join(|| write(&full.words()[..filled]), fill);
        put?;
        let end = waiting + more * W;
        if more == 0 {
            return write(&next.words()[..end]);
        }
        filled = end - end % *unit;
        waiting = end - filled;
        full.words_mut()[..waiting].copy_from_slice(&next.words()[filled..end]);
        std::mem::swap(full, next);
    }
}
