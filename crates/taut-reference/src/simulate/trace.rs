//! Recorded accesses, and what any memory would have made of them.

use std::fmt;

use super::cache::Counts;
use super::optimal::optimal;
use super::shape::CacheShape;
use super::simulator::Simulator;
use super::space::Space;
use super::stack::StackDistances;
use crate::{Access, Error, Probe};

/// One access, in simulated addresses.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct RecordedAccess {
    /// The first byte.
    pub at: u64,
    /// The number of bytes, at least one; longer accesses are cut.
    pub bytes: u32,
    /// Read or written.
    pub access: Access,
}

/// All accesses of an algorithm, in order; 16 bytes each. Two runs with equal traces miss alike in every memory.
///
/// ```
/// use taut_reference::algorithms::transpose_instrumented;
/// use taut_reference::simulate::Trace;
///
/// let n = 64;
/// let (from, mut to) = (vec![1.0f64; n * n], vec![0.0; n * n]);
/// let mut trace = Trace::new(512)?;                            // the largest block to be asked for
/// transpose_instrumented(&from, &mut to, n, n, 1, &mut trace)?;
/// let best = trace.optimal(1 << 14, 64)?;
/// assert_eq!(best.misses, 2 * (n * n * 8 / 64) as u64);        // 2n²/B: each block of both once
/// let rows = trace.misses_by_block(1 << 14, &[64, 128, 256])?; // for a plot, shown as memory,block,misses
/// assert_eq!(rows[0].to_string(), "16384,64,1024");
/// # Ok::<(), taut_oblivious::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Trace {
    space: Space,
    align: usize,
    accesses: Vec<RecordedAccess>,
}

/// Misses for one M and one B: a row of a plot. Shown as `memory,block,misses`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct CurvePoint {
    /// M in bytes.
    pub memory: usize,
    /// B in bytes.
    pub block: usize,
    /// Blocks that came in.
    pub misses: u64,
}

impl fmt::Display for CurvePoint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{},{},{}", self.memory, self.block, self.misses)
    }
}

impl Trace {
    /// An empty trace, in which arrays will begin at multiples of `align` bytes: the largest block to be asked for.
    ///
    /// # Errors
    /// [`Error::Option`] if `align` is no power of two.
    pub fn new(align: usize) -> Result<Self, Error> {
        CacheShape::lru(align, align).check()?;
        Ok(Self { space: Space::new(align), align, accesses: Vec::new() })
    }

    /// The accesses, in order.
    pub fn accesses(&self) -> &[RecordedAccess] {
        &self.accesses
    }

    /// Accesses that lay outside all announced arrays, at least in part.
    pub fn unannounced(&self) -> u64 {
        self.space.unannounced()
    }

    /// Returns what happens in an empty cache of that shape.
    ///
    /// # Errors
    /// [`Error::Option`] if the shape is no cache.
    pub fn simulate(&self, shape: CacheShape) -> Result<Counts, Error> {
        let mut simulator = Simulator::new(&[shape])?;
        for access in &self.accesses {
            simulator.record_at(access.at, access.bytes as usize, access.access);
        }
        Ok(simulator.counts(0))
    }

    /// Returns what happens in an empty memory of `memory` bytes in blocks of `block` bytes that knows the future: the block
    /// whose next access is farthest away makes room (Belady), which no other choice beats in misses.
    ///
    /// Among blocks that are never accessed again the one of the highest number goes. O(n log n) time and O(n) memory
    /// for n accesses.
    ///
    /// # Errors
    /// [`Error::Option`] if that is no cache.
    pub fn optimal(&self, memory: usize, block: usize) -> Result<Counts, Error> {
        let shape = CacheShape::lru(memory, block);
        shape.check()?;
        let shift = block.trailing_zeros();
        let blocks: Vec<(u64, Access)> = self
            .accesses
            .iter()
            .flat_map(|access| {
                let last = (access.at + u64::from(access.bytes - 1)) >> shift;
                (access.at >> shift..=last).map(|block| (block, access.access))
            })
            .collect();
        Ok(optimal(&blocks, shape.blocks()))
    }

    /// The misses of LRU memories of all sizes in blocks of `block` bytes.
    ///
    /// # Errors
    /// [`Error::Option`] if `block` is no power of two.
    pub fn stack_distances(&self, block: usize) -> Result<StackDistances, Error> {
        CacheShape::lru(block, block).check()?;
        let mut distances = StackDistances::aligned(block, self.align);
        for access in &self.accesses {
            distances.record_at(access.at, access.bytes as usize);
        }
        Ok(distances)
    }

    /// Misses of LRU against M, for one B; one pass over the trace for all.
    ///
    /// # Errors
    /// [`Error::Option`] if `block` is no power of two.
    pub fn misses_by_memory(
        &self,
        block: usize,
        memories: &[usize],
    ) -> Result<Vec<CurvePoint>, Error> {
        let distances = self.stack_distances(block)?;
        let row = |&memory| CurvePoint { memory, block, misses: distances.misses(memory) };
        Ok(memories.iter().map(row).collect())
    }

    /// Misses of LRU against B, for one M; one pass over the trace for each B.
    ///
    /// # Errors
    /// [`Error::Option`] if a block is no power of two or larger than the memory.
    pub fn misses_by_block(
        &self,
        memory: usize,
        blocks: &[usize],
    ) -> Result<Vec<CurvePoint>, Error> {
        let row = |&block| {
            let misses = self.simulate(CacheShape::lru(memory, block))?.misses;
            Ok(CurvePoint { memory, block, misses })
        };
        blocks.iter().map(row).collect()
    }
}

impl Probe for Trace {
    const IS_RECORDING: bool = true;

    fn place_at(&mut self, address: usize, bytes: usize) {
        self.space.place(address, bytes);
    }

    fn lift_from(&mut self, address: usize) {
        self.space.lift(address);
    }

    fn record(&mut self, mut address: usize, mut bytes: usize, access: Access) {
        while bytes > 0 {
            let (at, run) = self.space.translate(address, bytes.min(1 << 30));
            self.accesses.push(RecordedAccess { at, bytes: run as u32, access });
            address = address.wrapping_add(run);
            bytes -= run;
        }
    }
}
