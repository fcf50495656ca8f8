//! Sorting records by a key: stable, in their own place.
//!
//! *Idea.* The records are dealt by the leading bits of their keys into buckets that fit the second-level cache. A bucket
//! is copied out, each record is represented by one word, the leading bits of its key beside its number in the bucket;
//! the words are sorted by the vector kernels, and the records gathered in their order.
//! *Guarantee.* Stable, so that the result is a function of the input whatever the machine and the threads. O(n) passes
//! of memory for keys that spread; a bucket that is too large is dealt again, at most 65 times. Some megabytes of room for
//! each thread, or for as many threads as a limit has room for ([`BucketBuffers`]).
//! *Trap.* Words that agree in the bits they have room for must be told apart by the rest of the key, and records that
//! agree in all of it stay in order since the number in the bucket is the last part of the word.
//! *Trap.* A look at all keys for the smallest and the largest costs a pass of memory. Those of a sample are as good: what
//! lies beyond goes to the first and the last bucket. Only what is dealt again is looked at in full, so that a sample that
//! misleads does no harm twice.
//! *Reference.* D. Knuth, *The Art of Computer Programming* 3, 5.2.5 (distribution), 5.2 (address table sorting).

mod parts;
mod rooms;

use std::ops::Range;

use rayon::prelude::*;

use super::{Run, quick};
use crate::deal::{self, Dealt};
use crate::probe::{NoProbe, Probe};

/// Up to this many records are sorted by the standard library.
const STANDARD_SORT_MAX: usize = 24;
/// Bytes of records in a bucket at which one pass of dealing aims: a quarter of a second-level cache.
const BUCKET_BYTES: usize = 1 << 19;
/// Most bits dealt at once: the blocks of more buckets have no room in the second level of the cache.
const DEAL_BITS: u32 = 10;
/// Bytes that the blocks of all buckets may take: records above 1 KiB are dealt into fewer buckets, but two at least.
const BLOCKS_BYTES: usize = 4 << 20;
/// Buckets above this many bytes are dealt again.
const LARGE_BYTES: usize = 1 << 20;
/// Records for each that is looked at to find the range of keys, and most that are looked at.
const SAMPLE_SIZES: (usize, usize) = (64, 1 << 12);

/// Buckets of fewer ranks than this are sorted by counting.
const FEW_RANKS: u64 = 256;

pub(super) use parts::{Parts, bucket_bytes, parts};
use rooms::BucketBuffer;
pub(super) use rooms::{BucketBuffers, room_bytes};

/// Sorts records by their rank, on as many threads as there are rooms for.
pub(super) fn sort<T: Copy + Send + Sync, P: Probe>(
    records: &mut [T],
    rank: &(impl Fn(&T) -> u64 + Sync),
    rooms: &BucketBuffers<T>,
    probe: &mut P,
) {
    probe.place(records);
    if P::IS_RECORDING || rayon::current_num_threads() == 1 {
        rooms.within(|room| alone(records, rank, RankRecords::Sample, room, probe));
    } else {
        shared(records, rank, RankRecords::Sample, rooms);
    }
}

/// At which records to look for the lowest and the highest rank.
#[derive(Clone, Copy, PartialEq, Eq)]
enum RankRecords {
    Sample,
    All,
}

/// Sorts a part of the records of which nothing is known, on one thread.
fn alone<T: Copy, P: Probe>(
    records: &mut [T],
    rank: &impl Fn(&T) -> u64,
    extremes_of: RankRecords,
    room: &mut BucketBuffer<T>,
    probe: &mut P,
) {
    for range in divide(records, rank, extremes_of, true, room, probe) {
        alone(&mut records[range], rank, RankRecords::All, room, probe);
    }
}

/// Sorts such a part on all threads that get a room.
fn shared<T: Copy + Send + Sync>(
    records: &mut [T],
    rank: &(impl Fn(&T) -> u64 + Sync),
    extremes_of: RankRecords,
    rooms: &BucketBuffers<T>,
) {
    if extremes_of == RankRecords::All && !rooms.shares(records) {
        return rooms.within(|room| alone(records, rank, extremes_of, room, &mut NoProbe));
    }
    // A room is given back before other threads are waited for: whoever has one comes to an end.
    let large = rooms.within(|room| divide(records, rank, extremes_of, false, room, &mut NoProbe));
    let parts = cut(records, &large);
    drop(large);
    parts.into_par_iter().for_each(|records| shared(records, rank, RankRecords::All, rooms));
}

/// Deals a part into buckets and, if one thread is `alone` with it, sorts those that are small; what is left to be sorted.
fn divide<T: Copy, P: Probe>(
    records: &mut [T],
    rank: &impl Fn(&T) -> u64,
    extremes_of: RankRecords,
    alone: bool,
    room: &mut BucketBuffer<T>,
    probe: &mut P,
) -> Vec<Range<usize>> {
    match deal(records, rank, extremes_of, room, probe) {
        Deal::Sorted(_) => Vec::new(),
        Deal::Dealt(mut dealt) => put(&mut dealt, rank, alone, room, probe),
    }
}

/// The result of distributing records.
enum Deal<'a, T> {
    /// They are in order.
    Sorted(&'a mut [T]),
    Dealt(Dealt<'a, T>),
}

/// Sorts a part of the records if that is easily done, else deals it into buckets.
fn deal<'a, T: Copy, P: Probe>(
    records: &'a mut [T],
    rank: &impl Fn(&T) -> u64,
    extremes_of: RankRecords,
    room: &mut BucketBuffer<T>,
    probe: &mut P,
) -> Deal<'a, T> {
    if records.len() <= STANDARD_SORT_MAX {
        few(records, rank, probe);
        return Deal::Sorted(records);
    }
    probe.read(records);
    if let Some(run) = super::run(records, rank) {
        // Equal ranks must keep their order, so only a strict fall may be turned.
        if run == Run::Falls {
            records.reverse();
            probe.write(records);
        }
        return Deal::Sorted(records);
    }
    if size_of_val(records) <= LARGE_BYTES {
        unknown(records, rank, room, probe);
        return Deal::Sorted(records);
    }
    let sample =
        if extremes_of == RankRecords::Sample { sample(records, rank) } else { Vec::new() };
    let (mut low, mut high) = ends(sample.iter().copied());
    if low >= high {
        (low, high) = ends(records.iter().map(rank));
    }
    let bytes = size_of_val(records);
    let mut scale = Scale::new::<T>(low, high, (bytes / BUCKET_BYTES).max(2).ilog2() + 1);
    if scale.crowds(&sample) {
        scale = Scale::new::<T>(low, high, DEAL_BITS);
    }
    Deal::Dealt(Dealt::new(records, scale.buckets(), |r| scale.bucket(rank(r)), probe))
}

/// Most records of a bucket that is not dealt again.
fn most<T>() -> usize {
    LARGE_BYTES / size_of::<T>()
}

/// Puts buckets in their places and, if one thread is `alone` with them, sorts those that are small; what is left to be
/// sorted.
fn put<T: Copy, P: Probe>(
    dealt: &mut Dealt<'_, T>,
    rank: &impl Fn(&T) -> u64,
    alone: bool,
    room: &mut BucketBuffer<T>,
    probe: &mut P,
) -> Vec<Range<usize>> {
    let most = most::<T>();
    room.copy(most);
    let mut large: Vec<Range<usize>> = vec![];
    let mut before = None;
    while let Some((bucket, range)) = dealt.take(most, &mut room.copy, probe) {
        let (is_whole, to) = (dealt.size(bucket) <= most, dealt.items(range.clone()));
        if is_whole && alone {
            gather(to, rank, room, probe);
        } else {
            to.copy_from_slice(&room.copy);
            probe.write(to);
            match large.last_mut() {
                Some(last) if before == Some(bucket) => last.end = range.end,
                _ => large.push(range),
            }
        }
        before = Some(bucket);
    }
    dealt.lift(probe);
    large
}

/// The lowest and the highest of some ranks; if there is none, the other way round.
fn ends(ranks: impl Iterator<Item = u64>) -> (u64, u64) {
    ranks.fold((u64::MAX, 0), |(low, high), rank| (low.min(rank), high.max(rank)))
}

fn sample<T>(records: &[T], rank: &impl Fn(&T) -> u64) -> Vec<u64> {
    let count = (records.len() / SAMPLE_SIZES.0).clamp(1, SAMPLE_SIZES.1);
    let mut place = 0.0;
    let next = || {
        // Steps of an irrational share of the length fall in with no period of the input.
        place += 0.618_033_988_749_894_9;
        place -= f64::trunc(place);
        rank(&records[(place * records.len() as f64) as usize])
    };
    std::iter::repeat_with(next).take(count).collect()
}

/// Most bits of such records dealt at once.
fn most_bits<T>() -> u32 {
    let block = deal::block::<T>().saturating_mul(size_of::<T>()).max(1);
    (BLOCKS_BYTES / block).max(2).ilog2().min(DEAL_BITS)
}

/// Buckets of equal ranges of ranks; those beyond the ends go to the first and the last.
struct Scale {
    low: u64,
    range: u64,
    shift: u32,
}

impl Scale {
    /// For ranks of about `low` to `high`, which is more, in some 2^`bits` buckets, or as many as records may have.
    fn new<T>(low: u64, high: u64, bits: u32) -> Self {
        let range = high - low;
        let span = u64::BITS - range.leading_zeros();
        // Where one bucket for each rank is affordable, that ends the matter.
        let most = most_bits::<T>();
        let shift = if span <= most { 0 } else { span - bits.min(most) };
        Self { low, range, shift }
    }

    /// Returns true if more than a quarter of the records come to one bucket, as far as a sample says; none says so.
    fn crowds(&self, sample: &[u64]) -> bool {
        let mut sizes = vec![0; self.buckets()];
        sample.iter().for_each(|&rank| sizes[self.bucket(rank)] += 1);
        sizes.into_iter().max() >= Some(sample.len() / 4)
    }

    fn buckets(&self) -> usize {
        (self.range >> self.shift) as usize + 1
    }

    #[inline(always)]
    fn bucket(&self, rank: u64) -> usize {
        (rank.saturating_sub(self.low).min(self.range) >> self.shift) as usize
    }
}

/// Parts of the records, from the front to the back.
fn cut<'a, T>(mut records: &'a mut [T], parts: &[Range<usize>]) -> Vec<&'a mut [T]> {
    let (mut cut, mut at) = (Vec::with_capacity(parts.len()), 0);
    for part in parts {
        let head;
        (head, records) = records.split_at_mut(part.end - at);
        cut.push(&mut head[part.start - at..]);
        at = part.end;
    }
    cut
}

/// Sorts so few records that comparing is the fastest way.
fn few<T, P: Probe>(records: &mut [T], rank: impl Fn(&T) -> u64, probe: &mut P) {
    probe.read(records);
    records.sort_by_key(rank);
    probe.write(records);
}

/// Sorts records that fit the cache.
fn unknown<T: Copy, P: Probe>(
    records: &mut [T],
    rank: &impl Fn(&T) -> u64,
    room: &mut BucketBuffer<T>,
    probe: &mut P,
) {
    room.copy(records.len()).extend_from_slice(records);
    probe.read(records);
    gather(records, rank, room, probe);
}

/// Writes the records of `room.copy`, at least one, in order; they fit the cache.
fn gather<T: Copy, P: Probe>(
    to: &mut [T],
    rank: &impl Fn(&T) -> u64,
    room: &mut BucketBuffer<T>,
    probe: &mut P,
) {
    room.words();
    let BucketBuffer { words, copy } = room;
    probe.place(copy);
    probe.write(copy);
    if copy.len() <= STANDARD_SORT_MAX {
        to.copy_from_slice(copy);
        probe.read(copy);
        probe.lift(copy);
        return few(to, rank, probe);
    }
    words.extend(copy.iter().map(rank));
    let (low, high) = ends(words.iter().copied());
    let range = high - low;
    probe.place(words);
    probe.read(copy);
    probe.write(words);
    if range < FEW_RANKS {
        if range == 0 {
            to.copy_from_slice(copy);
        } else {
            count(copy, words, low, to);
        }
        probe.read(copy);
        probe.write(to);
        probe.lift(words);
        return probe.lift(copy);
    }
    let number_bits = usize::BITS - (copy.len() - 1).leading_zeros();
    let span = u64::BITS - range.leading_zeros();
    let shift = (span + number_bits).saturating_sub(u64::BITS);
    for (number, word) in words.iter_mut().enumerate() {
        *word = (*word - low) >> shift << number_bits | number as u64;
    }
    quick::alone(words, probe);
    let numbers = (1 << number_bits) - 1;
    for (record, word) in to.iter_mut().zip(&*words) {
        *record = copy[(word & numbers) as usize];
    }
    let alike = if shift > 0 { runs(words, number_bits) } else { Vec::new() };
    probe.read(words);
    probe.read(copy);
    probe.write(to);
    probe.lift(words);
    probe.lift(copy);
    for run in alike {
        settle(&mut to[run], rank, room, probe);
    }
}

/// Where words agree in all but the number.
fn runs(words: &[u64], number_bits: u32) -> Vec<Range<usize>> {
    let alike = |a: u64, b: u64| (a ^ b) >> number_bits == 0;
    // Nearly always none: one look without a branch in it, before each word is taken by itself.
    if !words.iter().zip(&words[1..]).fold(false, |any, (&a, &b)| any | alike(a, b)) {
        return Vec::new();
    }
    let all = || words.chunk_by(|&a, &b| alike(a, b));
    // Not a byte more than they need, as [`room_bytes`] says.
    let mut runs = Vec::with_capacity(all().filter(|run| run.len() > 1).count());
    let mut start = 0;
    for run in all() {
        if run.len() > 1 {
            runs.push(start..start + run.len());
        }
        start += run.len();
    }
    runs
}

/// Puts records in order whose words agree but for the number.
fn settle<T: Copy, P: Probe>(
    records: &mut [T],
    rank: &impl Fn(&T) -> u64,
    room: &mut BucketBuffer<T>,
    probe: &mut P,
) {
    probe.read(records);
    if records.len() <= STANDARD_SORT_MAX {
        few(records, rank, probe);
    } else if super::run(records, rank) != Some(Run::Rises) {
        unknown(records, rank, room, probe);
    }
}

/// Writes records of few ranks in order, by counting: `ranks` are theirs, the lowest is `low`.
fn count<T: Copy>(records: &[T], ranks: &[u64], low: u64, to: &mut [T]) {
    let mut next = [0; FEW_RANKS as usize];
    for rank in ranks {
        next[(rank - low) as usize] += 1;
    }
    let mut start = 0;
    for next in &mut next {
        (start, *next) = (start + *next, start);
    }
    for (record, rank) in records.iter().zip(ranks) {
        let next = &mut next[(rank - low) as usize];
        to[*next] = *record;
        *next += 1;
    }
}
