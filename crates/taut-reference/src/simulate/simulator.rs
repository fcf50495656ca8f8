//! Caches that record every access, side by side or one behind the other.

use super::cache::{Cache, Counts};
use super::shape::CacheShape;
use super::space::Space;
use crate::{Access, Error, Probe};

/// Several caches at once, to be handed to an algorithm as its probe.
///
/// Arrays begin at multiples of the largest block. Cost: O(1) per access, cache and block accessed; memory in proportion
/// to the caches and to the blocks ever accessed.
#[derive(Clone, Debug)]
pub struct Simulator {
    space: Space,
    caches: Vec<Cache>,
    chained: bool,
}

impl Simulator {
    /// Empty caches side by side: each records every access, as if it were alone.
    ///
    /// This is the model of the theory, where an algorithm that is optimal for two levels is so for each pair of many.
    ///
    /// # Errors
    /// [`Error::Option`] if a shape is no cache.
    pub fn new(shapes: &[CacheShape]) -> Result<Self, Error> {
        for shape in shapes {
            shape.check()?;
        }
        let align = shapes.iter().map(|shape| shape.block).max().unwrap_or(1);
        let caches = shapes.iter().map(Cache::new).collect();
        Ok(Self { space: Space::new(align), caches, chained: false })
    }

    /// Empty caches one behind the other, as in a processor: the second records only what the first misses (a read) and
    /// writes back (a write), and so on. Blocks may be in several of them; none is thrown out because another one lost it.
    ///
    /// # Errors
    /// [`Error::Option`] if a shape is no cache.
    pub fn chained(shapes: &[CacheShape]) -> Result<Self, Error> {
        Ok(Self { chained: true, ..Self::new(shapes)? })
    }

    /// Returns the counts of the cache of that number so far.
    ///
    /// # Panics
    /// If there is no such cache.
    pub fn counts(&self, cache: usize) -> Counts {
        self.caches[cache].counts()
    }

    /// Accesses that lay outside all announced arrays, at least in part; 0 for a correct algorithm.
    ///
    /// They are simulated, in pages of their own, but where in these they lie depends on the allocator.
    pub fn unannounced(&self) -> u64 {
        self.space.unannounced()
    }

    /// Records an access of `bytes` simulated bytes, at least one.
    #[inline]
    pub(super) fn record_at(&mut self, at: u64, bytes: usize, access: Access) {
        if self.chained {
            record_chained(&mut self.caches, at, bytes, access);
            return;
        }
        for cache in &mut self.caches {
            let last = (at + (bytes as u64 - 1)) >> cache.shift;
            for block in at >> cache.shift..=last {
                cache.record(block, access);
            }
        }
    }
}

/// Goes down the chain with an access; no cache, no access.
fn record_chained(caches: &mut [Cache], at: u64, bytes: usize, access: Access) {
    let Some((first, behind)) = caches.split_first_mut() else { return };
    for block in at >> first.shift..=(at + (bytes as u64 - 1)) >> first.shift {
        let outcome = first.record(block, access);
        if let Some(written) = outcome.written {
            record_chained(behind, written << first.shift, 1 << first.shift, Access::Write);
        }
        if outcome.missed {
            record_chained(behind, block << first.shift, 1 << first.shift, Access::Read);
        }
    }
}

impl Probe for Simulator {
    const IS_RECORDING: bool = true;

    fn place_at(&mut self, address: usize, bytes: usize) {
        self.space.place(address, bytes);
    }

    fn lift_from(&mut self, address: usize) {
        self.space.lift(address);
    }

    #[inline]
    fn record(&mut self, mut address: usize, mut bytes: usize, access: Access) {
        while bytes > 0 {
            let (at, run) = self.space.translate(address, bytes);
            self.record_at(at, run, access);
            address = address.wrapping_add(run);
            bytes -= run;
        }
    }
}
