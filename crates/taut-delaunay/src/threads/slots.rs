//! Slots for new simplices: each thread takes them in pieces, so that they seldom ask each other.

use std::ops::Range;
use std::sync::atomic::Ordering::Relaxed;

use crate::threads::Slot;
use crate::threads::atomics::AtomicU32;

/// Slots that a thread takes at once.
const PIECE: u32 = if cfg!(any(loom, test)) { 2 } else { 1024 };

/// The slots that nobody has taken yet, from `next` on to the end of the records.
#[derive(Clone, Copy)]
pub(crate) struct Room<'a> {
    pub(crate) next: &'a AtomicU32,
    pub(crate) end: u32,
}

impl Room<'_> {
    /// Slots that a thread may have taken and not used when another finds none.
    pub(crate) const SLOTS_SPARE: usize = PIECE as usize;

    /// Takes a piece of at least `least` slots, if there is one.
    fn take(self, least: u32) -> Option<Range<u32>> {
        let piece = |next: u32| {
            let left = self.end.saturating_sub(next);
            (left >= least).then(|| next + left.min(least.max(PIECE)))
        };
        let begin = self.next.fetch_update(Relaxed, Relaxed, piece).ok()?;
        Some(begin..piece(begin).unwrap_or(begin))
    }

    /// A slot with a property that most have: `first`, or one of a few others.
    pub(crate) fn some_of(self, first: u32, has: impl Fn(&u32) -> bool) -> u32 {
        /// 2³² divided by the golden ratio: multiples of it come near every number.
        const STEP: u32 = 0x9e37_79b1;
        /// Slots to look at; half of all, at most, are dead.
        const LOOKS: u32 = 64;
        let taken = u64::from(self.next.load(Relaxed));
        let slot =
            |i: u32| ((u64::from(first.wrapping_add(i.wrapping_mul(STEP))) * taken) >> 32) as u32;
        std::iter::once(first).chain((1..LOOKS).map(slot)).find(has).unwrap_or(first)
    }
}

/// The slots of one thread that hold no simplex.
#[derive(Default)]
pub(crate) struct OwnSlots {
    /// Those that held one; marked as dead.
    free: Vec<u32>,
    /// Those that never did.
    fresh: Range<u32>,
}

impl OwnSlots {
    /// Makes sure that `count` slots are there. Returns false if there is no room for so many.
    #[inline(always)]
    pub(crate) fn reserve<const V: usize, R: Slot<V>>(
        &mut self,
        count: usize,
        room: Room<'_>,
        records: &[R],
    ) -> bool {
        self.free.len() + self.fresh.len() >= count || self.refill(count, room, records)
    }

    #[cold]
    fn refill<const V: usize, R: Slot<V>>(
        &mut self,
        count: usize,
        room: Room<'_>,
        records: &[R],
    ) -> bool {
        let missing = count - self.free.len() - self.fresh.len();
        let Some(more) = room.take(missing as u32) else { return false };
        if self.fresh.end == more.start && !self.fresh.is_empty() {
            self.fresh.end = more.end;
        } else {
            self.mark_dead(records);
            self.fresh = more;
        }
        true
    }

    /// Takes a slot that [`reserve`](Self::reserve) made sure of.
    #[inline(always)]
    pub(crate) fn pop(&mut self) -> u32 {
        self.free.pop().unwrap_or_else(|| {
            let slot = self.fresh.start;
            debug_assert!(slot < self.fresh.end, "slots are reserved");
            self.fresh.start += 1;
            slot
        })
    }

    /// Takes a slot back whose record is dead.
    #[inline(always)]
    pub(crate) fn push(&mut self, slot: u32) {
        self.free.push(slot);
    }

    /// Gives back what was taken last and not used, if nobody took any after it; marks the rest as dead.
    pub(crate) fn give_back<const V: usize, R: Slot<V>>(
        &mut self,
        next: &AtomicU32,
        records: &[R],
    ) {
        if next.load(Relaxed) == self.fresh.end {
            next.store(self.fresh.start, Relaxed);
            self.fresh = 0..0;
        } else {
            self.mark_dead(records);
        }
    }

    /// Marks the fresh slots as dead.
    fn mark_dead<const V: usize, R: Slot<V>>(&mut self, records: &[R]) {
        for slot in std::mem::take(&mut self.fresh) {
            records[slot as usize].kill();
            self.free.push(slot);
        }
    }
}
