//! Sorted records that are handed on from the front to the back, and need not come back to their own place.
//!
//! *Problem.* Who writes sorted records to a file has no use for them in memory. To bring them back, blocks of later
//! buckets are moved out of the way first, about one move of each record more, and all are written once more.
//! *Idea.* The records are dealt as always; then buckets are copied out in turn and gathered where the caller wants them.
//! *Guarantee.* The order is that of [`super::sort`]. Where a bucket is too large for that, the records are sorted in their
//! own place.
//! *Trap.* One thread gathers while another one writes. More than two are better used by sorting in place, all buckets at once.

use rayon::prelude::*;

use super::{BucketBuffers, Deal, Dealt, RankRecords, alone, cut, gather, most, put, shared};
use crate::probe::NoProbe;

/// Records that are handed on.
pub(in crate::sort) enum Parts<'a, T> {
    /// All of them are in order.
    Whole(&'a mut [T]),
    /// They come by buckets.
    Buckets(Buckets<'a, T>),
}

/// Buckets, from the first to the last.
pub(in crate::sort) struct Buckets<'a, T>(Dealt<'a, T>);

/// Starts to sort records by their rank, in the `rooms` that there are.
pub(in crate::sort) fn parts<'a, T: Copy + Send + Sync>(
    records: &'a mut [T],
    rank: &(impl Fn(&T) -> u64 + Sync),
    rooms: &BucketBuffers<T>,
) -> Parts<'a, T> {
    let threads = rayon::current_num_threads();
    let is_alone = threads == 1;
    let (mut parts, large) = rooms.within(|room| {
        match super::deal(records, rank, RankRecords::Sample, room, &mut NoProbe) {
            Deal::Sorted(records) => (Parts::Whole(records), Vec::new()),
            Deal::Dealt(dealt) if threads <= 2 && dealt.largest() <= most::<T>() => {
                (Parts::Buckets(Buckets(dealt)), Vec::new())
            }
            Deal::Dealt(mut dealt) => {
                let large = put(&mut dealt, rank, is_alone, room, &mut NoProbe);
                (Parts::Whole(dealt.into_items()), large)
            }
        }
    });
    let Parts::Whole(records) = &mut parts else { return parts };
    if is_alone {
        rooms.within(|room| {
            for range in large {
                alone(&mut records[range], rank, RankRecords::All, room, &mut NoProbe);
            }
        });
    } else {
        let large = cut(records, &large);
        large.into_par_iter().for_each(|records| shared(records, rank, RankRecords::All, rooms));
    }
    parts
}

impl<T: Copy> Buckets<'_, T> {
    /// Writes the records of the next buckets in order to the front of `to`, until it holds `enough` or has no room for
    /// another bucket; their number. If it has room for [`bucket_bytes`] and `enough` is not 0, that is 0 at the end only.
    pub(in crate::sort) fn next(
        &mut self,
        to: &mut [T],
        enough: usize,
        rank: &impl Fn(&T) -> u64,
        rooms: &BucketBuffers<T>,
    ) -> usize {
        let Self(dealt) = self;
        rooms.within(|room| {
            let mut filled = 0;
            while filled < enough && dealt.next_size() <= to.len() - filled {
                let Some(_) = dealt.take_out(most::<T>(), room.copy(most::<T>()), &mut NoProbe)
                else {
                    break;
                };
                let to = &mut to[filled..][..room.copy.len()];
                gather(to, rank, room, &mut NoProbe);
                filled += to.len();
            }
            filled
        })
    }
}

pub(in crate::sort) fn bucket_bytes() -> usize {
    super::LARGE_BYTES
}
