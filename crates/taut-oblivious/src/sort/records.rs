//! Sorting records by a key: stable, in two buffers.
//!
//! *Idea.* One pass deals the records by the leading bits of `key − smallest` into buckets that fit the second-level
//! cache. There each record is represented by one word, the leading bits of its key beside its number in the bucket;
//! the words are sorted by the vector kernels, and the records gathered in their order.
//! *Guarantee.* Stable, so that the result is a function of the input whatever the machine and the threads. O(n) passes
//! of memory for keys that spread; a bucket that is too large is dealt again, at most 64 bits deep. Room for n records.
//! *Trap.* Words that agree in the bits they have room for must be told apart by the rest of the key, and records that
//! agree in all of it stay in order since the number in the bucket is the last part of the word.
//! *Trap.* Scattering from the records into fresh memory and gathering back would write every line of both for the
//! first time twice; copying first, then scattering home, leaves the gathering within the cache.
//! *Reference.* D. Knuth, *The Art of Computer Programming* 3, 5.2.5 (distribution), 5.2 (address table sorting).

use std::ops::Range;

use rayon::prelude::*;

use super::{Run, quick};
use crate::probe::{NoProbe, Probe};
use crate::room;

/// Up to this many records are sorted by the standard library.
const FEW: usize = 24;
/// Bytes of records in a bucket at which one pass of dealing aims: a quarter of a second-level cache.
const BUCKET_BYTES: usize = 1 << 19;
/// Most bits dealt at once: more buckets than that have no room in the first levels of the cache and of the TLB.
const DEAL_BITS: u32 = 11;
/// Buckets above this many bytes are dealt again.
const LARGE_BYTES: usize = 1 << 20;

/// Buckets of fewer ranks than this are sorted by counting.
const FEW_RANKS: u64 = 256;

/// Room that sorting one bucket needs; kept from bucket to bucket.
struct Room<T> {
    words: Vec<u64>,
    copy: Vec<T>,
}

impl<T> Default for Room<T> {
    fn default() -> Self {
        Self { words: Vec::new(), copy: Vec::new() }
    }
}

/// Sorts records by their rank.
pub(super) fn sort<T: Copy + Send + Sync, P: Probe>(
    records: &mut [T],
    rank: &(impl Fn(&T) -> u64 + Sync),
    probe: &mut P,
) {
    probe.place(records);
    part(records, rank, &mut Room::default(), probe);
}

/// Sorts a part of the records of which nothing is known.
fn part<T: Copy + Send + Sync, P: Probe>(
    records: &mut [T],
    rank: &(impl Fn(&T) -> u64 + Sync),
    room: &mut Room<T>,
    probe: &mut P,
) {
    if records.len() <= FEW {
        return few(records, rank, probe);
    }
    probe.read(records);
    if let Some(run) = super::run(records, rank) {
        // Equal ranks must keep their order, so only a strict fall may be turned.
        if run == Run::Falls {
            records.reverse();
            probe.write(records);
        }
        return;
    }
    if size_of_val(records) <= LARGE_BYTES {
        return unknown(records, rank, room, probe);
    }
    let (starts, low, shift) = deal(records, rank, probe);
    if shift == 0 {
        return; // Each bucket is one rank.
    }
    let buckets = cut(records, &starts);
    if P::LISTENS || rayon::current_num_threads() == 1 {
        for (records, i) in buckets {
            dealt(records, rank, low + (i << shift), shift, room, probe);
        }
    } else {
        buckets.into_par_iter().with_min_len(8).for_each_init(
            Room::default,
            |room, (records, i)| {
                dealt(records, rank, low + (i << shift), shift, room, &mut NoProbe);
            },
        );
    }
}

/// Sorts a bucket whose ranks are from `low` to `low + 2^shift − 1`.
fn dealt<T: Copy + Send + Sync, P: Probe>(
    records: &mut [T],
    rank: &(impl Fn(&T) -> u64 + Sync),
    low: u64,
    shift: u32,
    room: &mut Room<T>,
    probe: &mut P,
) {
    if records.len() <= FEW {
        few(records, rank, probe);
    } else if size_of_val(records) > LARGE_BYTES {
        part(records, rank, room, probe);
    } else {
        bucket(records, rank, low, (1 << shift) - 1, room, probe);
    }
}

/// Sorts so few records that comparing is the fastest way.
fn few<T, P: Probe>(records: &mut [T], rank: impl Fn(&T) -> u64, probe: &mut P) {
    probe.read(records);
    records.sort_by_key(rank);
    probe.write(records);
}

/// Deals the records into buckets by `(rank − low) >> shift`, `low` being the lowest rank; returns where each bucket
/// starts, and the end, with `low` and `shift`. Not all ranks are equal.
fn deal<T: Copy, P: Probe>(
    records: &mut [T],
    rank: impl Fn(&T) -> u64,
    probe: &mut P,
) -> (Vec<usize>, u64, u32) {
    let (mut low, mut high) = (u64::MAX, 0);
    let copy = room::filled(records.iter().map(|record| {
        let rank = rank(record);
        (low, high) = (low.min(rank), high.max(rank));
        *record
    }));
    probe.place(&copy);
    probe.read(records);
    probe.write(&copy);
    let range = high - low;
    let wanted = (size_of_val(records) / BUCKET_BYTES).max(2).ilog2() + 1;
    let span = 64 - range.leading_zeros();
    // Where one bucket for each rank is affordable, that ends the matter.
    let shift = if span <= DEAL_BITS { 0 } else { span - wanted.min(DEAL_BITS) };
    let bucket = |record: &T| ((rank(record) - low) >> shift) as usize;
    let mut starts = vec![0; (range >> shift) as usize + 2];
    for record in &copy {
        starts[bucket(record) + 1] += 1;
    }
    for i in 1..starts.len() {
        starts[i] += starts[i - 1];
    }
    probe.read(&copy);
    let mut next = starts.clone();
    for record in &copy {
        let place = &mut next[bucket(record)];
        records[*place] = *record;
        if P::LISTENS {
            probe.read(std::slice::from_ref(record));
            probe.write(&records[*place..][..1]);
        }
        *place += 1;
    }
    probe.lift(&copy);
    (starts, low, shift)
}

/// The buckets with their numbers, empty ones left out.
fn cut<'a, T>(mut records: &'a mut [T], starts: &[usize]) -> Vec<(&'a mut [T], u64)> {
    let mut cut = Vec::new();
    for (i, ends) in starts.windows(2).enumerate() {
        if ends[1] > ends[0] {
            let head;
            (head, records) = records.split_at_mut(ends[1] - ends[0]);
            cut.push((head, i as u64));
        }
    }
    cut
}

/// Sorts records that fit the cache.
fn unknown<T: Copy, P: Probe>(
    records: &mut [T],
    rank: &impl Fn(&T) -> u64,
    room: &mut Room<T>,
    probe: &mut P,
) {
    let ends = |(low, high): (u64, u64), rank: u64| (low.min(rank), high.max(rank));
    let (low, high) = records.iter().map(rank).fold((u64::MAX, 0), ends);
    probe.read(records);
    bucket(records, rank, low, high - low, room, probe);
}

/// Sorts records that fit the cache, whose ranks are from `low` to `low + range`.
fn bucket<T: Copy, P: Probe>(
    records: &mut [T],
    rank: &impl Fn(&T) -> u64,
    low: u64,
    range: u64,
    room: &mut Room<T>,
    probe: &mut P,
) {
    if range < FEW_RANKS {
        return count(records, |record| (rank(record) - low) as usize, room, probe);
    }
    let number_bits = usize::BITS - (records.len() - 1).leading_zeros();
    let span = 64 - range.leading_zeros();
    let shift = (span + number_bits).saturating_sub(64);
    room.words.clear();
    room.words.extend(
        records.iter().enumerate().map(|(i, r)| (rank(r) - low) >> shift << number_bits | i as u64),
    );
    room.copy.clear();
    room.copy.extend_from_slice(records);
    probe.place(&room.words);
    probe.place(&room.copy);
    probe.read(records);
    probe.write(&room.words);
    probe.write(&room.copy);
    quick::sort(&mut room.words, probe);
    let numbers = (1 << number_bits) - 1;
    for (record, word) in records.iter_mut().zip(&room.words) {
        *record = room.copy[(word & numbers) as usize];
    }
    let alike = if shift > 0 { runs(&room.words, number_bits) } else { Vec::new() };
    probe.read(&room.words);
    probe.read(&room.copy);
    probe.write(records);
    probe.lift(&room.words);
    probe.lift(&room.copy);
    for run in alike {
        settle(&mut records[run], rank, room, probe);
    }
}

/// Where words agree in all but the number.
fn runs(words: &[u64], number_bits: u32) -> Vec<Range<usize>> {
    let alike = |a: u64, b: u64| (a ^ b) >> number_bits == 0;
    let mut runs = Vec::new();
    // Nearly always none: one look without a branch in it, before each word is taken by itself.
    if words.iter().zip(&words[1..]).fold(false, |any, (&a, &b)| any | alike(a, b)) {
        let mut start = 0;
        for run in words.chunk_by(|&a, &b| alike(a, b)) {
            if run.len() > 1 {
                runs.push(start..start + run.len());
            }
            start += run.len();
        }
    }
    runs
}

/// Puts records in order whose words agree but for the number.
fn settle<T: Copy, P: Probe>(
    records: &mut [T],
    rank: &impl Fn(&T) -> u64,
    room: &mut Room<T>,
    probe: &mut P,
) {
    probe.read(records);
    if records.len() <= FEW {
        few(records, rank, probe);
    } else if super::run(records, rank) != Some(Run::Rises) {
        unknown(records, rank, room, probe);
    }
}

/// Sorts records that fit the cache and have few ranks, by counting.
fn count<T: Copy, P: Probe>(
    records: &mut [T],
    place: impl Fn(&T) -> usize,
    room: &mut Room<T>,
    probe: &mut P,
) {
    let mut next = [0; FEW_RANKS as usize];
    room.copy.clear();
    room.copy.extend(records.iter().map(|record| {
        next[place(record)] += 1;
        *record
    }));
    let mut start = 0;
    for next in &mut next {
        (start, *next) = (start + *next, start);
    }
    for record in &room.copy {
        let next = &mut next[place(record)];
        records[*next] = *record;
        *next += 1;
    }
    probe.place(&room.copy);
    probe.read(records);
    probe.write(&room.copy);
    probe.read(&room.copy);
    probe.write(records);
    probe.lift(&room.copy);
}
