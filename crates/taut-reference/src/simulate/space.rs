//! The simulated address space: where announced arrays lie, whatever the allocator did.
//!
//! Idea: an array gets the lowest place that is free, on a border of blocks; when it is lifted its place is free again,
//! as on a stack. An array announced inside another one, or once more, is a part of it and stays where it is, so that an
//! algorithm may call another one on its data; it is lifted with the whole, by the one who frees it.
//! Guarantee: places depend only on the announcements, not on addresses.
//! Trap: memory that was freed without being lifted comes back as another array. Where the two overlap in part the
//! older one is taken to be gone; where the newer one lies inside the older one it is taken for a part of it.
//! Trap: accesses outside all arrays must not vanish. They are given pages of their own, by first access, and counted.

use std::collections::{BTreeMap, HashMap};

/// Bytes of the pages for accesses outside all arrays, unless blocks are larger.
const PAGE: usize = 4096;
/// This many arrays found lately are looked at first.
const RECENT_ARRAYS: usize = 4;

#[derive(Clone, Debug)]
struct Array {
    bytes: usize,
    /// Where it lies in the simulated space.
    at: u64,
}

/// A run of addresses and where it lies.
#[derive(Clone, Copy, Debug, Default)]
struct Run {
    address: usize,
    bytes: usize,
    at: u64,
}

/// Translates addresses of this process to simulated ones.
#[derive(Clone, Debug)]
pub(super) struct Space {
    /// By address.
    arrays: BTreeMap<usize, Array>,
    /// Free places below `end`, by simulated address, no two side by side.
    gaps: BTreeMap<u64, u64>,
    /// Where never used space begins.
    end: u64,
    align: usize,
    /// Pages that belong to no array, by address divided by the size of a page.
    pages: HashMap<usize, u64>,
    recent: [Run; RECENT_ARRAYS],
    next_recent: usize,
    unannounced: u64,
}

impl Space {
    /// An empty space in which arrays begin at multiples of `align` bytes, a power of two.
    pub(super) fn new(align: usize) -> Self {
        Self {
            arrays: BTreeMap::new(),
            gaps: BTreeMap::new(),
            end: 0,
            align,
            pages: HashMap::new(),
            recent: [Run::default(); RECENT_ARRAYS],
            next_recent: 0,
            unannounced: 0,
        }
    }

    /// Accesses so far that no array holds, or not to their end.
    pub(super) fn unannounced(&self) -> u64 {
        self.unannounced
    }

    pub(super) fn place(&mut self, address: usize, bytes: usize) {
        if bytes == 0 {
            return;
        }
        let end = address.saturating_add(bytes);
        if let Some((&start, array)) = self.arrays.range(..=address).next_back()
            && end - start <= array.bytes
        {
            return;
        }
        let stale: Vec<usize> = self
            .arrays
            .range(..end)
            .rev()
            .take_while(|(start, array)| **start + array.bytes > address)
            .map(|(start, _)| *start)
            .collect();
        for start in stale {
            self.lift(start);
        }
        let at = self.reserve(bytes);
        self.arrays.insert(address, Array { bytes: end - address, at });
    }

    /// Where `address` lies, and how many of the `bytes` bytes from it on lie there without a break.
    #[inline]
    pub(super) fn translate(&mut self, address: usize, bytes: usize) -> (u64, usize) {
        for run in &self.recent {
            let offset = address.wrapping_sub(run.address);
            if offset < run.bytes {
                return (run.at + offset as u64, bytes.min(run.bytes - offset));
            }
        }
        self.find(address, bytes)
    }

    #[cold]
    fn find(&mut self, address: usize, bytes: usize) -> (u64, usize) {
        if let Some((&start, array)) = self.arrays.range(..=address).next_back()
            && address - start < array.bytes
        {
            let run = Run { address: start, bytes: array.bytes, at: array.at };
            self.recent[self.next_recent] = run;
            self.next_recent = (self.next_recent + 1) % RECENT_ARRAYS;
            let offset = address - start;
            return (run.at + offset as u64, bytes.min(run.bytes - offset));
        }
        self.unannounced += 1;
        let size = self.align.max(PAGE);
        let (page, offset) = (address / size, address % size);
        let at = match self.pages.get(&page) {
            Some(&at) => at,
            None => {
                let at = self.reserve(size);
                self.pages.insert(page, at);
                at
            }
        };
        // Up to the next array, the end of the page, or the end of the access.
        let free = self.arrays.range(address..).next().map_or(bytes, |(&start, _)| start - address);
        (at + offset as u64, bytes.min(free).min(size - offset))
    }

    /// Frees the place of the array at an address, if there is one.
    pub(super) fn lift(&mut self, start: usize) {
        if let Some(array) = self.arrays.remove(&start) {
            self.release(array.at, self.rounded(array.bytes));
            self.recent = [Run::default(); RECENT_ARRAYS];
        }
    }

    fn rounded(&self, bytes: usize) -> u64 {
        (bytes as u64).saturating_add(self.align as u64 - 1) & !(self.align as u64 - 1)
    }

    /// The lowest free place of that many bytes.
    fn reserve(&mut self, bytes: usize) -> u64 {
        let bytes = self.rounded(bytes);
        let fit = self.gaps.iter().find(|(_, free)| **free >= bytes).map(|(at, free)| (*at, *free));
        if let Some((at, free)) = fit {
            self.gaps.remove(&at);
            if free > bytes {
                self.gaps.insert(at + bytes, free - bytes);
            }
            return at;
        }
        let at = self.end;
        self.end = self.end.saturating_add(bytes);
        at
    }

    fn release(&mut self, mut at: u64, mut bytes: u64) {
        if let Some(after) = self.gaps.remove(&(at + bytes)) {
            bytes += after;
        }
        let before = self.gaps.range(..at).next_back().map(|(start, free)| (*start, *free));
        if let Some((start, free)) = before
            && start + free == at
        {
            self.gaps.remove(&start);
            (at, bytes) = (start, free + bytes);
        }
        if at + bytes == self.end {
            self.end = at;
        } else {
            self.gaps.insert(at, bytes);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn places_follow_the_announcements_not_the_addresses() {
        let mut space = Space::new(64);
        space.place(9000, 100);
        space.place(500, 10);
        assert_eq!(space.translate(9099, 1), (99, 1));
        assert_eq!(space.translate(500, 10), (128, 10));
        space.lift(9000);
        space.place(70_000, 64);
        assert_eq!(space.translate(70_000, 8), (0, 8));
        space.place(80_000, 65);
        assert_eq!(space.translate(80_000, 8), (192, 8));
        assert_eq!(space.unannounced(), 0);
    }

    #[test]
    fn parts_stay_where_they_are() {
        let mut space = Space::new(64);
        space.place(1000, 0);
        space.place(1000, 800);
        space.place(1000, 400);
        space.place(1400, 400);
        assert_eq!(space.translate(1400, 8), (400, 8));
        space.lift(1400);
        assert_eq!(space.translate(1400, 8), (400, 8));
        space.lift(1000);
        space.translate(1000, 8);
        assert_eq!(space.unannounced(), 1);
        space.lift(1000);
        space.lift(5);
    }

    #[test]
    fn what_overlaps_an_array_replaces_it() {
        let mut space = Space::new(64);
        space.place(1000, 100);
        space.place(1100, 100);
        space.place(1050, 100);
        assert_eq!(space.translate(1050, 1), (0, 1));
        space.translate(1000, 8);
        assert_eq!(space.unannounced(), 1);
    }

    #[test]
    fn accesses_outside_are_counted_and_lie_beside() {
        let mut space = Space::new(64);
        space.place(8192 + 16, 64);
        assert_eq!(space.translate(8192, 100), (64, 16));
        assert_eq!(space.translate(8192 + 16, 84), (0, 64));
        assert_eq!(space.translate(8192 + 80, 20), (64 + 80, 20));
        assert_eq!(space.translate(12_280, 20), (64 + 4088, 8));
        assert_eq!(space.unannounced(), 3);
        space.place(usize::MAX - 10, 100);
        space.translate(usize::MAX - 1, 100);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(if cfg!(miri) { 3 } else { 256 }))]
        /// Arrays in use never share a byte, and free space is put together again.
        #[test]
        fn arrays_are_disjoint(steps in prop::collection::vec((0usize..30, 1usize..400), 1..80)) {
            let mut space = Space::new(16);
            let mut live: Vec<(usize, usize)> = Vec::new();
            for (slot, bytes) in steps {
                let address = 1000 * (slot + 1);
                if let Some(place) = live.iter().position(|l| l.0 == address) {
                    space.lift(address);
                    live.remove(place);
                } else {
                    space.place(address, bytes);
                    live.push((address, bytes));
                }
                let mut runs: Vec<(u64, u64)> = live
                    .iter()
                    .map(|&(a, b)| (space.translate(a, b).0, b as u64))
                    .collect();
                runs.sort_unstable();
                prop_assert!(runs.windows(2).all(|w| w[0].0 + w[0].1 <= w[1].0));
                prop_assert!(runs.iter().all(|r| r.0 % 16 == 0));
            }
            for (address, _) in live {
                space.lift(address);
            }
            prop_assert_eq!(space.end, 0);
            prop_assert!(space.gaps.is_empty());
        }
    }
}
