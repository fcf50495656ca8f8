//! Room beside the records, and for how many threads there is any.
//!
//! *Guarantee.* Whoever has a room allocates no more than [`room_bytes`] beside it and a fortieth of the records, and nobody
//! deals or gathers without one. So a limit on memory holds for any number of threads: those without a room wait.
//! *Trap.* A thread that waits for others takes up their work meanwhile, in a pool of threads. If it kept its room, it could
//! come to wait for that one; so no room is held where threads are waited for.

use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

use super::LARGE_BYTES;

/// Parts of fewer bytes are sorted by one thread each where memory is limited: a list of 2¹⁰ buckets for each part that
/// waits is then below a hundredth of the records.
const SHARED_BYTES: usize = 16 << 20;

/// Most bytes that a thread with a room allocates for records of `width` bytes, up to 256: a bucket, a word and half a range for
/// each record in it, blocks of 1 KiB for all buckets, and their places and sizes.
pub(in crate::sort) fn room_bytes(width: usize) -> usize {
    2 * LARGE_BYTES + LARGE_BYTES / width * 16 + (128 << 10)
}

/// Room that sorting one bucket needs; kept from bucket to bucket.
pub(super) struct BucketBuffer<T> {
    pub(super) words: Vec<u64>,
    pub(super) copy: Vec<T>,
}

impl<T> BucketBuffer<T> {
    /// An empty place for copies of so many records.
    pub(super) fn copy(&mut self, count: usize) -> &mut Vec<T> {
        empty(&mut self.copy, count, LARGE_BYTES / size_of::<T>().max(1));
        &mut self.copy
    }

    /// An empty place for a word for each record in the copy.
    pub(super) fn words(&mut self) {
        empty(&mut self.words, self.copy.len(), LARGE_BYTES / size_of::<T>().max(1));
    }
}

/// Empties a list and makes room for `count` items, without holding the old and the new at once; `most` are the usual limit.
fn empty<T>(list: &mut Vec<T>, count: usize, most: usize) {
    list.clear();
    if list.capacity() < count {
        *list = Vec::new();
        list.reserve_exact(count.next_power_of_two().min(most.max(count)));
    }
}

/// So many rooms, made when they are asked for.
pub(in crate::sort) struct BucketBuffers<T> {
    state: Mutex<State<T>>,
    given_back: Condvar,
    /// True if there are fewer than anybody may ask for.
    limited: bool,
}

struct State<T> {
    idle: Vec<BucketBuffer<T>>,
    /// Rooms that nobody has.
    left: usize,
}

impl<T> BucketBuffers<T> {
    /// As many as there are threads.
    pub(in crate::sort) fn any() -> Self {
        Self { limited: false, ..Self::most(usize::MAX) }
    }

    pub(in crate::sort) fn most(rooms: usize) -> Self {
        let state = State { idle: Vec::new(), left: rooms };
        Self { state: Mutex::new(state), given_back: Condvar::new(), limited: true }
    }

    /// Returns true if several threads may sort these records.
    pub(super) fn shares(&self, records: &[T]) -> bool {
        !self.limited || size_of_val(records) > SHARED_BYTES
    }

    /// Does what needs a room, once there is one; `work` must not wait for other threads.
    pub(super) fn within<R>(&self, work: impl FnOnce(&mut BucketBuffer<T>) -> R) -> R {
        let mut state = self.lock();
        while state.left == 0 {
            state = self.given_back.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
        state.left -= 1;
        let room = state.idle.pop().unwrap_or(BucketBuffer { words: Vec::new(), copy: Vec::new() });
        drop(state);
        work(&mut Taken { rooms: self, room }.room)
    }

    /// Nothing can be broken by a panic while it is locked.
    fn lock(&self) -> MutexGuard<'_, State<T>> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// A room that is given back, also if the work panics.
struct Taken<'a, T> {
    rooms: &'a BucketBuffers<T>,
    room: BucketBuffer<T>,
}

impl<T> Drop for Taken<'_, T> {
    fn drop(&mut self) {
        let BucketBuffer { words, copy } = &mut self.room;
        let room = BucketBuffer { words: std::mem::take(words), copy: std::mem::take(copy) };
        let mut state = self.rooms.lock();
        state.idle.push(room);
        state.left += 1;
        drop(state);
        self.rooms.given_back.notify_one();
    }
}
