//! A temporary file without a name, that is written and read in pages and passes by the cache of the system where it can.
//!
//! *Idea.* What is written once and read once, long after, gains nothing by the cache, whose pages are dear. (Measured: 2 GB take
//! 5 s of processor time into the cache, and 0.2 s past it.) Then all offsets, lengths and addresses must be whole pages.
//! *Trap.* Not every file system can do this, and some tell only when they are asked to write: what was refused is done again
//! with the cache.

use std::fs::File;
use std::io::{self, ErrorKind};
use std::path::Path;

use taut_points::{read_exact_at, write_all_at};

/// Bytes that the sectors of all common disks divide.
pub(super) const PAGE_BYTES: usize = 1 << 12;

/// A temporary file.
pub(super) struct PageFile(File);

impl PageFile {
    pub(super) fn new_in(folder: &Path) -> io::Result<Self> {
        let file = tempfile::tempfile_in(folder)?;
        set_direct(&file, true);
        Ok(PageFile(file))
    }

    /// Writes whole pages, at a page.
    pub(super) fn write(&self, pages: &Pages, at: u64) -> io::Result<()> {
        let write = || write_all_at(&self.0, pages.bytes(), at);
        self.or_by_the_cache(write(), write)
    }

    /// Fills whole pages, from a page on.
    pub(super) fn read(&self, bytes: &mut [u8], at: u64) -> io::Result<()> {
        let first = read_exact_at(&self.0, bytes, at);
        self.or_by_the_cache(first, || read_exact_at(&self.0, bytes, at))
    }

    fn or_by_the_cache(
        &self,
        first: io::Result<()>,
        again: impl FnOnce() -> io::Result<()>,
    ) -> io::Result<()> {
        match first {
            Err(error) if error.kind() == ErrorKind::InvalidInput && set_direct(&self.0, false) => {
                again()
            }
            done => done,
        }
    }
}

/// Passes by the cache from here on, or no longer; tells whether that was possible.
#[cfg(target_os = "linux")]
fn set_direct(file: &File, is_direct: bool) -> bool {
    use rustix::fs::{OFlags, fcntl_getfl, fcntl_setfl};
    fcntl_getfl(file).is_ok_and(|mut flags| {
        flags.set(OFlags::DIRECT, is_direct);
        fcntl_setfl(file, flags).is_ok()
    })
}

#[cfg(not(target_os = "linux"))]
fn set_direct(_: &File, _: bool) -> bool {
    false
}

/// Bytes of whole pages, that begin where a page of memory does.
pub(super) struct Pages {
    /// A page more than there is room for.
    memory: Vec<u8>,
    start: usize,
    len: usize,
}

impl Pages {
    /// No bytes, and room for as many whole pages as hold `capacity`.
    pub(super) fn with_capacity(capacity: usize) -> Self {
        let memory = vec![0; capacity.next_multiple_of(PAGE_BYTES) + PAGE_BYTES];
        let start = memory.as_ptr().align_offset(PAGE_BYTES).min(PAGE_BYTES);
        Pages { memory, start, len: 0 }
    }

    pub(super) fn capacity(&self) -> usize {
        self.memory.len() - PAGE_BYTES
    }

    pub(super) fn len(&self) -> usize {
        self.len
    }

    pub(super) fn clear(&mut self) {
        self.len = 0;
    }

    pub(super) fn bytes(&self) -> &[u8] {
        &self.memory[self.start..][..self.len]
    }

    /// Adds bytes, which must fit, and fills up the last page.
    pub(super) fn add(&mut self, bytes: &[u8]) {
        self.grow(bytes.len())[..bytes.len()].copy_from_slice(bytes);
    }

    /// Adds as many pages as hold `count` bytes, which must fit. They have any bytes.
    pub(super) fn grow(&mut self, count: usize) -> &mut [u8] {
        let from = self.start + self.len;
        let count = count.next_multiple_of(PAGE_BYTES);
        self.len += count;
        &mut self.memory[from..][..count]
    }
}
