//! Memory that is freed and soon taken again.
//!
//! *Trap.* The allocator of glibc maps each block above its mmap threshold for itself, so that the system makes new pages for it each
//! time, and gives back what is free at the end of its own memory above its trim threshold. Both are small until a large block is
//! freed: then the first becomes the size of that block and the second twice as much. A resumed triangulation of 10⁷ points had freed
//! none before its tiles, and its pages were made ten times: a tenth of its processor time.
//! *Reference.* The manual page of mallopt, on the dynamic mmap threshold.

/// Before a loop whose rounds take and free memory alike on so many threads: has the allocator keep what is freed, up to about a fourth
/// of `limit` bytes over all threads.
///
/// The whole process has those thresholds from then on. Does nothing with another allocator than that of 64-bit glibc, nor where
/// the process has freed larger blocks before.
pub fn keep_freed_memory(limit: u64, threads: usize) {
    /// The largest block that raises the mmap threshold has 32 MiB, with its header and up to a page behind it.
    const BLOCK_BYTES_MAX: u64 = (32 << 20) - (1 << 16);
    if cfg!(all(target_os = "linux", target_env = "gnu", target_pointer_width = "64")) {
        let bytes = (limit / 8 / threads.max(1) as u64).min(BLOCK_BYTES_MAX);
        let mut block: Vec<u8> = Vec::new();
        // What fails changes nothing.
        drop(crate::try_reserve_exact(&mut block, bytes as usize));
        // Or the compiler would leave out a block that nobody uses.
        std::hint::black_box(&block);
    }
}
