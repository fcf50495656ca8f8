//! Memory that is freed and soon taken again.
//!
//! *Trap.* The allocator of glibc maps each large block for itself, so that the system makes all its pages once more, and gives
//! back what is free at the end of its own memory. It keeps both only after a block of such a size was freed: from then on blocks
//! up to that size come from its own memory, and twice as much of that may stay free. A resumed triangulation of 10⁷ points, which
//! had freed no large block before its tiles, so had its pages made ten times: a tenth of its processor time.

/// The largest block from whose end the allocator of glibc learns has 32 MiB, with what is around it.
const BLOCK_BYTES: usize = (32 << 20) - (1 << 16);

/// Has the allocator keep memory that is freed, some tens of MiB on each thread, for what is allocated next: worth it before a loop
/// whose rounds take and free as much. Where the allocator is another than that of glibc nothing happens.
pub fn keep_freed_memory() {
    let mut block: Vec<u8> = Vec::new();
    // What fails changes nothing.
    drop(crate::try_reserve_exact(&mut block, BLOCK_BYTES));
    std::hint::black_box(&block);
}
