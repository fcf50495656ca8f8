//! The shape of a simulated cache.

use crate::Error;

/// Which block makes room for a new one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Replacement {
    /// The one whose last access is longest ago.
    Lru,
    /// The one that came first.
    Fifo,
    /// Any of them with the same probability, drawn from a generator with that seed: equal seeds give equal counts.
    Random(u64),
}

/// Size, blocks and replacement of one cache, in bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct CacheShape {
    /// M: bytes it holds, a multiple of a set: `block` times `ways`.
    pub memory: usize,
    /// B: bytes of a block, a power of two.
    pub block: usize,
    /// Blocks of one set; block number b can only be in set b mod (number of sets). `None`: one set holds all.
    pub ways: Option<usize>,
    /// Who makes room, among the blocks of a set.
    pub replacement: Replacement,
}

impl CacheShape {
    /// A first-level data cache of 2024: 48 KiB, 64 sets of 12 lines of 64 bytes.
    pub const L1: Self = Self::lru(48 << 10, 64).with_ways(12);
    /// A second-level cache of 2024: 1 MiB, 1024 sets of 16 lines of 64 bytes.
    pub const L2: Self = Self::lru(1 << 20, 64).with_ways(16);
    /// A first-level table of data addresses: 64 pages of 4 KiB, any page in any place. It is far from tall.
    pub const DTLB: Self = Self::lru(64 << 12, 4 << 10);

    /// A memory of `memory` bytes in blocks of `block` bytes, any block in any place, the oldest access goes.
    pub const fn lru(memory: usize, block: usize) -> Self {
        Self { memory, block, ways: None, replacement: Replacement::Lru }
    }

    /// The same with the oldest arrival going.
    pub const fn fifo(memory: usize, block: usize) -> Self {
        Self { memory, block, ways: None, replacement: Replacement::Fifo }
    }

    /// The same with one at random going, by the generator of that seed.
    pub const fn random(memory: usize, block: usize, seed: u64) -> Self {
        Self { replacement: Replacement::Random(seed), ..Self::lru(memory, block) }
    }

    /// The same cut into sets of `ways` blocks.
    pub const fn with_ways(self, ways: usize) -> Self {
        Self { ways: Some(ways), ..self }
    }

    /// Blocks that fit; none if a block has no bytes.
    pub const fn blocks(&self) -> usize {
        match self.memory.checked_div(self.block) {
            Some(blocks) => blocks,
            None => 0,
        }
    }

    /// Refuses what is no cache.
    ///
    /// # Errors
    /// [`Error::Option`] where the block is no power of two or larger than [`BLOCK_MAX`], or the memory is empty, not a
    /// whole number of sets, or holds 2³² blocks or more, 2²⁶ if these are cut into sets.
    pub(super) fn check(&self) -> Result<(), Error> {
        if !self.block.is_power_of_two() || self.block > BLOCK_MAX {
            return Err(Error::Option {
                name: "block",
                value: self.block.to_string(),
                expected: "a power of two, in bytes, of at most 2^30",
            });
        }
        let ways = self.ways.unwrap_or(1);
        if ways == 0 || ways > self.blocks() {
            return Err(Error::Option {
                name: "ways",
                value: ways.to_string(),
                expected: "at least one and at most the blocks that fit the memory",
            });
        }
        let whole = self.memory.is_multiple_of(self.block) && self.blocks().is_multiple_of(ways);
        let most = if ways < self.blocks() && self.ways.is_some() { SET_BLOCKS } else { u32::MAX };
        if !whole || self.blocks() >= most as usize {
            return Err(Error::Option {
                name: "memory",
                value: self.memory.to_string(),
                expected: "a whole number of sets of blocks, fewer than 2^32 blocks, 2^26 in several sets",
            });
        }
        Ok(())
    }
}

/// Bytes of the largest block: all arrays of a process then find places of their own among 2⁶⁴ bytes.
const BLOCK_MAX: usize = 1 << 30;
/// Blocks of a cache of several sets, whose places are all there from the start: 24 bytes each.
const SET_BLOCKS: u32 = 1 << 26;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate::Simulator;

    #[test]
    fn what_is_no_cache_is_refused_by_name() {
        let named = |shape: CacheShape| match Simulator::new(&[shape]) {
            Err(Error::Option { name, .. }) => Some(name),
            _ => None,
        };
        assert_eq!(CacheShape::lru(64, 0).blocks(), 0);
        assert_eq!(named(CacheShape::lru(64, 0)), Some("block"));
        assert_eq!(named(CacheShape::lru(96, 48)), Some("block"));
        assert_eq!(named(CacheShape::lru(usize::MAX, 1 << 63)), Some("block"));
        assert_eq!(named(CacheShape::lru(0, 64)), Some("ways"));
        assert_eq!(named(CacheShape::lru(64, 64).with_ways(0)), Some("ways"));
        assert_eq!(named(CacheShape::lru(640, 64).with_ways(3)), Some("memory"));
        assert_eq!(named(CacheShape::lru(100, 64)), Some("memory"));
        // Places for 2³¹ sets would be 50 GB; the same cache as one set takes them as they are needed.
        assert_eq!(named(CacheShape::lru(1 << 31, 1).with_ways(1)), Some("memory"));
        assert_eq!(named(CacheShape::lru(1 << 31, 1)), None);
        assert_eq!(named(CacheShape::lru(1 << 40, 1 << 30).with_ways(1)), None);
    }
}
